#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/plot/accuracy_figure.hpp"
#include "analysis/plot/avatar_figure.hpp"
#include "analysis/plot/body_figure.hpp"
#include "analysis/plot/figure_export.hpp"
#include "analysis/plot/growth_figure.hpp"
#include "analysis/plot/headless_window.hpp"
#include "analysis/plot/measured_figure.hpp"
#include "analysis/plot/scene_figure.hpp"
#include "analysis/plot/stress_figure.hpp"
#include "analysis/plot/sweep_figure.hpp"
#include "analysis/plot/texture_figure.hpp"
#include "analysis/plot/timeline_figure.hpp"
#include "cli/help/command_table.hpp"
#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
#include "traces/trace_reader.hpp"
#include "version.hpp"

namespace {

using vestige::Overwrite;
using vestige::plot::Figure;
namespace help = vestige::help;
namespace plot = vestige::plot;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kIncomplete = 3;

struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string avatar;
  std::string map;
  std::filesystem::path contacts;
  std::filesystem::path measured;
  std::string animation;
  std::size_t poses = 6;
  plot::MomentChoice moments;
  double trail_ms = 100;
  bool force = false;
  bool quiet = false;
};

void warn(const Options& options, std::string_view text) {
  if (!options.quiet) vestige::print_message(fmt::format("vestige: warning: {}\n", text));
}

void warn(const Options& options, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) warn(options, text);
}

void write_file(const Options& options, const std::filesystem::path& path, std::string_view bytes) {
  vestige::OutputFile file(path, options.force ? Overwrite::kAllow : Overwrite::kRefuse);
  file.write(bytes);
  file.commit();
  if (!options.quiet) vestige::print_message(fmt::format("wrote {}\n", path.string()));
}

/// Writes STEM.svg and STEM.png.
int write_figure(const Options& options, const std::filesystem::path& stem,
                 const std::function<std::unique_ptr<Figure>()>& make_figure) {
  const std::filesystem::path svg = stem.string() + ".svg";
  const std::filesystem::path png = stem.string() + ".png";
  const Overwrite overwrite = options.force ? Overwrite::kAllow : Overwrite::kRefuse;
  vestige::refuse_overwrite(svg, overwrite);
  vestige::refuse_overwrite(png, overwrite);
  const std::unique_ptr<Figure> figure = make_figure();
  write_file(options, svg, plot::svg_of(*figure));
  try {
    write_file(options, png, plot::png_of(*figure));
  } catch (const plot::GlUnavailable& error) {
    warn(options, fmt::format("{}: left out: {}\n  install libegl1 and libgl1-mesa-dri, or convert the SVG: "
                              "rsvg-convert -d 300 -p 300",
                              png.string(), error.what()));
    return kIncomplete;
  }
  return kDone;
}

/// OUT of `-o OUT`, without .svg or .png; else the input's name without its extension.
std::filesystem::path stem_of(const Options& options) {
  std::filesystem::path stem = options.output;
  if (stem.empty()) return std::filesystem::path(options.inputs.front()).replace_extension();
  if (stem.extension() == ".svg" || stem.extension() == ".png") stem.replace_extension();
  return stem;
}

/// NAME.json, which 'vestige NAME' wrote into the input folder, as NAME.svg and .png there or in OUT.
int draw_results(const Options& options, const char* name,
                 std::unique_ptr<plot::Figure> (*figure_of)(const std::filesystem::path& folder)) {
  const std::filesystem::path& folder = options.inputs.front();
  const std::filesystem::path results = folder / fmt::format("{}.json", name);
  if (!std::filesystem::exists(results))
    throw vestige::Error(results.string(), "no such file",
                         fmt::format("name a folder that 'vestige {} -o' wrote", name));
  return write_figure(options, (options.output.empty() ? folder : options.output) / name,
                      [&] { return figure_of(folder); });
}

int draw_accuracy(const Options& options) {
  return draw_results(options, "accuracy", [](const std::filesystem::path& folder) {
    return plot::accuracy_figure(plot::read_accuracy(folder));
  });
}

