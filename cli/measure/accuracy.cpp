#include "analysis/accuracy/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "analysis/accuracy/accuracy_report.hpp"
#include "analysis/accuracy/inside_time.hpp"
#include "analysis/accuracy/missed_page.hpp"
#include "analysis/base/provenance.hpp"
#include "analysis/base/results_folder.hpp"
#include "analysis/view/page.hpp"
#include "analysis/view/trace_page.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "traces/scene/radius.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

namespace {

struct AccuracyOptions {
  CommonOptions common;
  DetectorChoice choice;
  SceneChoice scene;
  std::string colliders = "swarm,hug,still";
  std::string detectors = "paper,cpu,embree,boxes,capsules,decimated";
  std::string methods = "static,carried,ccd";
  std::string rates = "30,60,90,250,1000";
  double duration_s = 1;
  std::uint64_t events = 300;
  double precision_pp = 0;  ///< 0: events alone decide
  std::uint64_t passes = 3;
  double tolerance_ms = 35;  // a little more than a frame at the lowest rate
  std::string truth = "cpu";
  double truth_rate_hz = 30720;
  std::uint64_t checked_frames = 1000;
  bool thorough = false;
  bool no_figure = false;
  bool chosen = false;  ///< --detector or --method was given
  std::string output;
};

std::vector<double> parse_rates(const AccuracyOptions& options) {
  const std::string remedy = "give rates in Hz, as 60,90,1000";
  std::set<double> rates_hz;
  for (const std::string& text : parse_list(options.rates)) {
    double rate_hz = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), rate_hz);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(rate_hz) || !(rate_hz > 0))
      throw UsageError("--rate", fmt::format("'{}' is not a positive number", text), remedy);
    if (rate_hz > options.truth_rate_hz / 2)
      throw UsageError("--rate",
                       fmt::format("{} Hz is more than half of the truth's {} Hz", text, options.truth_rate_hz),
                       "raise --truth-rate to at least twice the highest rate");
    if (rate_hz * options.duration_s < 2)
      throw UsageError("--rate", fmt::format("at {} Hz, {} s hold fewer than two frames", text, options.duration_s),
                       "raise --duration");
    if (!rates_hz.insert(rate_hz).second)
      throw UsageError("--rate", fmt::format("'{}' is given twice", text), "name each once");
  }
  if (rates_hz.empty()) throw UsageError("--rate", "the list is empty", remedy);
  return {rates_hz.begin(), rates_hz.end()};
}

/// Every detector with every method that it has; what cannot run is said, unless nobody asked for it.
std::vector<AccuracyContestant> make_contestants(const AccuracyOptions& options, const Scene& scene) {
  const Verbosity verbosity = options.common.verbosity();
  std::vector<AccuracyContestant> contestants;
  for (const std::string& detector : parse_list(options.detectors))
    for (const std::string& method : parse_list(options.methods)) {
      DetectorChoice choice = options.choice;
      choice.method = method;
      try {
        contestants.push_back({detector, method_named(method),
                               make_detector(detector, choice.context, choice, scene.avatar, scene.map, Plane::kTime)});
      } catch (const UsageError& error) {
        if (options.chosen)
          warn(fmt::format("'{}' with {} is left out: {}", detector, method, error.what()), verbosity);
      } catch (const Error& error) {
        warn(fmt::format("'{}' with {} is left out: {}", detector, method, error.what()), verbosity);
      }
    }
  if (contestants.empty())
    throw Error("--detector", "none of the listed detectors can run here with any of the listed methods",
                "'vestige devices' lists this machine's OpenGL contexts; --detector cpu needs no context");
  return contestants;
}

