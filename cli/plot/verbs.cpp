#include "cli/plot/verbs.hpp"

#include <fmt/format.h>

#include <string>

#include "cli/help/help_text.hpp"
#include "cli/help/validators.hpp"
#include "cli/plot/draw.hpp"
#include "detector/actuators/intensity.hpp"
#include "detector/method.hpp"

namespace vestige::plot {

namespace {

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

/// Adds INPUT, which must be given once.
void add_input(CLI::App& command, Options& options, const char* type, const std::string& what) {
  command.add_option("INPUT", options.inputs, what)->type_name(type)->expected(1)->required();
}

void add_naming_map(CLI::App& command, Options& options) {
  command.add_option("--map", options.map, "The actuator map that names the actuators [default: numbers alone]")
      ->type_name("builtin|LAYOUT|FILE.png");
}

void add_other_map(CLI::App& command, Options& options) {
  command.add_option("--map", options.map, "Actuator map instead of the trace's")
      ->type_name("builtin|none|LAYOUT|FILE.png");
}

void add_person(CLI::App& command, Options& options) {
  command.add_option("--person", options.person, "Of a trace of several people: whom to draw, from 1 on")
      ->type_name("K")
      ->check(help::whole_number(1, 100));
}

/// Adds --from and --to.
void add_span(CLI::App& command, Options& options) {
  command
      .add_option("--from", options.moments.from_s,
                  "Draw frames at this time and later, in seconds of the trace [default: its start]")
      ->type_name("SECONDS")
      ->check(help::kFinite);
  command
      .add_option("--to", options.moments.to_s,
                  "Draw frames before this time and at it, in seconds of the trace [default: its end]")
      ->type_name("SECONDS")
      ->check(help::kFinite);
}

/// Adds --law, its parameters and --hold.
void add_law(CLI::App& command, Options& options) {
  command
      .add_option("--law", options.law.law, "The intensity law, which says how strongly a contact drives the actuators")
      ->capture_default_str()
      ->type_name(fmt::format("{}", fmt::join(law_names(), "|")));
  for (std::size_t i = 0; i < law_parameters().size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    command.add_option(known.flag, options.law.parameters[i], known.help)
        ->check(help::kPositive)
        ->type_name(known.type_name);
  }
  command
      .add_option(
          "--hold", options.law.hold_ms,
          "How long a contact is felt, in ms: a coin motor cannot answer a single frame; 0 gives the raw frames")
      ->capture_default_str()
      ->type_name("MS")
      ->check(help::between(0, 10000));
}

/// Draws the folder that the verb of the same name wrote.
CLI::App& add_results(CLI::App& app, Options& options, const char* name, const char* what, const char* output_help) {
  CLI::App& command = add_command(app, name, what,
                                  fmt::format("  vestige plot {0} results/{0}\n"
                                              "  vestige plot {0} results/{0} -o figures\n",
                                              name));
  add_input(command, options, "DIR", fmt::format("The folder that 'vestige {} -o DIR' wrote", name));
  add_common_options(command, options, "DIR", output_help);
  return command;
}

CLI::App& add_sweep(CLI::App& app, Options& options) {
  CLI::App& sweep = add_command(app, "sweep",
                                "Detection frequency over the number of colliders (frequency.svg, .png), or cost over "
                                "that of people (people.svg, .png)",
                                "  vestige plot sweep results/sweep\n"
                                "  vestige plot sweep gpu/sweep.json software/sweep.json -o figures\n");
  sweep
      .add_option("INPUT", options.inputs,
                  "The sweep.json to draw, or the folder that holds it; several inputs go into one figure")
      ->type_name("DIR|JSON")
      ->required();
  add_common_options(sweep, options, "DIR", "Folder for the figures [default: beside the first input]");
  return sweep;
}

CLI::App& add_stages(CLI::App& app, Options& options) {
  CLI::App& stages = add_command(app, "stages", "Where the time of a frame goes, by detector (stages.svg, .png)",
                                 "  vestige plot stages results/sweep\n"
                                 "  vestige plot stages results/sweep --counts 1,10\n");
  add_input(stages, options, "DIR|JSON",
            "The sweep.json that 'vestige sweep --stages' wrote, or the folder that holds it");
  stages
      .add_option(
          "--counts", options.counts,
          "Numbers of colliders to draw, as 1,10,40,100 or 1:100 or 5:100:5 [default: up to three of the sweep's]")
      ->type_name("LIST");
  add_common_options(stages, options, "DIR", "Folder for the figure [default: beside the input]");
  return stages;
}

CLI::App& add_skipping(CLI::App& app, Options& options) {
  CLI::App& skipping = add_command(app, "skipping", "Pairs left after each kind of skipping (skipping.svg, .png)",
                                   "  vestige plot skipping results/sweep\n"
                                   "  vestige plot skipping gpu/sweep.json software/sweep.json -o figures\n");
  skipping
      .add_option("INPUT", options.inputs,
                  "The sweep.json of a sweep that measured cpu with skipping, or the folder that holds it; several go "
                  "into one figure")
      ->type_name("DIR|JSON")
      ->required();
  add_common_options(skipping, options, "DIR", "Folder for the figure [default: beside the first input]");
  return skipping;
}

CLI::App& add_latency(CLI::App& app, Options& options) {
  CLI::App& latency =
      add_command(app, "latency", "How long a live session took, from the arrival of input to the motor",
                  "  vestige plot latency live.json\n"
                  "  vestige plot latency live.json -o figures/latency\n");
  add_input(latency, options, "JSON", "The file that 'vestige live --json FILE' wrote");
  add_common_options(latency, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name]");
  return latency;
}

CLI::App& add_timeline(CLI::App& app, Options& options) {
  CLI::App& timeline = add_command(app, "timeline", "Duty of every actuator over time",
                                   "  vestige plot timeline timeline.csv\n"
                                   "  vestige plot timeline timeline.csv --map builtin -o figures/timeline\n");
  add_input(timeline, options, "CSV", "The file that 'vestige replay --timeline FILE.csv' wrote");
  add_naming_map(timeline, options);
  timeline
      .add_option("--measured", options.measured,
                  "The duties that were measured at a board's pins meanwhile, as CSV like a timeline")
      ->type_name("CSV");
  timeline.add_option("--actuators", options.actuators, "Draw only these actuators, such as 3,11:13 [default: all]")
      ->excludes("--measured")
      ->type_name("LIST");
  add_common_options(timeline, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name]");
  return timeline;
}

CLI::App& add_textures(CLI::App& app, Options& options) {
  CLI::App& textures =
      add_command(app, "textures", "Collision textures: which actuator each collider touched, and when",
                  "  vestige plot textures textures.exr\n"
                  "  vestige plot textures textures.exr --map builtin -o figures/textures\n");
  add_input(textures, options, "EXR", "The file that 'vestige replay --textures FILE.exr' wrote");
  add_naming_map(textures, options);
  add_person(textures, options);
  add_common_options(textures, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name]");
  return textures;
}

CLI::App& add_body(CLI::App& app, Options& options) {
  CLI::App& body =
      add_command(app, "body", "An avatar with the regions of its actuator map, contacts and their density",
                  "  vestige plot body man.mcap --contacts contacts.csv\n"
                  "  vestige plot body --avatar man.glb --map regions.png -o figures/regions\n");
  body.add_option("INPUT", options.inputs, "A trace, whose avatar and map are drawn")->type_name("MCAP")->expected(1);
  CLI::Option* avatar =
      body.add_option("--avatar", options.avatar, "Instead of a trace: the built-in avatar, or a glTF file")
          ->type_name("builtin|FILE");
  cli::add_facing_option(body, options.facing)->needs(avatar);
  body.add_option(
          "--map", options.map,
          "The actuator map: a greyscale PNG (FILE.json names the actuators, if it exists), or a layout ('vestige map "
          "make --help' lists the layouts) [default: the trace's]")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  add_person(body, options);
  body.add_option("--contacts", options.contacts,
                  "The contacts (.csv, .h5) that 'vestige replay --contacts FILE' wrote")
      ->type_name("FILE");
  add_common_options(body, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -body]");
  return body;
}

CLI::App& add_scene(CLI::App& app, Options& options) {
  CLI::App& scene =
      add_command(app, "scene", "A film strip of a trace: the avatar, the colliders and their paths",
                  "  vestige plot scene man.mcap\n"
                  "  vestige plot scene man.mcap --contacts contacts.csv --frames 4 --from 0.1 --to 0.2\n");
  add_input(scene, options, "MCAP", "The trace");
  scene.add_option("--frames", options.moments.count, "How many frames are drawn")
      ->capture_default_str()
      ->check(CLI::Range(1, 24));
  add_span(scene, options);
  scene.add_option("--trail", options.trail_ms, "How far back paths and contacts are shown")
      ->capture_default_str()
      ->type_name("MS")
      ->check(help::between(0.001, 10000));
  scene
      .add_option("--contacts", options.contacts,
                  "The contacts (.csv, .h5) that 'vestige replay --contacts FILE' wrote; then only frames with "
                  "contacts are drawn")
      ->type_name("FILE");
  scene
      .add_option("--colour-by", options.colour_by,
                  "kind: paths and contacts have a colour each; collider: each collider has its own")
      ->capture_default_str()
      ->check(CLI::IsMember({"kind", "collider"}));
  add_other_map(scene, options);
  add_common_options(scene, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -scene]");
  return scene;
}

CLI::App& add_film(CLI::App& app, Options& options) {
  CLI::App& film = add_command(app, "film", "A trace as an animated picture (WebP) for pages and slides",
                               "  vestige plot film man.mcap --to 0.5\n"
                               "  vestige plot film man.mcap --from 0.1 --to 0.2 --speed 1/10 -o slow.webp\n");
  add_input(film, options, "MCAP", "The trace");
  add_span(film, options);
  film.add_option(
          "--speed", options.speed,
          "Seconds of the trace in a second of the film, a number or a fraction from 0.001 to 1000: 1/10 is ten "
          "times slower than life")
      ->capture_default_str()
      ->type_name("X");
  film.add_option("--fps", options.film_rate_hz,
                  "Show at most this many pictures in a second; each is a frame of the trace")
      ->capture_default_str()
      ->type_name("HZ")
      ->check(help::between(1, 60));
  film.add_option("--width", options.film_width, "Width in pixels; the height follows from what there is to see")
      ->capture_default_str()
      ->type_name("PIXELS")
      ->check(help::whole_number(320, 1920));
  film.add_option("--view", options.view,
                  "The side of the first person's rest pose that is seen; auto: half-left, or of several people the "
                  "right")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "front", "back", "left", "right"}));
  film.add_option("--trail", options.film_trail_ms,
                  "How far back paths and contacts are shown; contacts for two pictures at least")
      ->capture_default_str()
      ->type_name("MS")
      ->check(help::between(0.001, 10000));
  add_other_map(film, options);
  film.add_option("--method", options.method,
                  "How contacts are found: static, carried or ccd, as in 'vestige replay --help'")
      ->capture_default_str()
      ->check(CLI::IsMember(kMethodNames));
  add_law(film, options);
  film.add_option("--actuator", options.law.actuator,
                  "A description of the motors in JSON: the duty for each amplitude, and a kick that starts them")
      ->type_name("FILE.json");
  add_common_options(film, options, "FILE.webp", "The film [default: the input's name and -film.webp]");
  return film;
}