int draw_sweep(const Options& options) {
  std::filesystem::path folder = options.output;
  if (folder.empty()) {
    const auto& first = options.inputs.front();
    folder = std::filesystem::is_directory(first) ? first : first.parent_path();
  }
  return write_figure(options, folder / "frequency",
                      [&] { return plot::sweep_figure(plot::read_sweeps(options.inputs)); });
}

int draw_growth(const Options& options) {
  return draw_results(options, "growth", [](const std::filesystem::path& folder) {
    return plot::growth_figure(plot::read_growth(folder));
  });
}

int draw_stress(const Options& options) {
  return draw_results(options, "stress", [](const std::filesystem::path& folder) {
    return plot::stress_figure(plot::read_stress(folder));
  });
}

int draw_timeline(const Options& options) {
  return write_figure(options, stem_of(options), [&] {
    plot::Timeline timeline = plot::read_timeline(options.inputs.front());
    if (!options.map.empty()) {
      const vestige::ActuatorMap map = plot::read_map(options.map, plot::read_subject("builtin", "none").avatar);
      warn(options, map.warnings);
      if (map.actuator_count != timeline.actuator_count)
        throw vestige::Error(options.map,
                             fmt::format("has {} actuators, and {} has {}", map.actuator_count,
                                         options.inputs.front().string(), timeline.actuator_count),
                             "name the map that the timeline was made with");
      timeline.names = map.names;
    }
    if (!options.measured.empty())
      return plot::measured_figure(std::move(timeline), plot::read_timeline(options.measured),
                                   options.measured.string());
    return plot::timeline_figure(std::move(timeline));
  });
}

int draw_textures(const Options& options) {
  return write_figure(options, stem_of(options),
                      [&] { return plot::texture_figure(plot::read_texture_contacts(options.inputs.front())); });
}

void warn_of(const Options& options, const plot::Subject& subject) {
  warn(options, subject.avatar.warnings);
  warn(options, subject.map.warnings);
}

/// What is wrong with a trace that was read to its end; its part of the exit code.
int report_damage(const Options& options, const vestige::TraceReader& trace) {
  if (trace.complete()) return kDone;
  warn(options, vestige::damage_of(trace, options.inputs.front().string()));
  return kIncomplete;
}

/// Contacts of another avatar or map are not drawn. With --map, contacts name actuators of a map that is not there.
vestige::ContactLimits limits_of(const Options& options, const plot::Subject& subject) {
  vestige::ContactLimits limits;
  limits.triangles = subject.avatar.triangles.size();
  if (options.map.empty() && subject.map.actuator_count > 0) limits.actuators = subject.map.actuator_count;
  return limits;
}

/// Larger than that, a figure fits neither on a page nor into OpenGL's windows.
constexpr std::size_t kMostAnimations = 4;

int draw_avatar(Options options) {
  if (options.output.empty())
    options.output = std::filesystem::path(options.inputs.front()).replace_extension().string() + "-avatar";
  return write_figure(options, stem_of(options), [&] {
    const std::string input = options.inputs.front();
    plot::ContactSheet sheet;
    sheet.subject = plot::read_subject(input, "none");
    warn_of(options, sheet.subject);
    sheet.animations = plot::ContactSheet::choose(sheet.subject.avatar, options.animation);
    sheet.poses = options.poses;
    if (sheet.animations.size() > kMostAnimations) {
      warn(options, fmt::format("{}: has {} animations, of which the first {} are drawn; name others with --animation",
                                input, sheet.animations.size(), kMostAnimations));
      sheet.animations.resize(kMostAnimations);
    }
    return plot::avatar_figure(sheet);
  });
}

/// `damage` becomes the trace's part of the exit code.
plot::Subject body_subject(const Options& options, int& damage) {
  if (options.inputs.empty()) return plot::read_subject(options.avatar, options.map);
  vestige::TraceReader trace(options.inputs.front());
  plot::Subject subject = plot::read_subject(trace, options.inputs.front(), options.map);
  trace.frame_count();  // reads all of it
  damage = report_damage(options, trace);
  return subject;
}