/// Finds the scene's colliders, and which of them have a radius.
void take_colliders(const AccuracyOptions& options, const SceneChoice& choice, ColliderSource& colliders,
                    MovingScene& scene) {
  if (!choice.from_file()) {
    scene.collider_ids.resize(choice.collider_count());
    std::iota(scene.collider_ids.begin(), scene.collider_ids.end(), 0U);
    scene.is_sphere.assign(scene.collider_ids.size(), colliders.shape() == ColliderShape::kSpheres);
    return;
  }
  std::map<std::uint32_t, bool> is_sphere;  // by id
  std::vector<ColliderSample> samples;
  const auto frames = static_cast<std::uint64_t>(options.truth_rate_hz * options.duration_s);
  for (std::uint64_t i = 0; i <= frames; ++i) {
    colliders.sample(static_cast<double>(i) / options.truth_rate_hz, samples);
    for (const ColliderSample& sample : samples) {
      bool& sphere = is_sphere.try_emplace(sample.id, false).first->second;
      sphere = sphere || is_sphere_radius(sample.radius_m);
    }
  }
  for (const auto& [id, sphere] : is_sphere) {
    scene.collider_ids.push_back(id);
    scene.is_sphere.push_back(sphere);
  }
}

/// The scenes asked for: alike but for the colliders.
std::vector<SceneChoice> scene_choices(const AccuracyOptions& options) {
  std::vector<SceneChoice> choices;
  for (const std::string& colliders : parse_distinct(options.colliders, "--colliders")) {
    choices.push_back(options.scene);
    choices.back().colliders = colliders;
    check_scene_choice(choices.back(), {options.scene.animation});
    if (colliders == kNoColliders)
      throw UsageError("--colliders", "without colliders there is nothing to measure", "name a scenario");
    if (choices.back().avatar == "builtin" && choices.back().animation.empty()) choices.back().animation = "walk";
  }
  if (choices.empty()) throw UsageError("--colliders", "the list is empty", "name a scenario, or a .csv or .glb file");
  return choices;
}

/// Why the page of what is missed has other numbers than the table.
std::string unlike_the_table(const MostMissed& most) {
  return fmt::format("contacts of each frame, where accuracy's table counts events of {} against true ones at {:g} Hz",
                     counted(most.point->seeds, "seed"), most.scene->truth_rate_hz);
}

/// Enough for any scene in which something happens.
constexpr std::uint64_t kMostSeeds = 1000;

class Measurement {
 public:
  Measurement(const AccuracyOptions& options, const Scene& scene, const Animation* animation,
              const std::vector<double>& rates_hz)
      : options_(options),
        scene_(scene),
        animation_(animation),
        settings_{rates_hz, options.tolerance_ms / 1e3, options.passes, options.common.seed},
        contestants_(make_contestants(options, scene)) {}

  const std::vector<AccuracyContestant>& contestants() const { return contestants_; }

  /// Measures seed after seed, until there are enough true events and intervals are narrow.
  AccuracyScene measure(const SceneChoice& choice) const {
    AccuracyScene sum;
    sum.colliders = choice.colliders;
    sum.truth_rate_hz = options_.truth_rate_hz;
    std::vector<std::size_t> which(contestants_.size());
    std::iota(which.begin(), which.end(), std::size_t{0});
    for (std::uint64_t k = 0; k < kMostSeeds && !which.empty(); ++k) {
      AccuracyScene one = measure(choice, options_.common.seed + k, which);
      if (k == 0 && one.true_events == 0 && !interrupted()) {
        warn(fmt::format("{}: no collider touches the avatar, so there is no contact to miss: it is left out",
                         choice.colliders),
             options_.common.verbosity());
        return one;
      }
      if (interrupted()) {
        if (k == 0) return one;
        break;
      }
      sum.collider_count = one.collider_count;
      sum += one;
      if (sum.true_events >= options_.events) leave_out_precise(sum, which);
      if (choice.from_file()) break;  // it is the same with every seed
    }
    if (!which.empty() && options_.precision_pp > 0 && !interrupted())
      warn(fmt::format("{}: the intervals are wider than --precision asks for", choice.colliders),
           options_.common.verbosity());
    if (sum.true_events < options_.events && !interrupted())
      warn(fmt::format("{}: {} true events, but --events asks for {}: the intervals are wider", choice.colliders,
                       sum.true_events, options_.events),
           options_.common.verbosity());
    return sum;
  }

