#include "analysis/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <set>

#include "analysis/accuracy_report.hpp"
#include "analysis/provenance.hpp"
#include "cli/detectors.hpp"
#include "cli/help/validators.hpp"
#include "cli/scene.hpp"
#include "cli/scene_choice.hpp"
#include "cli/verbs.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

namespace {

constexpr double kMostFrames = 4294967295.0;

struct AccuracyOptions {
  CommonOptions common;
  DetectorChoice choice;
  SceneChoice scene;
  std::string detectors = "paper,cpu";
  std::string methods = "static,carried,ccd";
  std::string rates = "60,90,250,1000,4000,10000";
  double duration_s = 2;
  std::string truth = "cpu";
  double truth_rate_hz = 30720;
  bool no_figure = false;
  std::string output;
};

/// The parts of a list, each of which must be known and stand there once.
template <typename IsKnown>
std::vector<std::string> parse_names(const std::string& list, const std::string& flag, const std::string& remedy,
                                     IsKnown&& is_known) {
  std::vector<std::string> names = parse_list(list);
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!is_known(name)) throw UsageError(flag, fmt::format("there is no '{}'", name), remedy);
    if (!seen.insert(name).second)
      throw UsageError(flag, fmt::format("'{}' stands there twice", name), "name each once");
  }
  return names;
}

std::vector<double> parse_rates(const AccuracyOptions& options) {
  const std::string remedy = "give rates in Hz, as 60,90,1000";
  std::set<double> rates_hz;
  for (const std::string& text : parse_list(options.rates)) {
    double rate_hz = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), rate_hz);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(rate_hz) || !(rate_hz > 0))
      throw UsageError("--rate", fmt::format("'{}' is no rate", text), remedy);
    if (rate_hz > options.truth_rate_hz / 2)
      throw UsageError("--rate",
                       fmt::format("{} Hz is more than half of the truth's {} Hz", text, options.truth_rate_hz),
                       "the truth must see more than what is measured by it: raise --truth-rate");
    if (rate_hz * options.duration_s < 2)
      throw UsageError("--rate", fmt::format("at {} Hz, {} s hold less than two frames", text, options.duration_s),
                       "raise --duration");
    if (!rates_hz.insert(rate_hz).second)
      throw UsageError("--rate", fmt::format("'{}' stands there twice", text), "name each once");
  }
  if (rates_hz.empty()) throw UsageError("--rate", "the list is empty", remedy);
  return {rates_hz.begin(), rates_hz.end()};
}

Method method_of(const std::string& name) {
  DetectorChoice choice;
  choice.method = name;
  return choice.method_kind();
}

/// Every detector with every method that it has; what cannot run is said.
std::vector<AccuracyContestant> make_contestants(const AccuracyOptions& options, const Scene& scene) {
  std::vector<AccuracyContestant> contestants;
  for (const std::string& detector : parse_list(options.detectors))
    for (const std::string& method : parse_list(options.methods)) {
      DetectorChoice choice = options.choice;
      choice.method = method;
      try {
        contestants.push_back({detector, method_of(method),
                               make_detector(detector, choice.context, choice, scene.avatar, scene.map, Plane::kTime)});
      } catch (const Error& error) {
        warn(fmt::format("no '{}' with {}: {}", detector, method, error.what()), options.common.verbosity());
      }
    }
  if (contestants.empty())
    throw Error("--detector", "none of those asked for can run here with a method asked for",
                "'vestige devices' lists this machine's OpenGL contexts; --detector cpu needs none");
  return contestants;
}

/// Those that have a column, ascending.
std::vector<std::uint32_t> collider_ids(const AccuracyOptions& options, ColliderSource& colliders) {
  if (!options.scene.from_file()) {
    std::vector<std::uint32_t> ids(options.scene.collider_count());
    std::iota(ids.begin(), ids.end(), 0U);
    return ids;
  }
  std::set<std::uint32_t> ids;
  std::vector<ColliderSample> samples;
  const auto frames = static_cast<std::uint64_t>(options.truth_rate_hz * options.duration_s);
  for (std::uint64_t i = 0; i <= frames; ++i) {
    colliders.sample(static_cast<double>(i) / options.truth_rate_hz, samples);
    for (const ColliderSample& sample : samples) ids.insert(sample.id);
  }
  return {ids.begin(), ids.end()};
}

void draw_figure(const AccuracyOptions& options) {
  std::vector<std::string> arguments = {"accuracy", options.output};
  if (options.common.force) arguments.emplace_back("--force");
  if (options.common.quiet) arguments.emplace_back("-q");
  try {
    if (run_plot(arguments) != kDone) warn("the figure is not complete", options.common.verbosity());
  } catch (const Error& error) {
    warn(fmt::format("no figure was drawn: {}", error.what()), options.common.verbosity());
  }
}

struct Truth {
  TrueContacts full;
  TrueContacts half;
};

Truth find_truth(const AccuracyOptions& options, const Scene& scene, const MovingScene& moving) {
  const auto make = [&] {
    DetectorChoice choice;
    choice.surface = options.choice.surface;
    choice.method = "ccd";
    return make_detector(options.truth, "", choice, scene.avatar, scene.map, Plane::kTime);
  };
  Progress progress("Finding the true contacts", options.common.verbosity());
  const double rate_hz = options.truth_rate_hz;
  Truth truth;
  truth.full = find_true_contacts(moving, rate_hz, make, [&](double share) { return progress.update(share * 2 / 3); });
  truth.half =
      find_true_contacts(moving, rate_hz / 2, make, [&](double share) { return progress.update((share + 2) / 3); });
  if (interrupted())
    throw Error("accuracy", "was stopped before anything had been measured", "start it again, with --force");
  return truth;
}

