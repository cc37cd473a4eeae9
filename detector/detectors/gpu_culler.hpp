#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/frame.hpp"
#include "detector/gl/draw_timer.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/method.hpp"
#include "detector/stages.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A segment that may meet a meshlet's box.
struct CulledPair {
  std::uint32_t meshlet = 0;
  std::uint32_t segment = 0;    ///< number in DetectorFrame::segments
  std::uint32_t triangles = 0;  ///< bits of the meshlet's triangles: 0 if the segment surely misses the triangle
};

/// Finds which segments may meet which meshlets, skins those, and proves misses: all by compute shaders
/// (shaders/cull.comp, then candidates.comp), and the CPU waits for nothing in between. Belongs to a context, which
/// must be current at every call.
class GpuCuller {
 public:
  /// Keeps references to `avatar` and `meshlets`.
  GpuCuller(const GlContext& context, const Avatar& avatar, const Meshlets& meshlets, Method method);
  ~GpuCuller();
  GpuCuller(const GpuCuller&) = delete;
  GpuCuller& operator=(const GpuCuller&) = delete;

  /// Starts a frame with segments, and returns at once. `clock` may be null. Returns false, and starts nothing, if the
  /// frame is not for shaders: too many segments or meshlets, ways that are worth to be cut, or numbers too large for
  /// their bounds.
  bool submit(const DetectorFrame& frame, StageClock* clock);

  /// Waits for the frame that was submitted. Returns its pairs by ascending meshlets, then segments, valid until the
  /// next call. Returns nothing if they are more than there is room for. Throws `Error` after an OpenGL error, and if
  /// the shaders did not do all of their work.
  std::optional<std::span<const CulledPair>> collect(StageClock* clock);

 private:
  struct Counts;
  struct Slot;
  struct Programs {
    Programs(const GlFunctions& gl, const std::string& head);
    GlProgram cull;
    GlProgram prove;
  };

  void upload_frame(const DetectorFrame& frame);
  bool set_margins(const DetectorFrame& frame);
  void start(const Programs& programs);
  void read_pairs(const Counts& counts);
  void clear_words(std::size_t slots);
  const Programs& programs(bool has_spheres);

  const GlFunctions& gl_;
  const Avatar& avatar_;
  const Meshlets& meshlets_;
  Method method_;
  FenceWait wait_;
  std::size_t most_places_;  ///< meshlets whose corners fit
  MeshletBounds bounds_;
  glm::dvec3 bind_extent_m_;
  GlBuffer meshlet_buffer_;
  GlBuffer rest_boxes_;
  GlBuffer vertices_;
  GlBuffer palette_;
  GlBuffer segments_;
  GlBuffer slots_;
  GlBuffer corners_;
  GlBuffer counts_;
  GlMappedBuffer counted_;  ///< a copy of `counts_`, after the frame
  GlMappedBuffer found_;    ///< a copy of `slots_`, likewise
  GlMappedBuffer words_;    ///< shaders/candidates.glsl
  DrawTimer timer_;
  std::array<std::optional<Programs>, 2> programs_;  ///< for points alone, and for spheres, too
  GLuint corner_texture_ = 0;

  GLsync fence_ = nullptr;  ///< of the frame that was submitted
  std::size_t segment_count_ = 0;
  float box_margin_m_ = 0;
  float corner_error_m_ = 0;
  std::vector<SkinMatrix> gpu_palette_;
  std::vector<glm::vec4> gpu_segments_;  ///< two each
  std::vector<CulledPair> pairs_;
};

}  // namespace vestige