int draw_body(Options options) {
  if (options.inputs.empty() == options.avatar.empty())
    throw vestige::UsageError("plot body", "needs either a trace or --avatar", "name one of them");
  const std::string input = options.inputs.empty() ? options.avatar : options.inputs.front().string();
  if (options.output.empty()) options.output = std::filesystem::path(input).replace_extension().string() + "-body";
  int damage = kDone;
  const int drawn = write_figure(options, stem_of(options), [&] {
    plot::Body body;
    body.subject = body_subject(options, damage);
    warn_of(options, body.subject);
    body.has_contacts = !options.contacts.empty();
    if (body.subject.map.actuator_count == 0 && !body.has_contacts)
      throw vestige::Error(input, "there is no actuator map, and no contact", "name a --map, or --contacts, or both");
    if (body.has_contacts)
      body.contacts = vestige::read_contacts_csv(options.contacts, limits_of(options, body.subject));
    return plot::body_figure(std::move(body));
  });
  return drawn == kDone ? damage : drawn;
}

int draw_scene(Options options) {
  const std::filesystem::path& input = options.inputs.front();
  if (options.output.empty()) options.output = std::filesystem::path(input).replace_extension().string() + "-scene";
  options.moments.trail_s = options.trail_ms / 1000;
  int damage = kDone;
  const int drawn = write_figure(options, stem_of(options), [&] {
    vestige::TraceReader trace(input);
    plot::Scene scene;
    scene.subject = plot::read_subject(trace, input, options.map);
    warn_of(options, scene.subject);
    scene.trail_s = options.moments.trail_s;
    scene.has_contacts = !options.contacts.empty();
    const std::vector<plot::FrameTime> times = plot::frame_times(trace, input.string());
    damage = report_damage(options, trace);
    vestige::ContactLimits limits = limits_of(options, scene.subject);
    limits.frames = times.back().index + 1;
    std::vector<vestige::RecordedContact> contacts;
    if (scene.has_contacts) contacts = vestige::read_contacts_csv(options.contacts, limits);
    scene.moments = plot::read_moments(trace, input.string(), times, options.moments, contacts);
    return plot::scene_figure(scene);
  });
  return drawn == kDone ? damage : drawn;
}

CLI::App& add_command(CLI::App& app, const char* name, const char* what, const std::string& examples) {
  CLI::App& command = *app.add_subcommand(name, what);
  command.formatter(std::make_shared<help::HelpFormatter>(examples));
  command.group("Verbs");
  return command;
}

/// The folder that the verb of the same name wrote.
void add_results_input(CLI::App& command, Options& options) {
  command
      .add_option("INPUT", options.inputs, fmt::format("The folder that 'vestige {} -o DIR' wrote", command.get_name()))
      ->type_name("DIR")
      ->expected(1)
      ->required();
}

