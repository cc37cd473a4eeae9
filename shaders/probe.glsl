// Answers the questions of detector/shader_arithmetic.hpp, in the stage that is compiled: VERTEX, COMPUTE, or a geometry
// stage after a vertex stage that does nothing. The operands come from a buffer, so that no compiler computes the answers. The
// answers are `precise`, as is everything that the proofs of `geometry` depend on.

#ifdef GEOMETRY_FOLLOWS
void main() {}
#else

#if COMPUTE
layout(local_size_x = 1) in;
#elif !VERTEX
layout(points) in;
layout(points, max_vertices = 1) out;
#endif

layout(std140, binding = VESTIGE_BINDING_QUESTIONS) uniform Questions {
  uvec4 questions[QUESTIONS];  // bits of a, b and c, and the operation
};

#if COMPUTE
layout(std430, binding = VESTIGE_BINDING_CAPTURED) writeonly buffer Answers {
  float answers[];
};
#else
out float probe_answer;
#endif

float answer(uvec4 question) {
  float a = uintBitsToFloat(question.x);
  float b = uintBitsToFloat(question.y);
  float c = uintBitsToFloat(question.z);
  precise float result = 0.0;
  if (question.w == 0u) result = a + b;
  if (question.w == 1u) result = a - b;
  if (question.w == 2u) result = a * b;
  if (question.w == 3u) result = a / b;
  if (question.w == 4u) result = a * b + c;
  return result;
}

void main() {
#if COMPUTE
  answers[gl_WorkGroupID.x] = answer(questions[gl_WorkGroupID.x]);
#elif VERTEX
  probe_answer = answer(questions[gl_VertexID]);
#else
  probe_answer = answer(questions[gl_PrimitiveIDIn]);
  EmitVertex();
#endif
}
#endif
