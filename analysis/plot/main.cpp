#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/avatar_figure.hpp"
#include "analysis/plot/body_figure.hpp"
#include "analysis/plot/figure_export.hpp"
#include "analysis/plot/headless_window.hpp"
#include "analysis/plot/scene_figure.hpp"
#include "analysis/plot/sweep_figure.hpp"
#include "analysis/plot/texture_figure.hpp"
#include "analysis/plot/timeline_figure.hpp"
#include "cli/help/command_table.hpp"
#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
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
  std::string animation;
  std::size_t poses = 6;
  plot::MomentChoice moments;
  double trail_ms = 100;
  bool force = false;
  bool quiet = false;
};

void write_file(const Options& options, const std::filesystem::path& path, std::string_view bytes) {
  vestige::OutputFile file(path, options.force ? Overwrite::kAllow : Overwrite::kRefuse);
  file.write(bytes);
  file.commit();
  if (!options.quiet) fmt::print(stderr, "wrote {}\n", path.string());
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
    fmt::print(stderr,
               "vestige: warning: {}: left out: {}\n  install libegl1 and libgl1-mesa-dri, or convert the SVG: "
               "rsvg-convert -d 300 -p 300\n",
               png.string(), error.what());
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

int draw_sweep(const Options& options) {
  std::filesystem::path folder = options.output;
  if (folder.empty()) {
    const auto& first = options.inputs.front();
    folder = std::filesystem::is_directory(first) ? first : first.parent_path();
  }
  return write_figure(options, folder / "frequency",
                      [&] { return plot::sweep_figure(plot::read_sweeps(options.inputs)); });
}

int draw_timeline(const Options& options) {
  return write_figure(options, stem_of(options),
                      [&] { return plot::timeline_figure(plot::read_timeline(options.inputs.front())); });
}

int draw_textures(const Options& options) {
  return write_figure(options, stem_of(options),
                      [&] { return plot::texture_figure(plot::read_texture_contacts(options.inputs.front())); });
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
    sheet.animations = plot::ContactSheet::choose(sheet.subject.avatar, options.animation);
    sheet.poses = options.poses;
    if (sheet.animations.size() > kMostAnimations) {
      fmt::print(
          stderr,
          "vestige: warning: {}: has {} animations, of which the first {} are drawn; name others with --animation\n",
          input, sheet.animations.size(), kMostAnimations);
      sheet.animations.resize(kMostAnimations);
    }
    return plot::avatar_figure(sheet);
  });
}

plot::Subject subject_of(const Options& options) {
  if (options.inputs.empty()) return plot::read_subject(options.avatar, options.map);
  const vestige::TraceReader trace(options.inputs.front());
  return plot::read_subject(trace, options.inputs.front(), options.map);
}

int draw_body(Options options) {
  if (options.inputs.empty() == options.avatar.empty())
    throw vestige::UsageError("plot body", "needs either a trace or --avatar", "name one of them");
  const std::string input = options.inputs.empty() ? options.avatar : options.inputs.front().string();
  if (options.output.empty()) options.output = std::filesystem::path(input).replace_extension().string() + "-body";
  return write_figure(options, stem_of(options), [&] {
    plot::Body body;
    body.subject = subject_of(options);
    body.has_contacts = !options.contacts.empty();
    const std::size_t actuators = body.subject.map.actuator_count;
    if (actuators == 0 && !body.has_contacts)
      throw vestige::Error(input, "there is no actuator map, and no contact", "name a --map, or --contacts, or both");
    vestige::ContactLimits limits;
    limits.triangles = body.subject.avatar.triangles.size();
    if (actuators > 0) limits.actuators = actuators;
    if (body.has_contacts) body.contacts = vestige::read_contacts_csv(options.contacts, limits);
    return plot::body_figure(std::move(body));
  });
}

