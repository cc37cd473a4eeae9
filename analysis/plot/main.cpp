#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/avatar_figure.hpp"
#include "analysis/plot/figure_export.hpp"
#include "analysis/plot/headless_window.hpp"
#include "analysis/plot/sweep_figure.hpp"
#include "analysis/plot/texture_figure.hpp"
#include "analysis/plot/timeline_figure.hpp"
#include "traces/avatar_gltf.hpp"
#include "traces/builtin_avatar.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
#include "version.hpp"

namespace {

using vestige::Overwrite;
using vestige::plot::Figure;
namespace plot = vestige::plot;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kIncomplete = 3;

struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string animation;
  std::size_t poses = 6;
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
    fmt::print(
        stderr,
        "{}: left out: {}\n  install libegl1 and libgl1-mesa-dri, or convert the SVG: rsvg-convert -d 300 -p 300\n",
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

int draw_avatar(const Options& options) {
  return write_figure(options, stem_of(options), [&] {
    const std::string input = options.inputs.front();
    plot::ContactSheet sheet;
    sheet.title = input == "builtin" ? "built-in avatar" : std::filesystem::path(input).filename().string();
    const auto glb = input == "builtin" ? vestige::builtin_avatar_glb() : vestige::read_avatar_glb(input);
    sheet.avatar = vestige::parse_avatar_glb(glb, input);
    sheet.animations = plot::ContactSheet::choose(sheet.avatar, options.animation);
    sheet.poses = options.poses;
    if (sheet.animations.size() > kMostAnimations) {
      fmt::print(stderr, "{}: has {} animations, of which the first {} are drawn; name others with --animation\n",
                 input, sheet.animations.size(), kMostAnimations);
      sheet.animations.resize(kMostAnimations);
    }
    return plot::avatar_figure(std::move(sheet));
  });
}

/// Help that opens with examples, which the list of subcommands leaves out.
class ExamplesFirst : public CLI::Formatter {
 public:
  explicit ExamplesFirst(std::string_view examples) : examples_(examples) {}
  std::string make_description(const CLI::App* app) const override {
    return fmt::format("Examples:\n{}\n{}", examples_, Formatter::make_description(app));
  }

 private:
  std::string_view examples_;
};

CLI::App& add_command(CLI::App& app, const char* name, const char* what, std::string_view examples) {
  CLI::App& command = *app.add_subcommand(name, what);
  command.formatter(std::make_shared<ExamplesFirst>(examples));
  return command;
}

void add_common_options(CLI::App& command, Options& options, const char* output_name, const char* output_help) {
  command.add_option("-o", options.output, output_help)->type_name(output_name);
  command.add_flag("--force", options.force, "overwrite figures that exist");
  command.add_flag("-q,--quiet", options.quiet, "say nothing but errors");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Draws result files as figures, SVG and PNG (300 dots per inch).", "vestige plot");
  app.formatter(
      std::make_shared<ExamplesFirst>("  vestige plot sweep results/sweep\n"
                                      "  vestige plot timeline timeline.csv -o figures/timeline\n"));
  app.set_version_flag("--version", fmt::format("vestige-plot {} ({}{})", vestige::kVersion, vestige::kCommit,
                                                vestige::kDirty ? ", changed" : ""));
  app.require_subcommand(1);

  CLI::App& sweep = add_command(app, "sweep", "detection frequency over the number of colliders (frequency.svg, .png)",
                                "  vestige plot sweep results/sweep\n"
                                "  vestige plot sweep gpu/sweep.json software/sweep.json -o figures\n");
  sweep.add_option("inputs", options.inputs, "sweep.json, or the folder that holds it; several go into one figure")
      ->type_name("DIR|JSON")
      ->required();
  add_common_options(sweep, options, "DIR", "folder for the figures (default: beside the first input)");

  CLI::App& timeline = add_command(app, "timeline", "duty of every actuator over time",
                                   "  vestige plot timeline timeline.csv\n"
                                   "  vestige plot timeline timeline.csv -o figures/timeline --force\n");
  timeline.add_option("input", options.inputs, "written by 'vestige replay --timeline FILE.csv'")
      ->type_name("CSV")
      ->expected(1)
      ->required();
  add_common_options(timeline, options, "OUT", "OUT.svg and OUT.png (default: the input's name)");

  CLI::App& textures =
      add_command(app, "textures", "collision textures: which actuator each collider touched, and when",
                  "  vestige plot textures textures.exr\n"
                  "  vestige plot textures textures.exr -o figures/textures\n");
  textures.add_option("input", options.inputs, "written by 'vestige replay --textures FILE.exr'")
      ->type_name("EXR")
      ->expected(1)
      ->required();
  add_common_options(textures, options, "OUT", "OUT.svg and OUT.png (default: the input's name)");

  CLI::App& avatar = add_command(app, "avatar", "an avatar from four sides, in poses over its animations",
                                 "  vestige plot avatar builtin\n"
                                 "  vestige plot avatar man.glb --animation walk -o figures/walk\n");
  avatar.add_option("input", options.inputs, "the built-in avatar, or a glTF file (.glb, .gltf, .vrm)")
      ->type_name("builtin|FILE")
      ->expected(1)
      ->required();
  avatar
      .add_option("--animation", options.animation,
                  "one animation: a name, an index, or none for the rest pose [default: all]")
      ->type_name("NAME|INDEX|none");
  avatar.add_option("--poses", options.poses, "poses of each animation")
      ->capture_default_str()
      ->check(CLI::Range(1, 12));
  add_common_options(avatar, options, "OUT", "OUT.svg and OUT.png (default: the input's name)");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  try {
    if (sweep.parsed()) return draw_sweep(options);
    if (avatar.parsed()) return draw_avatar(options);
    if (timeline.parsed()) return draw_timeline(options);
    return draw_textures(options);
  } catch (const vestige::UsageError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kWrongUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kFailed;
  }
}
