#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
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
#include "detector/proofs/in_flight.hpp"
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
/// must be current at every call. Several frames may be in flight, each in a place of its own, below kMostInFlight.
class GpuCuller {
 public:
  /// Whether an avatar is not too large for the shaders and for the buffers of the driver.
  static bool can_hold(const GlFunctions& gl, const Avatar& avatar, const Meshlets& meshlets, Method method);

  /// Keeps references to `avatar` and `meshlets`. Precondition: it can hold them.
  GpuCuller(const GlContext& context, const Avatar& avatar, const Meshlets& meshlets, Method method);
  ~GpuCuller();
  GpuCuller(const GpuCuller&) = delete;
  GpuCuller& operator=(const GpuCuller&) = delete;

  /// Starts a frame in a place that no other frame is in, and returns at once. `clock` may be null. Returns false, and
  /// starts nothing, if the frame is not for shaders: no segments or too many, ways that are worth to be cut, or
  /// numbers too large for their bounds.
  bool submit(std::size_t place, const DetectorFrame& frame, StageClock* clock);

  /// Waits for the frame that was submitted in this place. Returns its pairs by ascending meshlets, then segments,
  /// valid until the next call. Returns nothing if they are more than there is room for. Throws `Error` after an OpenGL
  /// error, and if the shaders did not do all of their work; then all frames must be abandoned.
  std::optional<std::span<const CulledPair>> collect(std::size_t place, StageClock* clock);

  /// Forgets all frames that were submitted.
  void abandon();

 private:
  struct Place;
  struct Counts;
  struct Slot;
  struct Margins {
    float box_m = 0;
    float corner_m = 0;
  };
  struct Programs {
    Programs(const GlFunctions& gl, const std::string& head);
    GlProgram cull;
    GlProgram prove;
  };

  Place& place_at(std::size_t number);
  std::optional<Margins> margins_of(const DetectorFrame& frame);
  void upload_frame(const DetectorFrame& frame, Place& place);
  void start(const Place& place, const Margins& margins, const Programs& programs);
  void read_pairs(const Place& place, const Counts& counts);
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
  DrawTimer timer_;
  std::array<std::optional<Programs>, 2> programs_;           ///< for points alone, and for spheres, too
  std::array<std::unique_ptr<Place>, kMostInFlight> places_;  ///< made when a frame first needs them
  std::vector<SkinMatrix> gpu_palette_;
  std::vector<glm::vec4> gpu_segments_;  ///< two each
  std::vector<CulledPair> pairs_;
};

}  // namespace vestige