  /// Writes the page on which the detector that misses most stands beside exact detection: of the first seed in which
  /// it misses something. Returns what the page shows; "" if no page is written.
  std::string write_missed(std::span<const AccuracyScene> scenes, std::span<const SceneChoice> choices,
                           const std::string& path) const {
    const std::optional<MostMissed> most = most_missed(scenes, contestants_);
    if (!most) return "";
    const auto choice = std::ranges::find(choices, most->scene->colliders, &SceneChoice::colliders);
    const AccuracyContestant& contestant = contestants_[most->point->contestant];
    for (const std::uint64_t seed : most->scene->seeds) {
      std::vector<MissedSide> sides;
      sides.push_back(missed_side(contestant.detector, contestant.method));
      sides.push_back(missed_side("cpu", Method::kCcd));
      std::string what =
          fmt::format("What {} misses at {:g} Hz in {}", sides[0].title, most->point->rate_hz, most->scene->colliders);
      Progress progress(what, options_.common.verbosity());
      std::optional<MissedPage> page =
          missed_page(moving_scene(*choice, seed), scene_.map, {most->point->rate_hz, settings_.tolerance_s},
                      std::move(sides), [&](double share) { return progress.update(share); });
      if (!page) return "";
      if (page->contacts[0] == page->contacts[1] && seed != most->scene->seeds.back()) continue;
      page->content.head["about"] = {fmt::format("seed {}", seed), unlike_the_table(*most),
                                     "vestige " + commit().substr(0, 10)};
      OutputFile file(path, options_.common.overwrite());
      file.write(make_page(what, page->content));
      file.commit();
      return what;
    }
    return "";
  }

 private:
  MissedSide missed_side(const std::string& detector, Method method) const {
    DetectorChoice choice = options_.choice;
    choice.method = name_of(method);
    MissedSide side = {fmt::format("{}, {}", detector, choice.method), {}};
    side.detectors.push_back(make_detector(detector, choice.context, choice, scene_.avatar, scene_.map, kPagePlanes));
    return side;
  }

  /// Takes the contestants away that need no further seed.
  void leave_out_precise(const AccuracyScene& scene, std::vector<std::size_t>& which) const {
    // A little below what is asked for, since this is not the bootstrap of the report.
    const double wanted = 0.95 * options_.precision_pp / 100;
    std::erase_if(which, [&](std::size_t contestant) {
      return options_.precision_pp == 0 || std::ranges::all_of(scene.points, [&](const AccuracyPoint& point) {
               return point.contestant != contestant || point.precision() <= wanted;
             });
    });
  }

  MovingScene moving_scene(const SceneChoice& choice, std::uint64_t seed) const {
    MovingScene moving{scene_.avatar, animation_, nullptr, {}, options_.duration_s, {}};
    moving.make_colliders = [this, &choice, seed] { return make_colliders(choice, scene_.avatar, animation_, seed); };
    const std::unique_ptr<ColliderSource> colliders = moving.make_colliders();
    check_colliders(choice, *colliders, options_.duration_s, options_.common.verbosity());
    take_colliders(options_, choice, *colliders, moving);
    return moving;
  }

  AccuracyScene measure(const SceneChoice& choice, std::uint64_t seed, const std::vector<std::size_t>& which) const {
    const MovingScene moving = moving_scene(choice, seed);
    if (seed == options_.common.seed) warn_of_ignored_radii(moving, choice.colliders);
    AccuracyScene result;
    result.colliders = choice.colliders;
    result.truth_rate_hz = options_.truth_rate_hz;
    result.collider_count = moving.collider_ids.size();
    result.duration_s = moving.duration_s;
    result.seeds = {seed};
    const TrueContacts truth = find_truth(moving, result);
    if (interrupted()) return result;
    if (truth.events.empty() && seed == options_.common.seed) return result;
    Progress progress(choice.colliders + ", measuring", options_.common.verbosity());
    result.points = run_accuracy(moving, truth, contestants_, which, settings_,
                                 [&](double share) { return progress.update(share); });
    return result;
  }