/// What is wrong with a trace, to standard error; its part of the exit code.
int report_damage(const vestige::TraceReader& trace, const std::filesystem::path& path) {
  if (trace.complete()) return kDone;
  for (const std::string& warning : trace.warnings()) fmt::print(stderr, "vestige: warning: {}\n", warning);
  if (trace.warnings().empty()) fmt::print(stderr, "vestige: warning: {}: is not complete\n", path.string());
  return kIncomplete;
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
    scene.trail_s = options.moments.trail_s;
    scene.has_contacts = !options.contacts.empty();
    std::vector<vestige::RecordedContact> contacts;
    vestige::ContactLimits limits;
    limits.triangles = scene.subject.avatar.triangles.size();
    if (scene.has_contacts) contacts = vestige::read_contacts_csv(options.contacts, limits);
    scene.moments = plot::read_moments(trace, input.string(), options.moments, contacts);
    damage = report_damage(trace, input);
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

void add_common_options(CLI::App& command, Options& options, const char* output_name, const char* output_help) {
  command.add_option("-o", options.output, output_help)->type_name(output_name);
  command.add_flag("--force", options.force, "Overwrite existing files");
  command.add_flag("-q,--quiet", options.quiet, "Print errors only");
  command.set_help_flag("-h,--help", "Print this help");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Draw results, traces and avatars as figures, SVG and PNG (300 dots per inch)", "vestige plot");
  app.formatter(
      std::make_shared<help::HelpFormatter>("  vestige plot sweep results/sweep\n"
                                            "  vestige plot body man.mcap --contacts contacts.csv\n"));
  app.set_version_flag("--version", fmt::format("vestige-plot {} ({}{})", vestige::kVersion, vestige::kCommit,
                                                vestige::kDirty ? ", modified" : ""));
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

  CLI::App& timeline = add_command(app, "timeline", "Duty of every actuator over time",
                                   "  vestige plot timeline timeline.csv\n"
                                   "  vestige plot timeline timeline.csv -o figures/timeline --force\n");
  timeline.add_option("INPUT", options.inputs, "What 'vestige replay --timeline FILE.csv' wrote")
      ->type_name("CSV")
      ->expected(1)
      ->required();
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
          "The actuator map, a greyscale PNG whose FILE.json names the actuators if it exists [default: the trace's]")
      ->type_name("builtin|none|FILE.png");
  body.add_option("--contacts", options.contacts, "What 'vestige replay --contacts FILE.csv' wrote")->type_name("CSV");
  add_common_options(body, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -body]");

  CLI::App& scene = add_command(app, "scene", "A film strip of a trace: the avatar, the colliders and their paths",
                                "  vestige plot scene man.mcap\n"
                                "  vestige plot scene man.mcap --contacts contacts.csv --frames 4 --from 0.1 --to 0.2\n");
  scene.add_option("INPUT", options.inputs, "The trace")->type_name("MCAP")->expected(1)->required();
  scene.add_option("--frames", options.moments.count, "How many frames are drawn")
      ->capture_default_str()
      ->check(CLI::Range(1, 24));
  scene.add_option("--from", options.moments.from_s, "Leave out what is before [default: the trace's beginning]")
      ->type_name("SECONDS");
  scene.add_option("--to", options.moments.to_s, "Leave out what is after [default: the trace's end]")
      ->type_name("SECONDS");
  scene.add_option("--trail", options.trail_ms, "How far back paths and contacts are shown")
      ->capture_default_str()
      ->type_name("MS")
      ->check(CLI::Range(0.001, 1e6));
  scene
      .add_option("--contacts", options.contacts,
                  "What 'vestige replay --contacts FILE.csv' wrote; the frames drawn are then ones with contacts")
      ->type_name("CSV");
  scene.add_option("--map", options.map, "Actuator map instead of the trace's")->type_name("builtin|none|FILE.png");
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
  const std::string question = argc > 1 ? argv[1] : "";
  if (question == "complete") {
    fmt::print("{}", help::completions(help::command_table(app), {argv + 2, argv + argc}));
    return kDone;
  }
  if (question == "man") {
    fmt::print("{}", help::manual_page(help::command_table(app), help::VerbPages::kNone, vestige::kVersion,
                                       vestige::kCommitDate));
    return kDone;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_asked_for) {
    return app.exit(help_asked_for);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "vestige: error: {}\n  'vestige plot --help' lists what can be drawn.\n", error.what());
    return kWrongUsage;
  }
  try {
    if (sweep.parsed()) return draw_sweep(options);
    if (body.parsed()) return draw_body(options);
    if (scene.parsed()) return draw_scene(options);
    if (avatar.parsed()) return draw_avatar(options);
    if (timeline.parsed()) return draw_timeline(options);
    return draw_textures(options);
  } catch (const vestige::UsageError& error) {
    fmt::print(stderr, "vestige: error: {}\n", error.what());
    return kWrongUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vestige: error: {}\n", error.what());
    return kFailed;
  }
}
