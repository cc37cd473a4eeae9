#include "analysis/stress/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <set>

#include "analysis/base/provenance.hpp"
#include "analysis/base/results_folder.hpp"
#include "analysis/stress/stress_report.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

struct StressOptions {
  CommonOptions common;
  std::string detectors;
  std::string methods = "static,ccd";
  std::string families = "all";
  std::string context = "auto";
  int device = -1;
  StressSettings settings;
  bool no_figure = false;
  std::string output;
};

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const StressFamily& family : stress_families())
    if (names.empty() || names.back() != family.name) names.emplace_back(family.name);
  return names;
}

std::vector<StressFamily> families_of(const StressOptions& options) {
  std::vector<StressFamily> families = stress_families();
  if (options.families == "all") return families;
  const std::vector<std::string> names = parse_names(options.families, family_names(), "--families");
  std::erase_if(families,
                [&](const StressFamily& family) { return std::ranges::find(names, family.name) == names.end(); });
  return families;
}

struct Contestants {
  std::vector<StressContestant> list;
  nlohmann::ordered_json gl = nullptr;  ///< of the first that has one
};

/// Every detector with every method that it knows. What this machine lacks is said, and left out.
Contestants make_contestants(const StressOptions& options, Verbosity verbosity) {
  Contestants contestants;
  const StressSubject probe = make_subject(StressBody::kLoose);
  for (const std::string& detector : parse_names(options.detectors, skin_detector_names(), "--detector"))
    for (const std::string& method : parse_names(options.methods, kMethodNames, "--method")) {
      DetectorChoice choice;
      choice.method = method;
      choice.device = options.device;
      const auto make = [detector, choice, context = options.context](const StressSubject& subject) {
        return make_detector(detector, context, choice, subject.avatar, subject.map,
                             PlaneSet::all().without(Plane::kDepth));
      };
      try {
        const auto made = make(probe);
        if (contestants.gl.is_null()) contestants.gl = to_json(made->gl_info());
      } catch (const UsageError&) {
        continue;  // not its method
      } catch (const Error& error) {
        warn(fmt::format("'{}' is left out: {}", detector, error.what()), verbosity);
        break;
      }
      contestants.list.push_back({detector, choice.method_kind(), make, takes_radii(detector)});
    }
  if (contestants.list.empty())
    throw Error("--detector", "none of the listed detectors can run here with these methods",
                "choose --detector cpu, which knows every method and needs no OpenGL");
  return contestants;
}

void run_stress_verb(const StressOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::vector<StressFamily> families = families_of(options);
  parse_names(options.methods, kMethodNames, "--method");
  parse_names(options.detectors, skin_detector_names(), "--detector");
  const std::string json_path = options.output + "/stress.json";
  const std::string run_path = options.output + "/run.json";
  make_output_folder(options.output);
  refuse_other_results(options.output, "stress");
  check_outputs({json_path, run_path, options.common.json}, {}, options.common);
  catch_interrupts();
  const Contestants contestants = make_contestants(options, verbosity);
  if (verbosity == Verbosity::kVerbose) print_message(family_definitions());

  const auto start = std::chrono::steady_clock::now();
  std::vector<StressCount> counts;
  {
    Progress progress("Stressing", verbosity);
    StressSettings settings = options.settings;
    settings.seed = options.common.seed;
    counts = run_stress(families, contestants.list, settings, [&](double share) { return progress.update(share); });
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (counts.empty()) throw Error("stress", "was stopped before anything had been measured", "start it again");

  nlohmann::ordered_json result;
  result["schema_version"] = 1;
  result["seed"] = options.common.seed;
  result["complete"] = !interrupted();
  result["families"] = to_json(counts);
  nlohmann::ordered_json run = provenance(invocation.argv);
  run["gl"] = contestants.gl;
  run["seconds"] = elapsed.count();
  write_json(json_path, result, options.common);
  write_json(run_path, run, options.common);
  run.update(result);
  write_json(options.common.json, run, options.common);

  if (interrupted()) warn("stopped early; the complete results so far were written, and no figure is drawn", verbosity);
  print_summary(stress_table(counts), {options.common.json}, options.common);
  print_summary(fmt::format("written: {}, {}\n", json_path, run_path), {options.common.json}, options.common);
  draw_or_remove_figure("stress", "stress", options.output, !options.no_figure && !interrupted(), options.common);
  if (interrupted()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_stress(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<StressOptions>();
  std::vector<std::string> raced = skin_detector_names();
  std::erase(raced, "exact");
  options->detectors = fmt::format("{}", fmt::join(raced, ","));
  CLI::App* verb = add_verb(program, "stress", "Attack the detectors with hostile cases, and count their errors",
                            "  vestige stress -o stress\n"
                            "  vestige stress --families watertight --detector cpu --n 10000 -o ladder\n");
  verb->add_option(
          "--families", options->families,
          fmt::format("Families of cases, any of: {}; -v prints their definitions", fmt::join(family_names(), ", ")))
      ->capture_default_str()
      ->type_name("all|LIST");
  verb->add_option("--n", options->settings.cases, "Number of cases for each family and magnitude")
      ->capture_default_str()
      ->check(help::whole_number(1, 100000000));
  verb->add_option("--detector", options->detectors, describe_detectors("attack", skin_detector_names()))
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  verb->add_option("--method", options->methods, describe_methods("attack"))
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  verb->add_option("--context", options->context, kContextHelp)
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}));
  verb->add_option("--device", options->device, kDeviceHelp)
      ->group(kDetectorGroup)
      ->check(help::whole_number(0, 1023))
      ->type_name("K");
  verb->add_flag("--no-figure", options->no_figure, "Do not draw the figure");
  verb->add_option("-o,--output", options->output, "Folder for stress.json, run.json and the figure")
      ->required()
      ->type_name("DIR");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_stress_verb(*options, invocation); });
}

}  // namespace vestige::cli
