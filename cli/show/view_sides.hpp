#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/view/page_packer.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/person_maps.hpp"
#include "cli/choices/scene.hpp"
#include "cli/options.hpp"
#include "cli/show/trace_run.hpp"

namespace vestige::cli {

struct ViewOptions {
  CommonOptions common;
  DetectorChoice choice;
  LawFlags law;
  std::vector<std::string> map;        ///< values of --map
  std::vector<std::string> maps;       ///< two values of --maps, or none
  std::vector<std::string> detectors;  ///< values of --detectors, or none
  std::string trace;
  std::string output;
  bool open = false;
};

/// How a side of the page sees the trace. A page has one side or two.
struct SideChoice {
  std::string title;  ///< empty if there is one side
  std::string detector;
  std::vector<PersonValue> maps;  ///< in the place of the trace's
};

/// Reads --map, --maps, --detector and --detectors. Throws `UsageError`.
std::vector<SideChoice> side_choices(const ViewOptions& options);

/// A side of the page: its people and what finds their contacts and duties.
struct ViewSide {
  std::string title;
  std::vector<TracedPerson> people;
  std::unique_ptr<SeenRun> run;  ///< keeps references to `people`
};

/// Makes the sides of a trace. Throws `UsageError` or `Error` if a map, a law or a detector does not suit it.
std::vector<ViewSide> make_sides(const std::vector<SideChoice>& choices, OpenTrace& trace, const ViewOptions& options);

/// The people of all sides, and the titles of two sides.
std::vector<PagePerson> page_people(const std::vector<ViewSide>& sides);
std::vector<std::string> side_titles(const std::vector<ViewSide>& sides);

/// Reads the whole trace into `packer`, which is for `page_people`. Returns the number of contacts of each side. Throws
/// `Error` if Ctrl-C is pressed.
std::vector<std::uint64_t> pack_frames(OpenTrace& trace, const std::vector<ViewSide>& sides, PagePacker& packer,
                                       const ViewOptions& options);

}  // namespace vestige::cli
