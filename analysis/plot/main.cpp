#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/figure_export.hpp"
#include "analysis/plot/headless_window.hpp"
#include "analysis/plot/sweep_figure.hpp"
#include "analysis/plot/texture_figure.hpp"
#include "analysis/plot/timeline_figure.hpp"
#include "cli/help/command_table.hpp"
#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "traces/error.hpp"
#include "traces/output_file.hpp"
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
  CLI::App app("Draw figures of results, as SVG and as PNG (300 dots per inch)", "vestige plot");
  app.formatter(
      std::make_shared<help::HelpFormatter>("  vestige plot sweep results/sweep\n"
                                            "  vestige plot timeline timeline.csv -o figures/timeline\n"));
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
