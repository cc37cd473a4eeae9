#include "detector/gl/arithmetic_probe.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <string>

#include "detector/gl/collision_texture.hpp"
#include "detector/gl/gl_objects.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"

namespace vestige {

namespace {

/// The shader reads a question as four words.
static_assert(sizeof(ProbeQuestion) == 16);

std::vector<float> read_answers(const GlFunctions& gl, const GlBuffer& answers) {
  std::vector<float> read(probe_questions().size());
  gl.GetNamedBufferSubData(answers.name(), 0, static_cast<GLsizeiptr>(read.size() * sizeof(float)), read.data());
  gl.UseProgram(0);
  check_gl(gl, "probing the shaders' arithmetic");
  return read;
}

/// Asks the last of the stages that draw.
std::vector<float> ask(const GlFunctions& gl, const GlBuffer& answers, const std::string& head,
                       std::initializer_list<GlProgram::Stage> stages) {
  const GlProgram program(gl, head, stages, "probe_answer");
  gl.UseProgram(program.name());
  gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, answers.name());
  gl.BeginTransformFeedback(GL_POINTS);
  gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(probe_questions().size()));
  gl.EndTransformFeedback();
  gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  return read_answers(gl, answers);
}

std::vector<float> ask_compute(const GlFunctions& gl, const GlBuffer& answers, const std::string& head) {
  const std::string source = fmt::format("#define COMPUTE 1\n{}", shaders::kProbeGlsl);
  const GlProgram program(gl, head, {{GL_COMPUTE_SHADER, "probe.glsl", source}});
  gl.UseProgram(program.name());
  gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_CAPTURED, answers.name());
  gl.DispatchCompute(static_cast<GLuint>(probe_questions().size()), 1, 1);
  gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  return read_answers(gl, answers);
}

/// What a draw needs even if it draws nothing.
class EmptyDraw {
 public:
  explicit EmptyDraw(const GlFunctions& gl) : gl_(gl), nowhere_(gl, PlaneSet()) {
    gl_.CreateVertexArrays(1, &vertex_array_);
    gl_.BindVertexArray(vertex_array_);
    nowhere_.begin(1);
    gl_.Enable(GL_RASTERIZER_DISCARD);
  }
  ~EmptyDraw() {
    gl_.Disable(GL_RASTERIZER_DISCARD);
    gl_.DeleteVertexArrays(1, &vertex_array_);
  }
  EmptyDraw(const EmptyDraw&) = delete;
  EmptyDraw& operator=(const EmptyDraw&) = delete;

 private:
  const GlFunctions& gl_;
  CollisionTexture nowhere_;
  GLuint vertex_array_ = 0;
};

}  // namespace

std::vector<StageArithmetic> probe_arithmetic(const GlFunctions& gl) {
  const std::span<const ProbeQuestion> questions = probe_questions();
  const EmptyDraw draw(gl);
  GlBuffer asked(gl);
  asked.upload(questions.data(), questions.size_bytes(), GL_STATIC_DRAW);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, VESTIGE_BINDING_QUESTIONS, asked.name());
  GlBuffer answers(gl);
  answers.upload(nullptr, questions.size() * sizeof(float), GL_STREAM_READ);
  const std::string head =
      fmt::format("#version 450 core\n{}#define QUESTIONS {}\n", shaders::kConstantsH, questions.size());
  const std::string vertex = fmt::format("#define VERTEX 1\n{}", shaders::kProbeGlsl);
  const std::string nothing = fmt::format("#define VERTEX 1\n#define GEOMETRY_FOLLOWS 1\n{}", shaders::kProbeGlsl);
  const std::string geometry = fmt::format("#define VERTEX 0\n{}", shaders::kProbeGlsl);
  return {
      judge("vertex", ask(gl, answers, head, {{GL_VERTEX_SHADER, "probe.glsl", vertex}})),
      judge("geometry", ask(gl, answers, head,
                            {{GL_VERTEX_SHADER, "probe.glsl", nothing}, {GL_GEOMETRY_SHADER, "probe.glsl", geometry}})),
      judge("compute", ask_compute(gl, answers, head))};
}

}  // namespace vestige