nlohmann::ordered_json scene_json(const AccuracyOptions& options, const Scene& scene, const MovingScene& moving) {
  return {{"avatar", options.scene.avatar},
          {"triangles", scene.avatar.triangles.size()},
          {"actuators", scene.map.actuator_count},
          {"animation", moving.animation == nullptr ? "none" : moving.animation->name},
          {"colliders", options.scene.colliders},
          {"count", moving.collider_ids.size()},
          {"duration_s", options.duration_s},
          {"surface", options.choice.surface},
          {"seed", options.common.seed}};
}

void run_accuracy_verb(const AccuracyOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  parse_names(options.detectors, "--detector", "'vestige replay --help' lists the detectors",
              [](const std::string& name) { return is_detector(name); });
  parse_names(options.methods, "--method", "choose of: static, carried, ccd",
              [](const std::string& name) { return name == "static" || name == "carried" || name == "ccd"; });
  if (options.truth_rate_hz * options.duration_s > kMostFrames)
    throw UsageError("--duration", "the truth would have more than 4294967295 frames", "lower it, or --truth-rate");
  const std::vector<double> rates_hz = parse_rates(options);
  check_scene_choice(options.scene);
  const std::string errors_path = options.output + "/accuracy.json";
  const std::string run_path = options.output + "/run.json";
  std::error_code failure;
  std::filesystem::create_directories(options.output, failure);
  if (failure) throw Error(options.output, "the folder cannot be made: " + failure.message(), "choose another -o");
  check_outputs({errors_path, run_path, options.common.json},
                {options.scene.avatar, options.scene.map, options.scene.colliders}, options.common);

  const Scene scene = load_scene(options.scene.avatar, options.scene.map, verbosity);
  MovingScene moving{
      scene.avatar, find_animation(scene.avatar, options.scene.animation), nullptr, {}, options.duration_s};
  moving.make_colliders = [&options, &scene, animation = moving.animation] {
    return make_colliders(options.scene, scene.avatar, animation, options.common.seed);
  };
  const std::unique_ptr<ColliderSource> colliders = moving.make_colliders();
  check_colliders(options.scene, *colliders, options.duration_s, verbosity);
  moving.collider_ids = collider_ids(options, *colliders);
  const std::vector<AccuracyContestant> contestants = make_contestants(options, scene);
  catch_interrupts();
  const Truth truth = find_truth(options, scene, moving);
  if (truth.full.events.empty()) warn("nothing touches the avatar, so there is nothing to miss", verbosity);
  std::vector<AccuracyPoint> points;
  {
    Progress progress("Measuring", verbosity);
    points = run_accuracy(moving, truth.full, contestants, rates_hz, options.common.seed,
                          [&](double share) { return progress.update(share); });
  }
  if (points.empty())
    throw Error("accuracy", "was stopped before a rate had been measured", "start it again, with --force");

  const nlohmann::ordered_json results = {{"schema_version", 1},
                                          {"scene", scene_json(options, scene, moving)},
                                          {"truth", to_json(truth.full, truth.half, options.truth)},
                                          {"complete", !interrupted()},
                                          {"series", errors_json(points, contestants)}};
  nlohmann::ordered_json run = provenance(invocation.argv);
  run["series"] = times_json(points, contestants);
  write_json(errors_path, results, options.common);
  write_json(run_path, run, options.common);
  nlohmann::ordered_json both = results;
  both["run"] = run;
  write_json(options.common.json, both, options.common);

  if (interrupted()) warn("stopped early; the rates that were measured were written", verbosity);
  print_summary(accuracy_table(points, contestants, truth.full, truth.half), {options.common.json}, options.common);
  print_summary(fmt::format("written: {}, {}\n", errors_path, run_path), {options.common.json}, options.common);
  std::fflush(stdout);  // before the child that draws prints its own
  if (!options.no_figure && !interrupted()) draw_figure(options);
  if (interrupted()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_accuracy(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* verb = add_verb(program, "accuracy", "Measure run time against error: contacts missed, false and late",
                            "  vestige accuracy -o accuracy\n"
                            "  vestige accuracy --detector cpu --rate 60,1000 --duration 0.5 -o accuracy\n");
  verb->add_option("--rate", options->rates, "Frame rates at which the scene is sampled, in Hz")
      ->capture_default_str()
      ->type_name("LIST");
  verb->add_option("--detector", options->detectors, "Detectors to measure")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  add_detector_options(*verb, options->choice);
  verb->remove_option(verb->get_option("--method"));  // here it is a list
  verb->add_option("--method", options->methods,
                   "Methods to measure: static: each segment against the triangle as it is now, as the paper does; "
                   "carried: its start moves along with the triangle; ccd: both move, the first time they meet")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  verb->add_option("--context", options->choice.context, "Where detectors that need OpenGL run")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}));
  add_scene_options(*verb, options->scene);
  verb->add_option("--duration", options->duration_s, "How long the scene is, in seconds")
      ->type_name("S")
      ->capture_default_str()
      ->check(help::kPositive);
  verb->add_option("--truth", options->truth,
                   "The detector that finds the true contacts, by ccd; exact is independent of the others, and slow")
      ->capture_default_str()
      ->check(CLI::IsMember({"cpu", "exact"}));
  verb->add_option(
          "--truth-rate", options->truth_rate_hz,
          "Frames per second at which the true contacts are found; also at half of it, to see what that changes")
      ->type_name("HZ")
      ->capture_default_str()
      ->check(help::kPositive);
  verb->add_flag("--no-figure", options->no_figure, "Do not draw the figure");
  verb->add_option("-o,--output", options->output, "Folder for accuracy.json, run.json (times), and the figure")
      ->required()
      ->type_name("DIR");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_accuracy_verb(*options, invocation); });
}

}  // namespace vestige::cli
