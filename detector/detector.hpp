#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "detector/shader_arithmetic.hpp"
#include "detector/stages.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// kAll: skin without an actuator hides what lies behind it. kMapped: the winner is the first contact whose texel has
/// an actuator.
enum class Surface { kAll, kMapped };

/// Who finds and skins the patches of skin that segments may meet, for `compute` with Skip::kOn. kFastest: the CPU if
/// the renderer is software, otherwise the GPU. The contacts are the same.
enum class Culling { kFastest, kCpu, kGpu };

struct DetectorOptions {
  Surface surface = Surface::kAll;
  PlaneSet planes = {};  ///< the planes that the rows must carry
  Method method = Method::kStatic;
  Skip skip = Skip::kOff;
  /// Divide the shaders' work as on a GPU if the renderer is software, too. It is slower there. For tests.
  bool as_on_gpu = false;
  Culling culling = Culling::kFastest;  ///< the others are for tests
};

/// Work done by one call of `detect`, or the sum over several calls; for reports.
struct DetectorWork {
  std::uint64_t pairs_tested = 0;      ///< (segment, triangle) pairs
  std::uint64_t triangles_tested = 0;  ///< triangles that were tested at least once
  std::uint64_t pairs_captured = 0;    ///< pairs that the shaders could not reject
  std::uint64_t pairs_meeting = 0;     ///< pairs that really meet (counted by `geometry`, `compute` and `cpu`)
  std::uint64_t meshlets_skinned = 0;  ///< by CPU or GPU: 0 if the detector skinned the whole mesh
  std::uint64_t frames_skipped = 0;    ///< 1 if the bounds alone proved that nothing can meet
  std::uint64_t part_pairs = 0;        ///< pairs of a collider in reach and a part of the skin (with skipping)
  std::uint64_t pairs_spared = 0;      ///< of them, pairs not looked at, as an earlier frame had proven them apart
  std::uint64_t unsure = 0;            ///< pairs that the filter could not decide and exact arithmetic did

  DetectorWork& operator+=(const DetectorWork& other) {
    pairs_tested += other.pairs_tested;
    triangles_tested += other.triangles_tested;
    pairs_captured += other.pairs_captured;
    pairs_meeting += other.pairs_meeting;
    meshlets_skinned += other.meshlets_skinned;
    frames_skipped += other.frames_skipped;
    part_pairs += other.part_pairs;
    pairs_spared += other.pairs_spared;
    unsure += other.unsure;
    return *this;
  }
};

/// The OpenGL implementation that a detector runs on, as the driver reports it. Empty for a detector without OpenGL.
struct GlInfo {
  std::string context;  ///< "egl-surfaceless", "egl-device-0", "osmesa"
  std::string renderer;
  std::string version;
  std::string vendor;
  bool software = false;  ///< true if the renderer runs on the CPU
  /// What was measured of the shaders' arithmetic, by stage. Empty if the driver refused the probe.
  std::vector<StageArithmetic> arithmetic = {};
  /// What the driver said against the probe, one line of at most 300 bytes. Empty unless it refused the probe.
  std::string probe_refusal = {};
};

/// Finds, for every collider, where its segment first meets the avatar's skin.
///
/// `paper` reproduces HAVE 2010. `geometry`, `compute`, `cpu` and `exact` keep detector/CONTRACT.md to the last bit. A
/// detector holds references to the avatar and the map that it was made with. Only the thread that made the detector
/// may use it.
class Detector {
 public:
  Detector() = default;
  virtual ~Detector() = default;
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  virtual const char* name() const = 0;
  /// Frames for `detect` must come from a FrameBuilder with this method.
  virtual Method method() const { return Method::kStatic; }
  /// Whether frames for `detect` may leave out segments that are out of the skin's reach.
  virtual Skip skip() const { return Skip::kOff; }
  /// The number of frames in a run. Frames whose numbers, divided by it, have the same quotient are a run. A detector
  /// that is given whole runs, each in order, does the same work whatever other runs it is given.
  virtual std::uint64_t run_length() const { return 1; }
  /// Whether simpler shapes stand in for the avatar's skin.
  virtual bool is_approximate() const { return false; }
  /// The number of triangles of the simpler mesh that stands in for the avatar's skin. Empty if no mesh does.
  virtual std::optional<std::size_t> triangles_kept() const { return {}; }
  virtual GlInfo gl_info() const { return {}; }
  /// Whether `skinned_vertices` come from a shader. If not, they are the CPU's.
  virtual bool skins_in_shader() const { return false; }
  /// The number of the avatar's triangles that are left out because they are proven to fire nothing (`on_mapped_skin`).
  virtual std::size_t triangles_left_out() const { return 0; }

  /// Fills `row` (resized to frame.columns). This call contains the whole round trip: skinning or upload, test,
  /// read-back.
  virtual DetectorWork detect(const DetectorFrame& frame, ContactRow& row) = 0;

  /// Does what `detect` does for each frame, in their order, with the same rows and the same work. A detector whose GPU
  /// works beside the CPU has several frames in flight meanwhile. All three have the same size. If it throws, the rows
  /// and the work say nothing.
  virtual void detect_all(std::span<const DetectorFrame> frames, std::span<ContactRow> rows,
                          std::span<DetectorWork> work) {
    for (std::size_t i = 0; i < frames.size(); ++i) work[i] = detect(frames[i], rows[i]);
  }

  /// Writes this detector's own skinned vertices to `out`, relative to the frame's origin, for comparison with the
  /// double-precision reference.
  virtual void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) = 0;

  /// From now on, `detect` charges its time to the stages of `clock`, and an OpenGL detector waits until everything is
  /// drawn before it reads back. The clock must live until it is replaced. Null, the default: nothing is timed.
  virtual void time_stages(StageClock* clock) { clock_ = clock; }
  StageClock* stage_clock() const { return clock_; }

 protected:
  void enter(Stage stage) const { enter_stage(clock_, stage); }

 private:
  StageClock* clock_ = nullptr;
};

}  // namespace vestige
