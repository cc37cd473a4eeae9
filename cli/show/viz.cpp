#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/viz/viewer_layout.hpp"
#include "analysis/viz/viz_trace.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/choices/scene.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/rewriting.hpp"
#include "cli/help/validators.hpp"
#include "cli/show/trace_run.hpp"
#include "cli/verbs.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "traces/viz/viz_format.hpp"

namespace vestige::cli {

namespace {

struct VizOptions {
  CommonOptions common;
  DetectorChoice choice;
  LawFlags law;
  std::string trace;
  std::string output;
  std::string layout;
  double mesh_rate_hz = 15;
};

/// Reads the whole trace into `copy`.
void add_all(OpenTrace& trace, SeenRun& run, VizTrace& copy, const VizOptions& options) {
  const auto total = static_cast<double>(trace.reader.frame_count());
  double done = 0;
  Progress progress("Looking for contacts", options.common.verbosity());
  TraceFrame frame;
  while (trace.reader.next(frame)) {
    run.step(frame);
    copy.write(frame, run.seen());
    if (!progress.update(++done / total))
      throw Error(options.output, is_pipe(options.output) ? "stopped by Ctrl-C" : kStopped, kStartAgain);
  }
  copy.finish();
}

void run_viz(const VizOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::vector<std::string> outputs = {options.output, options.layout, options.common.json};
  if (options.trace == "-")
    throw UsageError("TRACE", "it is read twice, but standard input can be read once", "name a file");
  options.law.check();
  check_outputs(outputs, {options.trace, options.law.actuator}, options.common);
  check_trace_name(options.output);
  if (options.output == "-") refuse_terminal("-o -");
  OpenTrace trace(options.trace, verbosity, People::kSeveral);
  require_surfaces(trace, options.trace);
  require_frames(trace.reader, options.trace);
  const std::vector<MappedPerson> people = mapped(trace.people);
  SeenRun run =
      make_run(trace.people, options.choice, options.law, kHashedPlanes | Plane::kPosition, trace, options.trace);
  warn_of_radii({run.detector()}, trace.reader, options.trace, verbosity);
  const mcap::FileSource source(options.trace);

  catch_interrupts();
  std::optional<OutputFile> layout;
  if (!options.layout.empty()) layout.emplace(options.layout, options.common.overwrite());
  OutputFile written(options.output, options.common.overwrite());
  VizTrace copy({source, people, trace.reader.collider_ids(), options.mesh_rate_hz},
                [&](mcap::Bytes bytes) { written.write(bytes); });
  add_all(trace, run, copy, options);
  if (layout) layout->write(viewer_layout(people));
  if (layout) layout->commit();
  written.commit();

  const mcap::DamageList damages = copy.damages();
  print_summary(
      fmt::format("{}: {} and {}, {} bytes ({} before)\n", options.output, counted(trace.reader.frame_count(), "frame"),
                  counted(copy.contacts(), "contact"), copy.bytes_written(), source.size()),
      outputs, options.common);
  nlohmann::ordered_json report = {
      {"trace", options.trace},        {"output", options.output},
      {"detector", run.detector()},    {"frames", trace.reader.frame_count()},
      {"contacts", copy.contacts()},   {"bytes_before", source.size()},
      {"bytes", copy.bytes_written()}, {"complete", trace.reader.complete() && damages.empty()}};
  add_choices(report, options.choice, run);
  write_json(options.common.json, with_provenance(invocation.argv, report), options.common);
  invocation.exit_code = report_damage(trace.reader, options.trace, verbosity);
  warn_of_damage(options.trace, damages, verbosity, damage_of(trace.reader, options.trace));
  if (!damages.empty()) invocation.exit_code = kDataLost;
  for (const std::string& note : notes_of(run, trace)) {
    warn(fmt::format("{}: {}", options.trace, note), verbosity);
    invocation.exit_code = kDataLost;
  }
}

}  // namespace

void add_viz(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<VizOptions>();
  CLI::App* verb = add_verb(program, "viz", "Add to a trace what Foxglove and Lichtblick draw",
                            "  vestige viz man.mcap -o seen.mcap --layout layout.json\n"
                            "  vestige viz man.mcap --law speed --mesh-rate 0 -o seen.mcap\n");
  verb->add_option("TRACE", options->trace, "The trace")->required();
  verb->add_option("-o,--output", options->output,
                   "The trace to write, which has all of TRACE, and contacts, duties and skin on topics /viz")
      ->required()
      ->type_name("OUT.mcap|-");
  verb->add_option("--layout", options->layout,
                   "Write the layout that Foxglove and Lichtblick import for OUT.mcap: body, duties and contacts")
      ->type_name("LAYOUT.json|-");
  verb->add_option("--mesh-rate", options->mesh_rate_hz,
                   "How often a second the posed skin is added, which takes most of the space; 0: never")
      ->check(help::between(0, viz_format::kRate_hz))
      ->capture_default_str()
      ->type_name("HZ");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  add_law_options(*verb, options->law, "Intensity");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_viz(*options, invocation); });
}

}  // namespace vestige::cli