  void warn_of_ignored_radii(const MovingScene& moving, const std::string& name) const {
    std::vector<std::string> detectors;
    for (const AccuracyContestant& contestant : contestants_)
      if (std::ranges::find(detectors, contestant.detector) == detectors.end())
        detectors.push_back(contestant.detector);
    const auto spheres = static_cast<std::size_t>(std::ranges::count(moving.is_sphere, true));
    warn_of_radii(detectors, spheres, moving.is_sphere.size(), name, options_.common.verbosity());
  }

  std::unique_ptr<Detector> make_truth(const std::string& detector) const {
    DetectorChoice choice;
    choice.surface = options_.choice.surface;
    choice.method = "ccd";
    return make_detector(detector, "", choice, scene_.avatar, scene_.map, Plane::kTime);
  }

  TrueContacts find_truth(const MovingScene& moving, AccuracyScene& result) const {
    const auto make = [&] { return make_truth(options_.truth); };
    Progress progress(result.colliders + ", true contacts", options_.common.verbosity());
    const double rate_hz = options_.truth_rate_hz;
    TrueContacts truth =
        find_true_contacts(moving, rate_hz, make, [&](double share) { return progress.update(share / 2); });
    const TrueContacts half =
        find_true_contacts(moving, rate_hz / 2, make, [&](double share) { return progress.update((share + 2) / 4); });
    result.checked_frames = check_true_contacts(
        moving, {rate_hz, options_.checked_frames, result.seeds.front(), make, [&] { return make_truth("exact"); }},
        [&](double share) { return progress.update((share + 3) / 4); });
    if (moving.has_spheres()) result.inside_s = inside_s(moving, truth);
    result.true_contacts = truth.contacts;
    result.true_events = truth.events.size();
    result.half_contacts = half.contacts;
    result.half_events = half.events.size();
    const double until_s =
        truth.events.empty() ? 0 : std::ranges::max(truth.events, {}, &ContactEvent::impact_s).impact_s;
    result.half_score = score_events(truth.events, half.events, moving.collider_ids.size(),
                                     {EventMatch::kOverlap, 2 / rate_hz}, until_s);
    return truth;
  }

  const AccuracyOptions& options_;
  const Scene& scene_;
  const Animation* animation_;  ///< null: none
  AccuracySettings settings_;
  std::vector<AccuracyContestant> contestants_;
};

nlohmann::ordered_json results_json(const AccuracyOptions& options, const SceneChoice& choice, const Scene& scene) {
  return {{"schema_version", 2},
          {"avatar", to_json(scene.avatar)},
          {"animation", choice.animation},
          {"duration_s", options.duration_s},
          {"surface", options.choice.surface},
          {"keep", options.choice.keep},
          {"tolerance_ms", options.tolerance_ms},
          {"precision_pp", options.precision_pp},
          {"seed", options.common.seed},
          {"complete", !interrupted()}};
}

/// Writes the page of what is missed to `path`, or removes that of an earlier run.
void show_missed(const Measurement& measurement, std::span<const AccuracyScene> scenes,
                 std::span<const SceneChoice> choices, const std::string& path, const AccuracyOptions& options) {
  const bool wanted = !options.no_figure && !interrupted();
  const std::string what = wanted ? measurement.write_missed(scenes, choices, path) : "";
  if (what.empty()) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  if (!wanted || interrupted()) return;
  print_summary(what.empty() ? "apart from ccd, nothing is missed within the tolerance: there is no page to watch\n"
                             : fmt::format("{}: {}; D goes from one to the next\n", path, what),
                {options.common.json}, options.common);
}

