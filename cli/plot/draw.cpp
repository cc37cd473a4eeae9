#include "cli/plot/draw.hpp"

#include <fmt/format.h>

#include <utility>

#include "analysis/base/results_folder.hpp"
#include "analysis/mapping/layouts.hpp"
#include "analysis/plot/data/crowd_data.hpp"
#include "analysis/plot/figures/accuracy_figure.hpp"
#include "analysis/plot/figures/avatar_figure.hpp"
#include "analysis/plot/figures/body_figure.hpp"
#include "analysis/plot/figures/growth_figure.hpp"
#include "analysis/plot/figures/measured_figure.hpp"
#include "analysis/plot/figures/scene_figure.hpp"
#include "analysis/plot/figures/skipping_figure.hpp"
#include "analysis/plot/figures/stage_figure.hpp"
#include "analysis/plot/figures/stress_figure.hpp"
#include "analysis/plot/figures/sweep_figure.hpp"
#include "analysis/plot/figures/texture_figure.hpp"
#include "analysis/plot/figures/timeline_figure.hpp"
#include "analysis/plot/paraview/paraview_export.hpp"
#include "analysis/plot/report/report.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/scene/people.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

namespace {

/// NAME.json, which 'vestige NAME' wrote into the input folder, as NAME.svg and .png there or in OUT.
int draw_results(const Options& options, const char* name,
                 std::unique_ptr<Figure> (*figure_of)(const std::filesystem::path& folder)) {
  const std::filesystem::path& folder = options.inputs.front();
  const std::filesystem::path results = folder / fmt::format("{}.json", name);
  const std::string remedy = fmt::format("name a folder that 'vestige {} -o' wrote", name);
  require_folder(folder, remedy);
  if (!std::filesystem::exists(results)) throw Error(results.string(), "there is no such file", remedy);
  return write_figure(options, (options.output.empty() ? folder : options.output) / name,
                      [&] { return figure_of(folder); });
}

/// Where figures of a sweep go: OUT, otherwise beside the first input.
std::filesystem::path sweep_folder(const Options& options) {
  if (!options.output.empty()) return options.output;
  const std::filesystem::path& first = options.inputs.front();
  return std::filesystem::is_directory(first) ? first : first.parent_path();
}

/// Contacts of another avatar or map are not drawn. With --map, contacts name actuators of a map that is not there.
PersonLimits limits_of(const Options& options, const Subject& subject) {
  PersonLimits limits;
  limits.triangles = subject.avatar.triangles.size();
  if (options.map.empty() && subject.map.actuator_count > 0) limits.actuators = subject.map.actuator_count;
  return limits;
}

/// The map that --map names, which is of no certain avatar: a layout is made for the built-in one.
ActuatorMap map_of(const Options& options) {
  const ActuatorMapFiles files = read_map_files(read_subject("builtin", "none", "").avatar, options.map);
  ActuatorMap map = files.png.empty() ? ActuatorMap() : parse_actuator_map(files.png, files.json, options.map);
  warn(options, map.warnings);
  return map;
}

/// Larger than that, a figure fits neither on a page nor into OpenGL's windows.
constexpr std::size_t kMostAnimations = 4;

/// Returns whom --person chooses, counted from 0. Throws `UsageError` if several are there and nobody is chosen, or if
/// there is nobody of that number.
std::size_t person_of(const Options& options, std::size_t people) {
  const std::string file = options.inputs.front().string();
  if (options.person == 0 && people > 1)
    throw UsageError("--person", fmt::format("{} holds {} people", file, people), "choose one of them, from 1 on");
  if (options.person > people)
    throw UsageError(
        "--person",
        fmt::format("there is no person {} in {}, which holds {}", options.person, file, count_of_people(people)),
        "people count from 1");
  return options.person == 0 ? 0 : options.person - 1;
}

/// Reads the contacts of one person of a trace.
std::vector<RecordedContact> contacts_on(const Options& options, const Subject& subject, std::size_t people) {
  const std::size_t person = person_of(options, people);
  ContactLimits limits;
  limits.people.resize(people);
  limits.people[person] = limits_of(options, subject);
  std::vector<RecordedContact> contacts = read_contacts(options.contacts, limits);
  std::erase_if(contacts, [&](const RecordedContact& contact) { return contact.avatar != person + 1; });
  return contacts;
}

/// `damage` becomes the trace's part of the exit code, and `people` the number of its people.
Subject body_subject(const Options& options, int& damage, std::size_t& people) {
  if (options.inputs.empty()) return read_subject(options.avatar, options.map, options.facing.axis);
  TraceReader trace(options.inputs.front(), People::kSeveral);
  people = trace.people().size();
  Subject subject = read_subject(trace, options.inputs.front(), options.map, person_of(options, people));
  trace.frame_count();  // reads all of it
  damage = report_damage(options, trace);
  return subject;
}

}  // namespace

int draw_accuracy(const Options& options) {
  return draw_results(options, "accuracy",
                      [](const std::filesystem::path& folder) { return accuracy_figure(read_accuracy(folder)); });
}

