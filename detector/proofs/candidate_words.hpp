#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/gl/gl_functions.hpp"
#include "detector/method.hpp"
#include "traces/base/error.hpp"

// What whoever runs shaders/candidates.glsl must know of it.

namespace vestige {

/// The part of a slot's words that belongs to one of eight lanes, four triangles each.
inline constexpr std::size_t kSlotLanes = kMeshletTriangles / 4;
inline constexpr std::size_t kSlotSegments = 7;

/// Threads of a group on a GPU: whole warps or waves.
inline constexpr std::size_t kGpuGroupThreads = 64;

/// Returns the sets of corners of a meshlet: now, and before if the method uses it.
constexpr std::size_t sets_of(Method method) {
  return method == Method::kStatic ? 1 : 2;
}

/// Returns how many meshlets' corners fit into a texture buffer.
std::size_t most_meshlets_in_texture(const GlFunctions& gl, Method method);

/// The skinned corners in a buffer, as shaders/candidates.glsl fetches them. The context must be current at the
/// construction and the destruction.
class CornerTexture {
 public:
  /// Precondition: the buffer has its size.
  CornerTexture(const GlFunctions& gl, GLuint buffer);
  ~CornerTexture();
  CornerTexture(const CornerTexture&) = delete;
  CornerTexture& operator=(const CornerTexture&) = delete;
  GLuint name() const { return name_; }

 private:
  const GlFunctions& gl_;
  GLuint name_ = 0;
};

/// Returns what to throw if shaders did not do all of their work.
Error unfinished_shader();

/// Writes, for each of `segments` segments of a slot, the bits of the triangles that it may meet to `out`. Throws
/// `Error` if a word does not say that its lane tested all of them: llvmpipe, for one, ends loops of more than 65 535
/// rounds without a word.
void unpack_words(std::span<const std::uint32_t, kSlotLanes> words, std::size_t segments, std::uint32_t* out);

}  // namespace vestige
