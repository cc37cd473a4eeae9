#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "analysis/viz/seen.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

/// How contacts are looked for and felt.
struct WatchChoice {
  const DetectorChoice& detector;
  const LawFlags& law;
  PlaneSet planes;  ///< that contacts shall carry; those that the law needs come to them
};

/// Goes through a trace, looks for contacts on its people, and lets them feel these.
class Watchers {
 public:
  /// `people` are those of the trace, perhaps with other maps. `file` is the trace's name. Keeps references to all but
  /// `choice` and `file`. Throws `UsageError` or `Error` if detector or law do not suit the people.
  Watchers(std::span<const TracedPerson> people, OpenTrace& trace, const std::string& file, const WatchChoice& choice);

  /// Takes the next frame. What was found in it stays good until the next call.
  void step(const TraceFrame& frame);
  /// Returns what was found on each person.
  std::span<const SeenPerson> seen() const { return seen_; }

  std::string detector() const { return detectors_.front()->name(); }
  /// Returns whether anybody has an actuator.
  bool any_feels() const;
  /// Returns sentences about what was not finite in the frames so far, at most one about each person.
  std::vector<std::string> notes() const;

 private:
  const OpenTrace& trace_;
  std::vector<std::unique_ptr<Detector>> detectors_;
  std::vector<std::unique_ptr<ActuatorDrive>> drives_;  ///< null for a person without an actuator
  std::optional<DetectionRun> run_;
  std::vector<SeenPerson> seen_;
};

}  // namespace vestige::cli
