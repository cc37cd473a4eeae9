#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vestige {

/// A part of the work on a frame, in the order in which detectors go through them. docs/guides/speed.md says what each
/// detector does in each stage.
enum class Stage : std::uint8_t {
  kPose,        ///< joint palette, segments, and the empty row
  kCandidates,  ///< what leaves pairs out before any is tested: bounds, boxes, the refit of a tree
  kSkinning,    ///< vertices skinned by the CPU, or the motion of the shapes that stand in for the skin
  kUpload,      ///< OpenGL: the calls that hand data to the driver
  kDraw,        ///< OpenGL: the shaders' work
  kWait,        ///< OpenGL: the time from the first call of a draw to its end, without kDraw
  kReadBack,    ///< OpenGL: the results, from the driver to the row or to kDecision
  kTest,        ///< segments against triangles or shapes: the filter that rejects most pairs
  kDecision,    ///< the exact decision of the pairs that remain, and the description of contacts
};

/// The names in files, in the order of `Stage`.
inline constexpr std::array<const char*, 9> kStageNames = {"pose", "candidates", "skinning", "upload",  "draw",
                                                           "wait", "read_back",  "test",     "decision"};

struct StageTime {
  Stage stage = Stage::kPose;
  double us = 0;  ///< microseconds, at least 0
};

/// How kDraw was measured. kTimer: by the driver's timer. kClock: by the CPU's clock until the calls return, because
/// the driver has no timer whose answers can be true. Then there is no kWait, and kReadBack contains what the driver
/// does later.
enum class DrawnBy { kNothing, kTimer, kClock };

/// Charges time to stages: always to the stage that was entered last. The clock measures the cost of a switch when it
/// is made, and takes that off each stage, so that many switches in a frame do not look like work. One thread may use
/// it.
class StageClock {
 public:
  StageClock();

  /// From now on, time belongs to this stage. Does nothing if the stage was entered last.
  void enter(Stage stage);

  /// From now on, time belongs to no stage. Returns the time since the last switch, 0 if there was no stage.
  std::chrono::nanoseconds leave();

  /// Says how long a draw took by the driver's own timer (0 if it has none) and by the CPU's clock. The latter was
  /// charged to kDraw.
  void note_draw(std::chrono::nanoseconds wall, std::chrono::nanoseconds timer);

  /// Forgets all that was charged.
  void reset();

  /// Returns the time of every stage that was entered since `reset`, in the order of `Stage`. kDraw is split into
  /// kDraw and kWait if `drawn_by` is kTimer.
  std::vector<StageTime> times() const;

  /// kTimer if the driver's timer could be true: it measured something, and no draw took longer by it than by the CPU's
  /// clock.
  DrawnBy drawn_by() const;

 private:
  struct Spent {
    std::chrono::nanoseconds time = {};
    std::uint64_t entered = 0;
  };

  std::array<Spent, kStageNames.size()> spent_;
  std::optional<Stage> current_;
  std::chrono::steady_clock::time_point since_;
  std::chrono::nanoseconds drawn_ = {};  ///< by the driver's timer
  bool drawn_longer_than_possible_ = false;
  double switch_ns_ = 0;
};

/// Enters a stage, unless nothing is timed: `clock` may be null.
inline void enter_stage(StageClock* clock, Stage stage) {
  if (clock != nullptr) clock->enter(stage);
}

}  // namespace vestige
