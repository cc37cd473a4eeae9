#include "cli/measure/default_trace.hpp"

#include <memory>

#include "analysis/base/provenance.hpp"
#include "cli/choices/scene.hpp"
#include "cli/terminal.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige::cli {

void record_default_trace(const std::string& path, const DefaultTrace& trace, const CommonOptions& options,
                          const Invocation& invocation) {
  const Scene scene = load_scene("builtin", "builtin", {}, Verbosity::kQuiet);
  const Animation* animation = find_animation(scene.avatar, "");
  const auto swarm = find_scenario("swarm")->make(scene.avatar, animation, {trace.colliders, options.seed});
  TraceWriterOptions writing;
  writing.overwrite = options.overwrite();
  TraceWriter writer(path, {{"argv", provenance_texts(invocation.argv).at("argv")}}, {scene.person()}, writing);
  const auto write = [&](const TraceFrame& frame) {
    writer.write(frame);
    return true;
  };
  RecordingSettings settings;
  settings.duration_s = trace.duration_s;
  record(write, {{scene.avatar, animation}}, *swarm, settings, [](double) { return !interrupted(); });
  writer.finish();
}

}  // namespace vestige::cli
