#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "analysis/run/detector_team.hpp"
#include "detector/actuator_map.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Says which poses and segments were not finite, and so fired nothing. `first`: the first frame with one. Returns ""
/// if all were finite.
std::string describe_non_finite(std::uint64_t frames, std::uint64_t segments, std::optional<std::uint64_t> first);

/// A person of a trace, with the map by which the person feels.
struct MappedPerson {
  const Avatar& avatar;
  const ActuatorMap& map;
};

/// What was found on a person in a frame.
struct SeenPerson {
  const DetectorFrame& frame;
  const ContactRow& row;
  const ActuatorFrame* felt = nullptr;  ///< null: the person has no actuator
};

/// Takes people through the frames of a trace, finds what touches them, and lets them feel it by a law.
class SeenRun {
 public:
  struct Input {
    std::span<const MappedPerson> people;         ///< avatars and maps are kept
    std::span<const std::uint32_t> collider_ids;  ///< all of the trace, ascending
    const LawFlags& law;
    PlaneSet planes;  ///< that contacts shall carry; those that the law needs come to them
  };
  /// Makes a detector for each person, which finds these planes.
  using MakeDetectors = std::function<PeopleDetectors(PlaneSet planes)>;

  /// Throws what `DriveMaker` and `make` throw.
  SeenRun(const Input& input, const MakeDetectors& make);

  /// Begins again: the next frame is the trace's first.
  void rewind();
  /// Takes the next frame.
  void step(const TraceFrame& frame);
  /// Returns what was found on each person in the frame taken last. It stays good until the next call of `step`.
  std::span<const SeenPerson> seen() const { return seen_; }

  std::string detector() const { return detectors_.front()->name(); }
  /// Returns whether anybody has an actuator.
  bool any_feels() const;
  /// Returns the law of the first person with an actuator, as reports have it; null if nobody has one.
  nlohmann::ordered_json law() const;
  /// Returns `describe_non_finite` of a person in all frames so far.
  std::string non_finite(std::size_t person) const;

 private:
  std::vector<MappedPerson> people_;
  std::vector<std::uint32_t> collider_ids_;
  std::vector<std::optional<DriveMaker>> makers_;  ///< empty for a person without an actuator
  PeopleDetectors detectors_;
  std::optional<DetectionRun> run_;
  std::vector<std::unique_ptr<ActuatorDrive>> drives_;  ///< null for a person without an actuator
  std::vector<SeenPerson> seen_;
};

}  // namespace vestige
