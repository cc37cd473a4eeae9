#include "cli/choices/live_choice.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <deque>
#include <set>

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

void add_live_options(CLI::App& verb) {
  verb.add_option("--live",
                  "Record live input until its end or Ctrl-C: lines of JSON on standard input (-), or the VMC protocol "
                  "and colliders by OSC on a UDP port (vmc://0.0.0.0:39539); of several people, a port for each")
      ->type_name("-|URL");
}

void check_live_choice(const CLI::App& verb, const LiveChoice& choice) {
  if (!choice.is_live()) return;
  std::set<std::string> taken;
  for (std::size_t k = 0; k < choice.sources.size(); ++k) {
    const std::string& source = choice.sources[k];
    if (source.empty())
      throw UsageError("--live", fmt::format("person {} has none, and the motion of others comes in live", k + 1),
                       "give each --avatar a --live after it, with a port of its own");
    if (source == "-" && choice.sources.size() > 1)
      throw UsageError("--live", "lines on standard input are of one person",
                       "name one avatar, or ports: vmc://HOST:PORT");
    const std::string place =
        source == "-" ? source : host_port_url(kScheme, parse_host_port(source, kScheme, "--live"));
    if (!taken.insert(place).second)
      throw UsageError("--live", fmt::format("two people have the source {}", source), "give each a port of their own");
  }
  for (const char* flag : {"--animation", "--ignore-morphs", "--colliders", "--count", "--radius"})
    if (verb.count(flag) != 0)
      throw UsageError(flag, "the motion and the colliders come from the live source",
                       fmt::format("leave out {} or --live", flag));
  if (!choice.is_lines()) return;
  if (verb.count("--rate") != 0)
    throw UsageError("--rate", "each line on standard input is a frame", "leave --rate out");
  for (const char* flag : {"--origin", "--at"})
    if (verb.count(flag) != 0)
      throw UsageError(flag, "each line says where avatar and colliders stand", fmt::format("leave {} out", flag));
  if (verb.count("--limbs") != 0)
    throw UsageError("--limbs", "lines on standard input are of one person, whom their own limbs never touch",
                     "leave it out");
}

namespace {

LiveCounts record_from_lines(const Avatar& avatar, Recorder& recorder, const LiveSettings& settings,
                             Verbosity verbosity) {
  LiveNdjson lines(avatar);
  RecordingThread thread(recorder);
  const LiveCounts counts = record_lines(STDIN_FILENO, lines, thread, settings);
  thread.stop();
  warn_of(lines.problems(), "standard input", verbosity);
  return counts;
}

LiveCounts record_from_ports(const LiveChoice& choice, std::span<const LivePerson> people, Recorder& recorder,
                             const LiveSettings& settings, const glm::dvec3& origin_m, Verbosity verbosity) {
  std::deque<LiveState> states;
  std::deque<UdpReceiver> receivers;
  std::vector<LiveSource> sources;
  sources.reserve(people.size());
  for (std::size_t k = 0; k < people.size(); ++k) {
    const std::string& source = choice.sources[k];
    states.emplace_back(people[k].avatar, origin_m, people[k].stance);
    receivers.emplace_back(parse_host_port(source, kScheme, "--live"), source);
    sources.push_back({receivers.back(), states.back()});
  }
  RecordingThread thread(recorder);
  if (verbosity != Verbosity::kQuiet)
    print_message(
        fmt::format("vestige: listening on {}; the recording begins with the first datagram, and Ctrl-C ends it\n",
                    fmt::join(choice.sources, " and ")));
  const LiveCounts counts = record_states(sources, thread, settings);
  thread.stop();
  for (std::size_t k = 0; k < people.size(); ++k) {
    warn_of(states[k].vmc().problems(), choice.sources[k], verbosity);
    report_bones(states[k].vmc(), people[k].avatar.humanoid, choice.sources[k], verbosity);
  }
  if (counts.ids_clash)
    warn(
        "several sources sent colliders of one id; only those of whoever sent it first were recorded\n  Give each "
        "sender ids of its own.",
        verbosity);
  return counts;
}

}  // namespace

LiveCounts record_live(const LiveChoice& choice, std::span<const LivePerson> people, Recorder& recorder,
                       LiveSettings settings, const glm::dvec3& origin_m, Verbosity verbosity) {
  settings.asked = asked;
  const LiveCounts counts = choice.is_lines()
                                ? record_from_lines(people.front().avatar, recorder, settings, verbosity)
                                : record_from_ports(choice, people, recorder, settings, origin_m, verbosity);
  const std::string source = choice.is_lines() ? "standard input" : fmt::format("{}", fmt::join(choice.sources, ", "));
  if (counts.frames == 0)
    throw Error(source, "no frame arrived, so there is no trace",
                choice.is_lines()
                    ? "give a line of JSON for each frame: see traces/FORMAT.md"
                    : "make the sender send to this machine and port, and check that no firewall blocks it");
  if (counts.malformed > 0 && choice.is_lines())
    warn(fmt::format("{}: left out {} that could not be read", source, counted(counts.malformed, "line")), verbosity);
  if (counts.lost_input() && !choice.is_lines())
    warn(fmt::format("{}: lost {} that came too late, {} that could not be read, and {} that the system discarded",
                     source, counted(counts.late, "frame"), counted(counts.malformed, "datagram"),
                     counted(counts.overflowed, "datagram")),
         verbosity);
  return counts;
}

}  // namespace vestige::cli