int draw_sweep(const Options& options) {
  const Sweeps sweeps = read_sweeps(options.inputs);
  if (has_crowds(sweeps))
    return write_figure(options, sweep_folder(options) / "people", [&] { return growth_figure(crowd_growth(sweeps)); });
  return write_figure(options, sweep_folder(options) / "frequency", [&] { return sweep_figure(sweeps); });
}

int draw_stages(const Options& options) {
  std::vector<std::uint32_t> counts;
  if (!options.counts.empty()) counts = cli::parse_counts(options.counts, "--counts");
  return write_figure(options, sweep_folder(options) / "stages",
                      [&] { return stage_figure(read_stage_result(options.inputs.front(), counts)); });
}

int draw_skipping(const Options& options) {
  return write_figure(options, sweep_folder(options) / "skipping",
                      [&] { return skipping_figure(read_skipping(options.inputs)); });
}

int draw_latency(const Options& options) {
  return write_figure(options, stem_of(options), [&] { return latency_figure(read_latency(options.inputs.front())); });
}

int draw_growth(const Options& options) {
  return draw_results(options, "growth",
                      [](const std::filesystem::path& folder) { return growth_figure(read_growth(folder)); });
}

int draw_stress(const Options& options) {
  return draw_results(options, "stress",
                      [](const std::filesystem::path& folder) { return stress_figure(read_stress(folder)); });
}

Timeline chosen(const Timeline& timeline, const std::string& actuators) {
  const std::vector<std::uint32_t> numbers = cli::parse_counts(actuators, "--actuators");
  const std::uint32_t last = numbers.back();  // they ascend
  if (last > timeline.actuator_count)
    throw UsageError("--actuators",
                     fmt::format("there is no actuator {}: the timeline has {}", last, timeline.actuator_count),
                     "name actuators by their numbers, from 1");
  return only(timeline, numbers);
}

int draw_timeline(const Options& options) {
  return write_figure(options, stem_of(options), [&] {
    Timeline timeline = read_timeline(options.inputs.front());
    if (!options.map.empty()) {
      const ActuatorMap map = map_of(options);
      if (map.actuator_count != timeline.actuator_count)
        throw Error(options.map,
                    fmt::format("has {} actuators, but {} has {}", map.actuator_count, options.inputs.front().string(),
                                timeline.actuator_count),
                    "name the map that the timeline was made with");
      timeline.names = map.names;
    }
    if (!options.measured.empty())
      return measured_figure(std::move(timeline), read_timeline(options.measured), options.measured.string());
    return timeline_figure(options.actuators.empty() ? std::move(timeline) : chosen(timeline, options.actuators));
  });
}

int draw_textures(const Options& options) {
  return write_figure(options, stem_of(options), [&] {
    const std::filesystem::path& file = options.inputs.front();
    TextureContacts textures = read_texture_contacts(file, person_of(options, people_in_textures(file)));
    if (!options.map.empty()) {
      const ActuatorMap map = map_of(options);
      for (const TextureContact& contact : textures.contacts)
        if (contact.actuator > map.actuator_count)
          throw Error(options.map,
                      fmt::format("has {} actuators, but {} names actuator {}", map.actuator_count,
                                  options.inputs.front().string(), contact.actuator),
                      "name the map that the textures were made with");
      textures.names = map.names;
    }
    return texture_figure(std::move(textures));
  });
}

int draw_avatar(Options options) {
  if (options.output.empty())
    options.output = std::filesystem::path(options.inputs.front()).replace_extension().string() + "-avatar";
  return write_figure(options, stem_of(options), [&] {
    const std::string input = options.inputs.front();
    ContactSheet sheet;
    sheet.subject = read_subject(input, "none", options.facing.axis);
    warn_of(options, sheet.subject);
    sheet.animations = ContactSheet::choose(sheet.subject.avatar, options.animation);
    sheet.poses = options.poses;
    if (sheet.animations.size() > kMostAnimations) {
      warn(options,
           fmt::format("{}: has {} animations, and only the first {} are drawn; choose another with --animation", input,
                       sheet.animations.size(), kMostAnimations));
      sheet.animations.resize(kMostAnimations);
    }
    for (const Animation* animation : sheet.animations)
      if (animation != nullptr && animation->morph)
        warn(options,
             fmt::format("{}: {}; this motion is not drawn", animation->morph->where, describe_morph(*animation)));
    return avatar_figure(sheet);
  });
}

