#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// kAll: skin that no actuator covers occludes what lies behind it. kMapped: the winner is the first contact whose
/// texel has an actuator.
enum class Surface { kAll, kMapped };

/// kOn: meshlets and colliders that cannot meet are left out before anything is skinned or tested. Changes the work,
/// never a bit of the result. Detectors that test all pairs by their nature ignore it.
enum class Skip { kOff, kOn };

struct DetectorOptions {
  Surface surface = Surface::kAll;
  PlaneSet planes;  ///< what the rows must carry
  Method method = Method::kStatic;
  Skip skip = Skip::kOff;
};

/// Work done by one call of `detect`, for reports; or by several, summed.
struct DetectorWork {
  std::uint64_t pairs_tested = 0;      ///< (segment, triangle) pairs
  std::uint64_t triangles_tested = 0;  ///< triangles that met at least one test
  std::uint64_t pairs_captured = 0;    ///< pairs that the geometry shader could not reject
  std::uint64_t pairs_meeting = 0;     ///< pairs of collider and triangle that truly meet (`geometry`, `cpu`)
  std::uint64_t meshlets_skinned = 0;  ///< 0 where the whole mesh was
  std::uint64_t frames_skipped = 0;    ///< 1 where bounds alone told that nothing can meet
  std::uint64_t unsure = 0;            ///< pairs that no filter could tell: exact arithmetic decided

  DetectorWork& operator+=(const DetectorWork& other) {
    pairs_tested += other.pairs_tested;
    triangles_tested += other.triangles_tested;
    pairs_captured += other.pairs_captured;
    pairs_meeting += other.pairs_meeting;
    meshlets_skinned += other.meshlets_skinned;
    frames_skipped += other.frames_skipped;
    unsure += other.unsure;
    return *this;
  }
};

/// Where a detector runs, as the driver says it. Empty for a detector without GL.
struct GlInfo {
  std::string context;  ///< "egl-surfaceless", "egl-device-0", "osmesa"
  std::string renderer;
  std::string version;
  std::string vendor;
  bool software = false;  ///< drawn by the processor
};

/// Finds, for every collider, where its segment first meets the avatar's skin.
///
/// `paper` reproduces HAVE 2010; `geometry`, `cpu` and `exact` keep detector/CONTRACT.md to the last bit.
/// A detector holds references to the avatar and map that it was made with, and belongs to the thread that made it.
class Detector {
 public:
  Detector() = default;
  virtual ~Detector() = default;
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  virtual const char* name() const = 0;
  /// Frames for `detect` must come from a FrameBuilder with this method.
  virtual Method method() const { return Method::kStatic; }
  virtual GlInfo gl_info() const { return {}; }
  /// Of the avatar, those proven to fire nothing (`on_mapped_skin`).
  virtual std::size_t triangles_left_out() const { return 0; }

  /// Fills `row` (resized to frame.columns). The whole round trip is in here: skinning or upload, test, read-back.
  virtual DetectorWork detect(const Frame& frame, ContactRow& row) = 0;

  /// This detector's own skinned vertices, relative to the frame's origin: to compare with the double reference.
  virtual void skinned_vertices(const Frame& frame, std::vector<glm::vec3>& out) = 0;
};

}  // namespace vestige