void add_common_options(CLI::App& command, Options& options, const char* output_name, const char* output_help) {
  command.add_option("-o", options.output, output_help)->type_name(output_name);
  command.add_flag("--force", options.force, "Overwrite existing files");
  command.add_flag("-q,--quiet", options.quiet, "Print errors only");
  command.set_help_flag("-h,--help", "Print this help");
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Draw results, traces and avatars as figures, SVG and PNG (300 dots per inch)", "vestige plot");
  app.formatter(
      std::make_shared<help::HelpFormatter>("  vestige plot sweep results/sweep\n"
                                            "  vestige plot body man.mcap --contacts contacts.csv\n"));
  app.set_version_flag("--version", fmt::format("vestige-plot {} ({}{})", vestige::kVersion, vestige::kCommit,
                                                vestige::kDirty ? ", modified" : ""));
  app.get_option("--version")->description("Print version and commit");
  app.require_subcommand(1);

  CLI::App& sweep = add_command(app, "sweep", "Detection frequency over the number of colliders (frequency.svg, .png)",
                                "  vestige plot sweep results/sweep\n"
                                "  vestige plot sweep gpu/sweep.json software/sweep.json -o figures\n");
  sweep
      .add_option("INPUT", options.inputs,
                  "The sweep.json to draw, or the folder that holds it; several go into one figure")
      ->type_name("DIR|JSON")
      ->required();
  add_common_options(sweep, options, "DIR", "Folder for the figures [default: beside the first input]");

  CLI::App& accuracy = add_command(app, "accuracy", "Contacts missed over run time (accuracy.svg, .png)",
                                   "  vestige plot accuracy results/accuracy\n"
                                   "  vestige plot accuracy results/accuracy -o figures\n");
  add_results_input(accuracy, options);
  add_common_options(accuracy, options, "DIR", "Folder for the figure [default: the input]");

  CLI::App& growth = add_command(app, "growth", "Cost over colliders and over triangles (growth.svg, .png)",
                                 "  vestige plot growth results/growth\n"
                                 "  vestige plot growth results/growth -o figures\n");
  add_results_input(growth, options);
  add_common_options(growth, options, "DIR", "Folder for the figure [default: the input]");

  CLI::App& stress = add_command(app, "stress", "What each detector gets wrong, by family of hostile cases",
                                 "  vestige plot stress results/stress\n"
                                 "  vestige plot stress results/stress -o figures\n");
  add_results_input(stress, options);
  add_common_options(stress, options, "DIR", "Folder for the figures [default: the input]");

  CLI::App& timeline = add_command(app, "timeline", "Duty of every actuator over time",
                                   "  vestige plot timeline timeline.csv\n"
                                   "  vestige plot timeline timeline.csv --map builtin -o figures/timeline\n");
  timeline.add_option("INPUT", options.inputs, "What 'vestige replay --timeline FILE.csv' wrote")
      ->type_name("CSV")
      ->expected(1)
      ->required();
  timeline.add_option("--map", options.map, "The actuator map that names the actuators [default: numbers alone]")
      ->type_name("builtin|LAYOUT|FILE.png");
  timeline.add_option("--measured", options.measured, "What a board's pins did meanwhile, as CSV like a timeline")
      ->type_name("CSV");
  add_common_options(timeline, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name]");

  CLI::App& textures =
      add_command(app, "textures", "Collision textures: which actuator each collider touched, and when",
                  "  vestige plot textures textures.exr\n"
                  "  vestige plot textures textures.exr -o figures/textures\n");
  textures.add_option("INPUT", options.inputs, "What 'vestige replay --textures FILE.exr' wrote")
      ->type_name("EXR")
      ->expected(1)
      ->required();
  add_common_options(textures, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name]");

  CLI::App& body =
      add_command(app, "body", "An avatar with the regions of its actuator map, contacts and their density",
                  "  vestige plot body man.mcap --contacts contacts.csv\n"
                  "  vestige plot body --avatar man.glb --map regions.png -o figures/regions\n");
  body.add_option("INPUT", options.inputs, "A trace, whose avatar and map are drawn")->type_name("MCAP")->expected(1);
  body.add_option("--avatar", options.avatar, "Instead of a trace: the built-in avatar, or a glTF file")
      ->type_name("builtin|FILE");
  body.add_option(
          "--map", options.map,
          "The actuator map, a greyscale PNG whose FILE.json names the actuators if it exists, or a layout ('vestige "
          "map make' lists them) [default: the trace's]")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  body.add_option("--contacts", options.contacts, "What 'vestige replay --contacts FILE.csv' wrote")->type_name("CSV");
  add_common_options(body, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -body]");

  CLI::App& scene =
      add_command(app, "scene", "A film strip of a trace: the avatar, the colliders and their paths",
                  "  vestige plot scene man.mcap\n"
                  "  vestige plot scene man.mcap --contacts contacts.csv --frames 4 --from 0.1 --to 0.2\n");
  scene.add_option("INPUT", options.inputs, "The trace")->type_name("MCAP")->expected(1)->required();
  scene.add_option("--frames", options.moments.count, "How many frames are drawn")
      ->capture_default_str()
      ->check(CLI::Range(1, 24));
  scene.add_option("--from", options.moments.from_s, "Leave out what is before [default: the trace's beginning]")
      ->type_name("SECONDS")
      ->check(help::kFinite);
  scene.add_option("--to", options.moments.to_s, "Leave out what is after [default: the trace's end]")
      ->type_name("SECONDS")
      ->check(help::kFinite);
  scene.add_option("--trail", options.trail_ms, "How far back paths and contacts are shown")
      ->capture_default_str()
      ->type_name("MS")
      ->check(help::between(0.001, 10000));
  scene
      .add_option("--contacts", options.contacts,
                  "What 'vestige replay --contacts FILE.csv' wrote; the frames drawn are then ones with contacts")
      ->type_name("CSV");
  scene.add_option("--map", options.map, "Actuator map instead of the trace's")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  add_common_options(scene, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -scene]");

  CLI::App& avatar = add_command(app, "avatar", "An avatar from four sides, in poses over its animations",
                                 "  vestige plot avatar builtin\n"
                                 "  vestige plot avatar man.glb --animation walk -o figures/walk\n");
  avatar.add_option("INPUT", options.inputs, "The built-in avatar, or a glTF file (.glb, .gltf, .vrm)")
      ->type_name("builtin|FILE")
      ->expected(1)
      ->required();
  avatar
      .add_option("--animation", options.animation,
                  "One animation: a name, an index, or none for the rest pose [default: all]")
      ->type_name("NAME|INDEX|none");
  avatar.add_option("--poses", options.poses, "Poses of each animation")
      ->capture_default_str()
      ->check(CLI::Range(1, 12));
  add_common_options(avatar, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -avatar]");

  app.set_help_flag("-h,--help", "Print this help");
  // What `vestige` asks of its helper, to answer for `vestige plot`.
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "complete" || word == "man") {
    const help::CommandTable table = help::command_table(app);
    fmt::print("{}", word == "complete"
                         ? help::completions(table, {argv + 2, argv + argc})
                         : help::manual_page(table, help::VerbPages::kNone, vestige::kVersion, vestige::kCommitDate));
    if (std::fflush(stdout) != 0) throw vestige::system_error("standard output", "could not write", errno);
    return kDone;
  }
  if (!word.empty() && word.front() != '-')
    if (const auto remedy = help::unknown_verb_remedy(app, word))
      throw vestige::UsageError(word, "there is no such figure", *remedy);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_asked_for) {
    const int shown = app.exit(help_asked_for);
    std::cout.flush();
    if (!std::cout) throw vestige::system_error("standard output", "could not write", errno);
    return shown;
  } catch (const CLI::ParseError& error) {
    vestige::print_message(fmt::format("vestige: error: {}\n  'vestige plot --help' lists what can be drawn.\n",
                                       help::cause_of(app, error)));
    return kWrongUsage;
  }
  if (options.output == "-")
    throw vestige::UsageError("-o -", "a plot is two files, and standard output is one", "name OUT");
  if (sweep.parsed()) return draw_sweep(options);
  if (accuracy.parsed()) return draw_accuracy(options);
  if (growth.parsed()) return draw_growth(options);
  if (stress.parsed()) return draw_stress(options);
  if (body.parsed()) return draw_body(options);
  if (scene.parsed()) return draw_scene(options);
  if (avatar.parsed()) return draw_avatar(options);
  if (timeline.parsed()) return draw_timeline(options);
  return draw_textures(options);
}

}  // namespace

int main(int argc, char** argv) {
  // A closed pipe is an error of write(), not a silent death that leaves temporary files behind.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const vestige::UsageError& error) {
    vestige::print_message(fmt::format("vestige: error: {}\n", error.what()));
    return kWrongUsage;
  } catch (const std::bad_alloc&) {
    vestige::print_message("vestige: error: out of memory\n");
    return kFailed;
  } catch (const std::exception& error) {
    vestige::print_message(fmt::format("vestige: error: {}\n", error.what()));
    return kFailed;
  }
}