int draw_body(Options options) {
  if (options.inputs.empty() == options.avatar.empty())
    throw UsageError("plot body", "needs either a trace or --avatar", "name one of them");
  const std::string input = options.inputs.empty() ? options.avatar : options.inputs.front().string();
  if (options.output.empty()) options.output = std::filesystem::path(input).replace_extension().string() + "-body";
  int damage = cli::kDone;
  const int drawn = write_figure(options, stem_of(options), [&] {
    Body body;
    std::size_t people = 1;
    body.subject = body_subject(options, damage, people);
    warn_of(options, body.subject);
    body.has_contacts = !options.contacts.empty();
    if (body.subject.map.actuator_count == 0 && !body.has_contacts && !options.map.empty() && options.map != "none")
      throw Error(options.map, "has no actuator", "paint regions other than black");
    if (body.subject.map.actuator_count == 0 && !body.has_contacts)
      throw Error(input, "there is no actuator map, and no contact", "name a --map, or --contacts, or both");
    if (body.has_contacts) body.contacts = contacts_on(options, body.subject, people);
    return body_figure(std::move(body));
  });
  return drawn == cli::kDone ? damage : drawn;
}

int draw_scene(Options options) {
  const std::filesystem::path& input = options.inputs.front();
  if (options.output.empty()) options.output = std::filesystem::path(input).replace_extension().string() + "-scene";
  options.moments.trail_s = options.trail_ms / 1000;
  int damage = cli::kDone;
  const int drawn = write_figure(options, stem_of(options), [&] {
    TraceReader trace(input, People::kSeveral);
    Scene scene;
    scene.subjects = read_people(options, trace);
    ContactLimits limits;
    limits.people.clear();
    for (const Subject& subject : scene.subjects) limits.people.push_back(limits_of(options, subject));
    scene.trail_s = options.moments.trail_s;
    scene.has_contacts = !options.contacts.empty();
    scene.colour_by = options.colour_by == "collider" ? ColourBy::kCollider : ColourBy::kKind;
    const std::vector<FrameTime> times = frame_times(trace, input.string());
    damage = report_damage(options, trace);
    limits.frames = times.back().index + 1;
    std::vector<RecordedContact> contacts;
    if (scene.has_contacts) contacts = read_contacts(options.contacts, limits);
    scene.moments = read_moments(trace, input.string(), times, options.moments, contacts);
    return scene_figure(scene);
  });
  return drawn == cli::kDone ? damage : drawn;
}

int draw_report(const Options& options) {
  const std::filesystem::path& batch = options.inputs.front();
  ReportOptions settings;
  settings.output = options.output.empty() ? batch : options.output;
  settings.top = options.top;
  settings.overwrite = overwrite_of(options);
  cli::catch_interrupts();
  ReportOutcome outcome;
  {
    cli::Progress progress("report", options.quiet ? cli::Verbosity::kQuiet : cli::Verbosity::kNormal);
    outcome = write_report(batch, settings, [&](double share) { return progress.update(share); });
  }
  if (outcome.interrupted) throw Error((settings.output / "report.html").string(), cli::kStopped, cli::kStartAgain);
  warn(options, outcome.warnings);
  if (!options.quiet)
    print_message(fmt::format("wrote {}, and {} figures in {}\n", outcome.page.string(), outcome.figures,
                              (outcome.page.parent_path() / "figures").string()));
  return outcome.has_pictures ? cli::kDone : cli::kDataLost;
}

int draw_paraview(const Options& options) {
  const std::filesystem::path& input = options.inputs.front();
  if (input == "-" && options.output.empty())
    throw UsageError("-o", "a trace from standard input has no name", "name -o FILE.pvd");
  std::filesystem::path stem = options.output;
  if (stem.empty())
    stem = std::filesystem::path(input).replace_extension();
  else if (stem.extension() == ".pvd")
    stem.replace_extension();
  else
    stem /= input.stem();
  TraceReader trace(input, People::kSeveral);
  const std::size_t person = person_of(options, trace.people().size());
  const Subject subject = read_subject(trace, input, options.map, person);
  warn_of(options, subject);
  if (subject.map.actuator_count == 0) warn(options, "there is no actuator map, so every amplitude is 0");
  ParaviewOptions settings;
  options.law.check();
  settings.law = options.law.law;
  settings.law_options = options.law.options();
  require_spheres(std::span(&options.law.law, 1), trace.has_spheres(), input.string());
  settings.rate_hz = options.rate_hz;
  if (options.every != 0) settings.every = options.every;
  settings.person = person;
  if (!stem.parent_path().empty()) make_folder(stem.parent_path());
  ParaviewSeries series(stem, overwrite_of(options), subject);
  cli::catch_interrupts();
  ParaviewResult result;
  {
    cli::Progress progress("paraview", options.quiet ? cli::Verbosity::kQuiet : cli::Verbosity::kNormal);
    result = export_to_paraview(trace, subject, settings, series, [&](double share) { return progress.update(share); });
  }
  const int damage = report_damage(options, trace);
  if (result.frames == 0) require_frames(trace, input.string());
  series.commit();
  if (result.interrupted) warn(options, "stopped after " + counted(result.frames, "frame"));
  if (!options.quiet)
    print_message(fmt::format("wrote {}.pvd: {} from {}, {}\n", stem.string(), counted(series.steps(), "time step"),
                              counted(result.frames, "frame"), counted(result.contacts, "contact")));
  return result.interrupted ? cli::kDataLost : damage;
}

}  // namespace vestige::plot