void run_accuracy_verb(const AccuracyOptions& options, Invocation& invocation) {
  parse_names(options.detectors, detector_names(), "--detector");
  parse_names(options.methods, kMethodNames, "--method");
  if (options.truth_rate_hz * options.duration_s > kMostTraceFrames)
    throw UsageError("--duration", "the truth would have more than 4294967295 frames",
                     "lower --duration or --truth-rate");
  if (!(options.tolerance_ms / 1e3 >= 1 / options.truth_rate_hz))
    throw UsageError("--tolerance",
                     fmt::format("{} ms is shorter than a frame of the truth, {:.3g} ms", options.tolerance_ms,
                                 1e3 / options.truth_rate_hz),
                     "raise --tolerance, or --truth-rate");
  const std::vector<double> rates_hz = parse_rates(options);
  const std::vector<SceneChoice> choices = scene_choices(options);
  const std::string errors_path = options.output + "/accuracy.json";
  const std::string run_path = options.output + "/run.json";
  make_output_folder(options.output);
  refuse_other_results(options.output, "accuracy");
  const std::string page_path = options.output + "/missed.html";
  const std::vector<std::string> outputs = {errors_path, run_path, page_path, options.common.json};
  check_outputs(outputs, {options.scene.avatar, options.scene.map}, options.common);

  catch_interrupts();
  Scene scene = load_scene(options.scene.avatar, options.scene.map, options.scene.facing, options.common.verbosity());
  load_motion(options.scene.animation, options.scene.motion, scene.avatar, outputs, options.common);
  const Animation* animation =
      choose_animation(scene.avatar, choices.front().animation, options.scene.morphs, options.common.verbosity());
  const Measurement measurement(options, scene, animation, rates_hz);
  std::vector<AccuracyScene> scenes;
  scenes.reserve(choices.size());
  for (const SceneChoice& choice : choices) {
    AccuracyScene measured = measurement.measure(choice);
    if (!measured.points.empty()) scenes.push_back(std::move(measured));
    if (interrupted()) break;
  }
  if (scenes.empty() && !interrupted())
    throw Error("--colliders", "no collider touches the avatar in any scene",
                "raise --duration or --count, or name other colliders");
  if (scenes.empty()) throw Error("accuracy", "was stopped before anything had been measured", "start it again");

  const std::vector<AccuracyContestant>& contestants = measurement.contestants();
  nlohmann::ordered_json results = results_json(options, choices.front(), scene);
  results["scenes"] = errors_json(scenes, contestants, options.truth);
  nlohmann::ordered_json run = provenance(invocation.argv);
  run["scenes"] = times_json(scenes, contestants);
  write_json(errors_path, results, options.common);
  write_json(run_path, run, options.common);
  results["run"] = run;
  write_json(options.common.json, results, options.common);

  if (interrupted())
    warn("stopped early; only what was measured completely was written, and no figure is drawn",
         options.common.verbosity());
  print_summary(accuracy_table(scenes, contestants, options.tolerance_ms / 1e3), {options.common.json}, options.common);
  print_summary(fmt::format("written: {}, {}\n", errors_path, run_path), {options.common.json}, options.common);
  show_missed(measurement, scenes, choices, page_path, options);
  draw_or_remove_figure("accuracy", "accuracy", options.output, !options.no_figure && !interrupted(), options.common);
  if (interrupted()) invocation.exit_code = kDataLost;
}

/// How much is measured, and how it is judged.
void add_effort_options(CLI::App& verb, AccuracyOptions& options) {
  verb.add_option("--events", options.events,
                  "Fewest true events of a scene: seeds are added until there are so many. More of them make the "
                  "intervals narrower")
      ->type_name("N")
      ->capture_default_str()
      ->check(help::whole_number(1, 1000000));
  verb.add_option("--precision", options.precision_pp,
                  "Half the width that the intervals of shares may have, in percentage points: seeds are added until "
                  "all are so narrow. Detectors that are done are not measured with further seeds [default: --events "
                  "alone decides]")
      ->type_name("POINTS")
      ->check(help::between(0.1, 50));
  verb.add_option("--passes", options.passes, "How often each frame is timed")
      ->type_name("N")
      ->capture_default_str()
      ->check(help::whole_number(1, 1000));
  verb.add_option("--tolerance", options.tolerance_ms,
                  "An event is also judged by this tolerance on its time of impact, in ms, the same for every rate; "
                  "the default is a little more than a frame at 30 Hz")
      ->type_name("MS")
      ->capture_default_str()
      ->check(help::between(1e-6, 1e6));
  verb.add_flag(
      "--thorough", options.thorough,
      "For publication, in hours: rates up to 10000 Hz, 2000 true events, intervals of 2 percentage points up "
      "and down, and 10 passes, where no flag says otherwise");
}