CLI::App& add_avatar(CLI::App& app, Options& options) {
  CLI::App& avatar = add_command(app, "avatar", "An avatar from four sides, in poses over its animations",
                                 "  vestige plot avatar builtin\n"
                                 "  vestige plot avatar man.glb --animation walk -o figures/walk\n");
  add_input(avatar, options, "builtin|FILE", "The built-in avatar, or a glTF file (.glb, .gltf, .vrm)");
  cli::add_facing_option(avatar, options.facing);
  avatar
      .add_option("--animation", options.animation,
                  "One animation: a name, an index, or none for the rest pose [default: all]")
      ->type_name("NAME|INDEX|none");
  avatar.add_option("--poses", options.poses, "Poses of each animation")
      ->capture_default_str()
      ->check(CLI::Range(1, 12));
  add_common_options(avatar, options, "OUT", "Write OUT.svg and OUT.png [default: the input's name and -avatar]");
  return avatar;
}

CLI::App& add_report(CLI::App& app, Options& options) {
  CLI::App& report = add_command(app, "report", "A page that compares the maps and laws of a batch (report.html)",
                                 "  vestige plot report compared\n"
                                 "  vestige plot report compared --top 3 -o page\n");
  add_input(report, options, "DIR", "The folder that 'vestige batch -o DIR' wrote");
  report.add_option("--top", options.top, "How many of the best maps get pictures")
      ->capture_default_str()
      ->type_name("N")
      ->check(help::whole_number(1, 1000));
  add_common_options(report, options, "DIR", "Folder for report.html and figures/ [default: the input]");
  return report;
}

