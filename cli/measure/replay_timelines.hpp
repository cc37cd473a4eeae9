#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/measure/replay_options.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige::cli {

/// The timelines that --timeline asks for: one for each person who has actuators. The first person's has the name that
/// was given, and later ones have their number in it: OUT.csv, OUT.2.csv. Without --timeline there are none.
class Timelines {
 public:
  /// Throws `UsageError` if nobody has an actuator, if the law needs spheres and there are none, or if several
  /// timelines would go to one pipe. Keeps references to the people of `trace`.
  Timelines(const ReplayOptions& options, OpenTrace& trace);

  /// Adds the paths that --timeline does not name itself.
  void add_paths_to(std::vector<std::string>& outputs) const;
  /// The planes that rows must carry.
  PlaneSet planes() const;
  /// What is known of the law; null without timelines.
  nlohmann::ordered_json law() const;

  void open();
  void commit();

  // Of a person, who counts from 0; null or empty if the person has no timeline. The second and third are null until
  // `open`.
  const DriveMaker* drives_of(std::size_t person) const;
  TimelineFile* file_of(std::size_t person) const;
  ActuatorDrive* drive_of(std::size_t person) const;
  std::string path_of(std::size_t person) const;

 private:
  struct One {
    std::string path;
    DriveMaker drives;
    const std::vector<std::string>& actuator_names;
    std::unique_ptr<ActuatorDrive> drive = nullptr;
    std::unique_ptr<TimelineFile> file = nullptr;
  };

  const One* find(std::size_t person) const;

  Overwrite overwrite_;
  std::vector<std::optional<One>> of_people_;  ///< none without --timeline
};

}  // namespace vestige::cli