void add_truth_options(CLI::App& verb, AccuracyOptions& options) {
  verb.add_option("--truth", options.truth,
                  "The detector that finds the true contacts, by ccd. Of its frames, exact checks some")
      ->capture_default_str()
      ->check(CLI::IsMember({"cpu", "exact"}));
  verb.add_option("--truth-rate", options.truth_rate_hz,
                  "Frames per second at which the true contacts are found; half of this rate is used too, to show "
                  "the difference")
      ->type_name("HZ")
      ->capture_default_str()
      ->check(help::kPositive);
  verb.add_option("--check-frames", options.checked_frames,
                  "Whole frames of the truth that exact checks for each seed, drawn at random; they must agree")
      ->type_name("N")
      ->capture_default_str()
      ->check(help::whole_number(0, 1000000000));
}

}  // namespace

void add_accuracy(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* verb = add_verb(program, "accuracy", "Measure run time against error: contacts missed, false and late",
                            "  vestige accuracy -o accuracy\n"
                            "  vestige accuracy --detector cpu,boxes --rate 60,1000 --events 100 -o accuracy\n");
  verb->add_option("--rate", options->rates, "Frame rates at which the scene is sampled, in Hz")
      ->capture_default_str()
      ->type_name("LIST");
  verb->add_option("--detector", options->detectors, describe_detectors("measure", detector_names()))
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  add_detector_options(*verb, options->choice);
  verb->remove_option(verb->get_option("--method"));  // here it is a list
  verb->add_option("--method", options->methods, describe_methods("measure"))
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  verb->add_option("--context", options->choice.context, kContextHelp)
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}));
  add_scene_options(*verb, options->scene);
  verb->get_option("--animation")
      ->description(describe_animations("walk for the built-in avatar, otherwise the first"));
  verb->remove_option(verb->get_option("--colliders"));  // here it is a list, too
  verb->add_option("--colliders", options->colliders,
                   "Where the colliders come from: scenarios and files, with commas between them, each measured "
                   "separately; 'vestige record --help' explains them")
      ->capture_default_str()
      ->type_name("SCENARIO|FILE.csv|FILE.glb");
  add_effort_options(*verb, *options);
  verb->add_option("--duration", options->duration_s, "How long the scene lasts with each seed, in seconds")
      ->type_name("S")
      ->capture_default_str()
      ->check(help::kPositive);
  add_truth_options(*verb, *options);
  verb->add_flag("--no-figure", options->no_figure, "Draw neither the figure nor the page of missed contacts");
  verb->add_option("-o,--output", options->output,
                   "Folder for accuracy.json, run.json (times), the figure, and missed.html")
      ->required()
      ->type_name("DIR");
  add_common_options(*verb, options->common);
  verb->callback([verb, options, &invocation] {
    const auto thorough = [&](const char* flag, auto& value, const auto& of_thorough) {
      if (options->thorough && verb->count(flag) == 0) value = of_thorough;
    };
    thorough("--rate", options->rates, "30,60,90,250,1000,4000,10000");
    thorough("--events", options->events, 2000U);
    thorough("--precision", options->precision_pp, 2.0);
    thorough("--passes", options->passes, 10U);
    options->chosen = verb->count("--detector") + verb->count("--method") != 0;
    run_accuracy_verb(*options, invocation);
  });
}

}  // namespace vestige::cli
