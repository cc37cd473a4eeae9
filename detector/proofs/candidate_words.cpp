#include "detector/proofs/candidate_words.hpp"

#include <algorithm>
#include <glm/vec4.hpp>

#include "detector/gl/gl_objects.hpp"

namespace vestige {

std::size_t most_meshlets_in_texture(const GlFunctions& gl, Method method) {
  constexpr std::size_t kCornerTexels = sizeof(MeshletCorners) / sizeof(glm::vec4);
  static_assert(kCornerTexels == 72 && kSlotLanes == 8);  // as candidates.glsl has them
  return static_cast<std::size_t>(gl_limit(gl, GL_MAX_TEXTURE_BUFFER_SIZE)) / (kCornerTexels * sets_of(method));
}

CornerTexture::CornerTexture(const GlFunctions& gl, GLuint buffer) : gl_(gl) {
  gl_.CreateTextures(GL_TEXTURE_BUFFER, 1, &name_);
  gl_.TextureBuffer(name_, GL_RGBA32F, buffer);
}

CornerTexture::~CornerTexture() {
  gl_.DeleteTextures(1, &name_);
}

Error unfinished_shader() {
  return {"OpenGL", "the driver ended a shader before its work was done",
          "use --detector cpu, which finds the same contacts, or another --context or --device"};
}

void unpack_words(std::span<const std::uint32_t, kSlotLanes> words, std::size_t segments, std::uint32_t* out) {
  std::uint32_t any = 0;
  std::uint32_t all = 0xFFFFFFFF;
  for (const std::uint32_t word : words) {
    any |= word;
    all &= word;
  }
  constexpr std::size_t kTestedShift = 4 * kSlotSegments;
  const std::uint32_t tested = static_cast<std::uint32_t>(8 + segments);
  if (any >> kTestedShift != tested || all >> kTestedShift != tested) throw unfinished_shader();
  std::fill_n(out, segments, 0);
  if ((any & ((1U << kTestedShift) - 1)) == 0) return;
  for (std::size_t i = 0; i < segments; ++i)
    for (std::size_t lane = 0; lane < kSlotLanes; ++lane) out[i] |= (words[lane] >> (4 * i) & 15U) << (4 * lane);
}

}  // namespace vestige
