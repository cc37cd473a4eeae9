#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/view/page.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/show/view_sides.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"

namespace vestige::cli {

namespace {

constexpr double kVisible_m = 0.01;

/// Beside the trace: man.mcap becomes man.html.
std::string output_path(const ViewOptions& options) {
  if (!options.output.empty()) return options.output;
  if (options.trace == "-")
    throw UsageError("-o", "a trace from standard input has no name", "name the page: -o OUT.html");
  std::filesystem::path page = options.trace;
  if (page.extension() == ".mcap") page.replace_extension();
  return page.string() + ".html";
}

/// The run of the first side on which anybody has an actuator, otherwise of the first.
const SeenRun& felt_run(const std::vector<ViewSide>& sides) {
  const auto felt = std::ranges::find_if(sides, [](const ViewSide& side) { return side.run->any_feels(); });
  return felt == sides.end() ? *sides.front().run : *felt->run;
}

/// What the page says below its title.
std::vector<std::string> about(const ViewOptions& options, const std::vector<ViewSide>& sides) {
  std::vector<std::string> texts;
  if (options.detectors.empty()) texts.push_back("detector " + sides.front().run->detector());
  texts.push_back("method " + options.choice.method);
  if (options.choice.surface != "all") texts.push_back("surface " + options.choice.surface);
  if (felt_run(sides).any_feels())
    texts.push_back(fmt::format("law {}, hold {} ms", options.law.law, options.law.hold_ms));
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
  const std::vector<SideChoice> choices = side_choices(options);
  std::vector<std::string> inputs = {options.trace, options.law.actuator};
  for (const SideChoice& choice : choices) add_map_files(choice.maps, inputs);
  check_outputs({output, options.common.json}, inputs, options.common);
  OpenTrace trace(options.trace, verbosity, People::kSeveral);
  require_surfaces(trace, options.trace);
  require_frames(trace.reader, options.trace);
  const std::vector<ViewSide> sides = make_sides(choices, trace, options);
  std::vector<std::string> detectors;
  detectors.reserve(sides.size());
  for (const ViewSide& side : sides) detectors.push_back(side.run->detector());
  warn_of_radii(detectors, trace.reader, options.trace, verbosity);

  catch_interrupts();
  PagePacker packer(page_people(sides), side_titles(sides), trace.reader.collider_ids());
  const std::vector<std::uint64_t> found = pack_frames(trace, sides, packer, options);
  PageContent content = packer.finish();
  const double skin_error_mm = content.head["error_mm"]["skin"].get<double>();
  if (skin_error_mm > 1e3 * kVisible_m)
    warn(fmt::format("{}: skin is drawn up to {} mm from its place: a page draws a vertex by at most four joints, and "
                     "rounds their motions",
                     output, skin_error_mm),
         verbosity);
  content.head["about"] = about(options, sides);
  for (const nlohmann::ordered_json& sentence : content.head["warnings"])
    warn(fmt::format("{}: {}", output, sentence.get<std::string>()), verbosity);
  const std::vector<std::string> notes = notes_of(*sides.front().run, trace);  // all sides get the same frames
  for (std::string& damage : damage_of(trace.reader, options.trace)) content.warn(std::move(damage));
  for (const std::string& note : notes) content.warn(note);
  const std::string title = options.trace == "-" ? "trace" : std::filesystem::path(options.trace).filename().string();
  const std::string page = make_page(title, content);
  OutputFile file(output, options.common.overwrite());
  file.write(page);
  file.commit();

  warn_of_size(page.size(), output, options);
  std::vector<std::string> counts;
  nlohmann::ordered_json seen = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < sides.size(); ++i) {
    counts.push_back(counted(found[i], "contact") + (sides.size() > 1 ? " (" + sides[i].title + ")" : ""));
    seen.push_back({{"title", sides[i].title}, {"detector", detectors[i]}, {"contacts", found[i]}});
  }
  print_summary(fmt::format("{}: {} and {}, {:.1f} MB\n", output, counted(trace.reader.frame_count(), "frame"),
                            fmt::join(counts, ", "), static_cast<double>(page.size()) / 1e6),
                {output, options.common.json}, options.common);
  nlohmann::ordered_json report = {{"trace", options.trace},
                                   {"output", output},
                                   {"frames", trace.reader.frame_count()},
                                   {"sides", std::move(seen)},
                                   {"bytes", page.size()},
                                   {"error_mm", content.head["error_mm"]},
                                   {"complete", trace.reader.complete()}};
  add_choices(report, options.choice, felt_run(sides));
  write_json(options.common.json, with_provenance(invocation.argv, report), options.common);
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
                            "  vestige view man.mcap --maps paper6 torso40 -o page.html\n");
  verb->add_option("TRACE", options->trace, "The trace, or '-' for standard input")->required();
  verb->add_option(
          "-o,--output", options->output,
          "The page, which needs nothing beside it and no network [default: the trace's name, ending in .html]")
      ->type_name("OUT.html|-");
  verb->add_flag("--open", options->open, "Open the page in the browser");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  CLI::Option* const map = add_maps_option(*verb, options->map, "Intensity");
  CLI::Option* const maps =
      verb->add_option("--maps", options->maps, "Show the body with two maps, side by side: two of these")
          ->type_name("[K=]FILE.png|LAYOUT|none")
          ->expected(2)
          ->delimiter(',')
          ->allow_extra_args(false)
          ->group("Side by side")
          ->excludes(map);
  verb->add_option("--detectors", options->detectors, "Show what two detectors find, side by side: two names")
      ->type_name("A,B")
      ->expected(1, 2)
      ->take_all()  // so that `side_choices` refuses any other number
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Side by side")
      ->excludes(maps)
      ->excludes(verb->get_option("--detector"));
  add_law_options(*verb, options->law, "Intensity");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_view(*options, invocation); });
}

}  // namespace vestige::cli
