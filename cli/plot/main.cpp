#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "cli/help/command_table.hpp"
#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "cli/plot/draw.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "traces/files/output_file.hpp"
#include "version.hpp"

namespace {

using vestige::plot::Options;
namespace help = vestige::help;
namespace plot = vestige::plot;

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
  app.option_defaults()->disable_flag_override();
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
                  "  vestige plot textures textures.exr --map builtin -o figures/textures\n");
  textures.add_option("INPUT", options.inputs, "What 'vestige replay --textures FILE.exr' wrote")
      ->type_name("EXR")
      ->expected(1)
      ->required();
  textures.add_option("--map", options.map, "The actuator map that names the actuators [default: numbers alone]")
      ->type_name("builtin|LAYOUT|FILE.png");
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

  CLI::App& report = add_command(app, "report", "A page that compares the maps and laws of a batch (report.html)",
                                 "  vestige plot report compared\n"
                                 "  vestige plot report compared --top 3 -o page\n");
  report.add_option("INPUT", options.inputs, "The folder that 'vestige batch -o DIR' wrote")
      ->type_name("DIR")
      ->expected(1)
      ->required();
  report.add_option("--top", options.top, "How many maps get pictures, from the best on")
      ->capture_default_str()
      ->type_name("N")
      ->check(help::whole_number(1, 1000));
  add_common_options(report, options, "DIR", "Folder for report.html and figures/ [default: the input]");

  CLI::App& paraview = add_command(app, "paraview", "A trace as a time series for ParaView (.pvd and .vtp)",
                                   "  vestige plot paraview man.mcap\n"
                                   "  vestige plot paraview man.mcap --every 1 -o paraview/man.pvd\n");
  paraview.add_option("INPUT", options.inputs, "The trace")->type_name("MCAP")->expected(1)->required();
  paraview.add_option("--map", options.map, "Actuator map instead of the trace's")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  paraview.add_option("--law", options.law, "How strong a contact makes the actuators")
      ->capture_default_str()
      ->type_name("binary|speed|phantom|gaussian");
  paraview.add_option("--hold", options.hold_ms, "How long a contact is felt")
      ->capture_default_str()
      ->type_name("MS")
      ->check(help::between(0, 10000));
  CLI::Option* every =
      paraview.add_option("--every", options.every, "One time step for so many frames, instead of --rate")
          ->type_name("N")
          ->check(help::whole_number(1, 1000000000));
  paraview
      .add_option("--rate", options.rate_hz,
                  "At most so many time steps a second; each has the contacts since the one before, and the highest "
                  "amplitudes")
      ->capture_default_str()
      ->type_name("HZ")
      ->check(help::between(0.001, 1e6))
      ->excludes(every);
  add_common_options(paraview, options, "DIR|FILE.pvd",
                     "Write DIR/NAME.pvd and the folder DIR/NAME, or FILE.pvd and FILE [default: beside the trace]");

  app.set_help_flag("-h,--help", "Print this help");
  // What `vestige` asks of its helper, to answer for `vestige plot`.
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "complete" || word == "man") {
    const help::CommandTable table = help::command_table(app);
    fmt::print("{}", word == "complete"
                         ? help::completions(table, {argv + 2, argv + argc})
                         : help::manual_page(table, help::VerbPages::kNone, vestige::kVersion, vestige::kCommitDate));
    if (std::fflush(stdout) != 0) throw vestige::system_error("standard output", "could not write", errno);
    return vestige::cli::kDone;
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
    vestige::print_message(
        fmt::format("vestige: error: {}\n  {}\n", help::cause_of(app, error), help::help_remedy(app)));
    return vestige::cli::kWrongUsage;
  }
  if (options.output == "-")
    throw vestige::UsageError("-o -", "a plot is two files, and standard output is one", "name OUT");
  if (sweep.parsed()) return plot::draw_sweep(options);
  if (accuracy.parsed()) return plot::draw_accuracy(options);
  if (growth.parsed()) return plot::draw_growth(options);
  if (stress.parsed()) return plot::draw_stress(options);
  if (body.parsed()) return plot::draw_body(options);
  if (scene.parsed()) return plot::draw_scene(options);
  if (avatar.parsed()) return plot::draw_avatar(options);
  if (report.parsed()) return plot::draw_report(options);
  if (paraview.parsed()) return plot::draw_paraview(options);
  if (timeline.parsed()) return plot::draw_timeline(options);
  return plot::draw_textures(options);
}

}  // namespace

int main(int argc, char** argv) {
  return vestige::cli::run_program(run, argc, argv);
}