CLI::App& add_paraview(CLI::App& app, Options& options) {
  CLI::App& paraview = add_command(app, "paraview", "A trace as a time series for ParaView (.pvd and .vtp)",
                                   "  vestige plot paraview man.mcap\n"
                                   "  vestige plot paraview man.mcap --every 1 -o paraview/man.pvd\n");
  add_input(paraview, options, "MCAP", "The trace");
  add_other_map(paraview, options);
  add_person(paraview, options);
  add_law(paraview, options);
  CLI::Option* every =
      paraview.add_option("--every", options.every, "Write one time step for every N frames, instead of --rate")
          ->type_name("N")
          ->check(help::whole_number(1, 1000000000));
  paraview
      .add_option("--rate", options.rate_hz,
                  "Write at most HZ time steps per second; each step has the contacts since the step before, and the "
                  "highest amplitudes")
      ->capture_default_str()
      ->type_name("HZ")
      ->check(help::between(0.001, 1e6))
      ->excludes(every);
  add_common_options(
      paraview, options, "DIR|FILE.pvd",
      "Write DIR/NAME.pvd and the folder DIR/NAME, or FILE.pvd and the folder FILE [default: beside the trace]");
  return paraview;
}

}  // namespace

std::vector<Verb> add_verbs(CLI::App& app, Options& options) {
  return {{&add_sweep(app, options), draw_sweep},
          {&add_stages(app, options), draw_stages},
          {&add_skipping(app, options), draw_skipping},
          {&add_latency(app, options), draw_latency},
          {&add_results(app, options, "accuracy", "Contacts missed over run time (accuracy.svg, .png)",
                        "Folder for the figure [default: the input]"),
           draw_accuracy},
          {&add_results(app, options, "growth", "Cost over colliders and over triangles (growth.svg, .png)",
                        "Folder for the figure [default: the input]"),
           draw_growth},
          {&add_results(app, options, "stress", "Errors of each detector, by family of hostile cases",
                        "Folder for the figures [default: the input]"),
           draw_stress},
          {&add_timeline(app, options), draw_timeline},
          {&add_textures(app, options), draw_textures},
          {&add_body(app, options), draw_body},
          {&add_scene(app, options), draw_scene},
          {&add_film(app, options), draw_film},
          {&add_avatar(app, options), draw_avatar},
          {&add_report(app, options), draw_report},
          {&add_paraview(app, options), draw_paraview}};
}

}  // namespace vestige::plot
