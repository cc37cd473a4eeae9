#include "cli/choices/live_choice.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "cli/choices/snapshots.hpp"
#include "traces/base/error.hpp"
#include "traces/base/host_port.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kScheme = "vmc";

LiveRequest asked() {
  if (interrupted()) return LiveRequest::kStop;
  return snapshot_wanted() ? LiveRequest::kSnapshot : LiveRequest::kGoOn;
}

void warn_of(const std::vector<std::string>& problems, std::string_view source, Verbosity verbosity) {
  for (const std::string& problem : problems) warn(fmt::format("{}: {}", source, problem), verbosity);
}

/// What the source sent and the avatar has not, and the other way round.
void report_bones(const VmcState& state, const Humanoid& humanoid, const std::string& source, Verbosity verbosity) {
  if (verbosity == Verbosity::kVerbose)
    print_message(fmt::format("{}: {} of the avatar's {} bones were moved: {}\n", source, state.bones().size(),
                              humanoid.node_of.size(), fmt::join(state.bones(), ", ")));
  if (!state.unknown_bones().empty() && verbosity == Verbosity::kVerbose)
    print_message(fmt::format("{}: bones that the avatar lacks: {}\n", source, fmt::join(state.unknown_bones(), ", ")));
  if (state.bones().empty())
    warn(fmt::format("{}: nothing moved the avatar; it stands in its rest pose", source), verbosity);
}

}  // namespace

void add_live_options(CLI::App& verb, LiveChoice& choice) {
  verb.add_option("--live", choice.source,
                  "Record live input until its end or Ctrl-C: lines of JSON on standard input (-), or the VMC protocol "
                  "and colliders by OSC on a UDP port (vmc://0.0.0.0:39539)")
      ->type_name("-|URL");
}

void check_live_choice(const CLI::App& verb, const LiveChoice& choice) {
  if (!choice.is_live()) return;
  if (!choice.is_lines()) parse_host_port(choice.source, kScheme, "--live");
  for (const char* flag : {"--animation", "--ignore-morphs", "--colliders", "--count", "--radius", "--at"})
    if (verb.count(flag) != 0)
      throw UsageError(flag, "the motion and the colliders come from the live source",
                       fmt::format("leave out {} or --live", flag));
  if (choice.is_lines() && verb.count("--rate") != 0)
    throw UsageError("--rate", "each line on standard input is a frame", "leave --rate out");
  if (choice.is_lines() && verb.count("--origin") != 0)
    throw UsageError("--origin", "each line says where avatar and colliders stand", "leave --origin out");
}

LiveCounts record_live(const LiveChoice& choice, const Scene& scene, Recorder& recorder, LiveSettings settings,
                       const glm::dvec3& origin_m, Verbosity verbosity) {
  settings.asked = asked;
  LiveCounts counts;
  if (choice.is_lines()) {
    LiveNdjson lines(scene.avatar);
    RecordingThread thread(recorder);
    counts = record_lines(STDIN_FILENO, lines, thread, settings);
    thread.stop();
    warn_of(lines.problems(), "standard input", verbosity);
  } else {
    VmcState state(scene.avatar, origin_m);
    UdpReceiver datagrams(parse_host_port(choice.source, kScheme, "--live"), choice.source);
    RecordingThread thread(recorder);
    if (verbosity != Verbosity::kQuiet)
      print_message(
          fmt::format("vestige: listening on {}; the recording begins with the first datagram, and Ctrl-C ends it\n",
                      choice.source));
    counts = record_state(datagrams, state, thread, settings);
    thread.stop();
    warn_of(state.problems(), choice.source, verbosity);
    report_bones(state, scene.avatar.humanoid, choice.source, verbosity);
  }
  const std::string source = choice.is_lines() ? "standard input" : choice.source;
  if (counts.frames == 0)
    throw Error(source, "no frame arrived, so there is no trace",
                choice.is_lines()
                    ? "give a line of JSON for each frame: see traces/FORMAT.md"
                    : "make the sender send to this machine and port, and check that no firewall blocks it");
  if (counts.malformed > 0 && choice.is_lines())
    warn(fmt::format("{}: left out {} that could not be read", source, counted(counts.malformed, "line")), verbosity);
  if (counts.lost_something() && !choice.is_lines())
    warn(fmt::format("{}: lost {} that came too late, {} that could not be read, and {} that the system discarded",
                     source, counted(counts.late, "frame"), counted(counts.malformed, "datagram"),
                     counted(counts.overflowed, "datagram")),
         verbosity);
  return counts;
}

}  // namespace vestige::cli
