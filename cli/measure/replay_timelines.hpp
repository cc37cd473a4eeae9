#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/measure/replay_options.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige::cli {

/// The timelines that --timeline asks for: one for each person who has actuators. The first of them has the name that
/// was given, and the others have their person's number in it: OUT.csv, OUT.2.csv. Without --timeline there are none.
class Timelines {
 public:
  /// A person's timeline.
  struct One {
    std::string path;
    DriveMaker drives;
    const std::vector<std::string>& actuator_names;
    std::unique_ptr<TimelineFile> file = nullptr;    ///< null until `open`
    std::unique_ptr<ActuatorDrive> drive = nullptr;  ///< null until `open`
  };

  /// Throws `UsageError` if nobody has an actuator, if the law needs spheres and there are none, or if several
  /// timelines would go to one pipe. Keeps references to the people of `trace`.
  Timelines(const ReplayOptions& options, OpenTrace& trace);

  /// Adds the paths that --timeline does not name itself.
  void add_paths_to(std::vector<std::string>& outputs) const;
  /// The planes that rows must carry.
  PlaneSet planes() const;
  void open();
  void commit();

  /// Returns the timeline of a person, who counts from 0; null if the person has none.
  const One* find(std::size_t person) const;

 private:
  Overwrite overwrite_;
  std::vector<std::optional<One>> of_people_;  ///< none without --timeline
};

}  // namespace vestige::cli
