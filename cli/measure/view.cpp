#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/run/detection_run.hpp"
#include "analysis/view/page.hpp"
#include "analysis/view/page_packer.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/person_maps.hpp"
#include "cli/choices/scene.hpp"
#include "cli/measure/replay_check.hpp"
#include "cli/verbs.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

constexpr double kVisible_m = 0.01;
/// Larger pages open slowly.
constexpr std::size_t kLargePage_bytes = 25'000'000;

struct ViewOptions {
  CommonOptions common;
  DetectorChoice choice;
  LawFlags law;
  std::vector<std::string> maps;
  std::string trace;
  std::string output;
  bool open = false;
};

/// Beside the trace: man.mcap becomes man.html.
std::string output_path(const ViewOptions& options) {
  if (!options.output.empty()) return options.output;
  if (options.trace == "-")
    throw UsageError("-o", "a trace from standard input has no name", "name the page: -o OUT.html");
  std::filesystem::path page = options.trace;
  if (page.extension() == ".mcap") page.replace_extension();
  return page.string() + ".html";
}

/// The drive of each person's motors; empty for a person without an actuator.
using Drives = std::vector<std::optional<DriveMaker>>;

Drives make_drives(const ViewOptions& options, OpenTrace& trace) {
  Drives drives(trace.people.size());
  bool any = false;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const TracedPerson& person = trace.people[i];
    if (person.map.actuator_count == 0) continue;
    any = true;
    drives[i].emplace(options.law, person.avatar, person.map);
  }
  if (any) require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  return drives;
}

PlaneSet planes_of(const Drives& drives) {
  PlaneSet planes = kHashedPlanes | Plane::kBarycentric | Plane::kPosition | Plane::kSide;
  for (const auto& drive : drives)
    if (drive) planes = planes | drive->planes();
  return planes;
}

/// Reads the whole trace into `packer`. Returns sentences about what is not finite.
std::vector<std::string> pack_frames(OpenTrace& trace, const PeopleDetectors& detectors, const Drives& drives,
                                     PagePacker& packer, const ViewOptions& options) {
  const std::vector<std::uint32_t> ids = trace.reader.collider_ids();
  std::vector<DetectedPerson> people;
  std::vector<std::unique_ptr<ActuatorDrive>> running(drives.size());
  for (std::size_t i = 0; i < trace.people.size(); ++i) {
    people.push_back({i, trace.people[i].avatar, *detectors[i]});
    if (drives[i]) running[i] = drives[i]->make();
  }
  DetectionRun run(people, ids);
  const auto total = static_cast<double>(trace.reader.frame_count());
  double done = 0;
  Progress progress("Looking for contacts", options.common.verbosity());
  TraceFrame frame;
  while (trace.reader.next(frame)) {
    run.step(frame);
    packer.add(frame);
    for (std::size_t i = 0; i < people.size(); ++i) {
      packer.add_contacts(i, run.frame(i), run.row(i));
      if (running[i]) packer.add_duties(i, running[i]->next(frame.time_s(), run.row(i), &run.frame(i)));
    }
    if (!progress.update(++done / total)) throw Error(options.trace, "writing the page was stopped", "");
  }
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const FrameBuilder& built = run.builder(i);
    const std::string note =
        describe_non_finite(built.non_finite_frames(), built.non_finite_segments(), built.first_non_finite());
    const std::string who = people.size() > 1 ? fmt::format("{}: ", trace.people[i].name) : "";
    if (!note.empty()) notes.push_back(who + note);
  }
  return notes;
}

/// What the page says below its title.
std::vector<std::string> about(const ViewOptions& options, const PeopleDetectors& detectors, const Drives& drives) {
  std::vector<std::string> texts = {fmt::format("detector {}", detectors.front()->name())};
  const bool has_motors = std::ranges::any_of(drives, [](const auto& drive) { return drive.has_value(); });
  if (has_motors) texts.push_back(fmt::format("law {}, hold {} ms", options.law.law, options.law.hold_ms));
  texts.push_back("vestige " + commit().substr(0, 10));
  return texts;
}

void warn_of_size(std::size_t bytes, const std::string& output, const ViewOptions& options) {
  if (bytes <= kLargePage_bytes) return;
  warn(
      fmt::format("{}: {:.0f} MB, which browsers open slowly; cut the trace first: vestige trim {} --from 0 --to 60 -o "
                  "part.mcap",
                  output, static_cast<double>(bytes) / 1e6, options.trace),
      options.common.verbosity());
}

void open_in_browser(const std::string& page, Verbosity verbosity) {
  std::string program = "xdg-open";
  std::string path = std::filesystem::absolute(page).string();
  char* const arguments[] = {program.data(), path.data(), nullptr};
  // What it prints would stand among our own lines.
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failure != 0)
    warn(fmt::format("--open: xdg-open cannot be run: {}; open {} in a browser", std::strerror(failure), page),
         verbosity);
}

void run_view(const ViewOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::string output = output_path(options);
  options.law.check();
  if (options.open && output == "-")
    throw UsageError("--open", "a page on standard output has no name", "name a file with -o");
  const std::vector<PersonValue> maps = parse_maps(options.maps);
  std::vector<std::string> inputs = {options.trace, options.law.actuator};
  add_map_files(maps, inputs);
  check_outputs({output, options.common.json}, inputs, options.common);
  OpenTrace trace(options.trace, verbosity, People::kSeveral);
  for (std::size_t i = 0; i < trace.people.size(); ++i)
    require_surface(
        trace.people[i].avatar,
        fmt::format("{}, {}", options.trace, trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, i)));
  require_frames(trace.reader, options.trace);
  use_maps(maps, trace, options.trace, verbosity);
  const Drives drives = make_drives(options, trace);
  const PeopleDetectors detectors = make_detectors(options.choice.detector, options.choice, trace, planes_of(drives));
  warn_of_radii({detectors.front()->name()}, trace.reader, options.trace, verbosity);

  catch_interrupts();
  std::vector<PagePerson> people;
  for (const TracedPerson& person : trace.people) people.push_back({person.name, person.avatar, person.map});
  PagePacker packer(people, trace.reader.collider_ids());
  const std::vector<std::string> notes = pack_frames(trace, detectors, drives, packer, options);
  PageContent content = packer.finish();
  const double skin_error_mm = content.head["error_mm"]["skin"].get<double>();
  if (skin_error_mm > 1e3 * kVisible_m)
    warn(fmt::format("{}: skin is drawn up to {} mm from its place: a page draws a vertex by at most four joints",
                     output, skin_error_mm),
         verbosity);
  content.head["about"] = about(options, detectors, drives);
  std::vector<std::string> warnings = damage_of(trace.reader, options.trace);
  warnings.insert(warnings.end(), notes.begin(), notes.end());
  content.head["warnings"] = std::move(warnings);
  const std::string title = options.trace == "-" ? "trace" : std::filesystem::path(options.trace).filename().string();
  const std::string page = make_page(title, content);
  OutputFile file(output, options.common.overwrite());
  file.write(page);
  file.commit();

  warn_of_size(page.size(), output, options);
  print_summary(fmt::format("{}: {} and {}, {:.1f} MB\n", output, counted(trace.reader.frame_count(), "frame"),
                            counted(packer.contacts(), "contact"), static_cast<double>(page.size()) / 1e6),
                {output, options.common.json}, options.common);
  write_json(options.common.json,
             with_provenance(invocation.argv, {{"trace", options.trace},
                                               {"output", output},
                                               {"detector", detectors.front()->name()},
                                               {"frames", trace.reader.frame_count()},
                                               {"contacts", packer.contacts()},
                                               {"bytes", page.size()},
                                               {"error_mm", content.head["error_mm"]},
                                               {"complete", trace.reader.complete()}}),
             options.common);
  invocation.exit_code = report_damage(trace.reader, options.trace, verbosity);
  for (const std::string& note : notes) {
    warn(fmt::format("{}: {}", options.trace, note), verbosity);
    invocation.exit_code = kDataLost;
  }
  if (options.open) open_in_browser(output, verbosity);
}

}  // namespace

void add_view(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* verb = add_verb(program, "view", "Write a trace as a web page in which it moves",
                            "  vestige view man.mcap\n"
                            "  vestige view man.mcap --law speed -o page.html\n");
  verb->add_option("TRACE", options->trace, "The trace, or '-' for standard input")->required();
  verb->add_option(
          "-o,--output", options->output,
          "The page, which needs nothing beside it and no network [default: the trace's name, ending in .html]")
      ->type_name("OUT.html|-");
  verb->add_flag("--open", options->open, "Open the page in the browser");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  add_maps_option(*verb, options->maps, "Intensity");
  add_law_options(*verb, options->law, "Intensity");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_view(*options, invocation); });
}

}  // namespace vestige::cli
