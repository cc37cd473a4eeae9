#include "analysis/batch/batch_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/mapping/body.hpp"
#include "analysis/mapping/layouts.hpp"
#include "analysis/mapping/map_check.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

namespace {

/// An avatar, and its facing as a trace records it.
struct TracedAvatar {
  std::string given;  ///< where it comes from
  std::vector<std::byte> glb;
  std::string facing;
};

/// Returns the avatar of the first trace that can be read.
TracedAvatar avatar_of(const std::vector<BatchTrace>& traces) {
  std::exception_ptr first;
  for (const BatchTrace& trace : traces) {
    if (trace.scenario != nullptr) return {.given = "builtin", .glb = builtin_avatar_glb(), .facing = ""};
    try {
      const TraceReader reader(trace.given, People::kSeveral);
      const RecordedPerson& person = reader.people()[trace.person.value_or(0)];
      return {
          .given = trace.given, .glb = {person.avatar_glb.begin(), person.avatar_glb.end()}, .facing = person.facing};
    } catch (const Error&) {
      // If another trace can be read, this error is reported later, with the other traces.
      if (!first) first = std::current_exception();
    }
  }
  std::rethrow_exception(first);  // there is at least one trace
}

/// Returns an avatar that is named, with the facing that the first trace of it records.
TracedAvatar named_avatar(const std::string& avatar, const std::vector<BatchTrace>& traces) {
  TracedAvatar named = {.given = avatar, .glb = read_builtin_or_file(avatar), .facing = ""};
  const bool all_made = std::ranges::all_of(traces, [](const BatchTrace& trace) { return trace.scenario != nullptr; });
  if (all_made) return named;
  try {
    const TracedAvatar traced = avatar_of(traces);
    if (sha256_hex(traced.glb) == sha256_hex(named.glb)) named.facing = traced.facing;
  } catch (const Error&) {
    // Traces that cannot be read are reported later.
  }
  return named;
}

BatchActuators read_actuators(const std::string& file) {
  BatchActuators actuators = {.given = file, .json = read_text_file(file), .sha256 = {}, .model = nullptr};
  actuators.sha256 = sha256_hex(std::as_bytes(std::span(actuators.json)));
  actuators.model = std::make_shared<const ActuatorModel>(parse_actuator_model(actuators.json, file));
  return actuators;
}

ActuatorMapFiles map_files(const std::string& given, const Avatar& avatar, bool builtin_avatar) {
  if (given == kBuiltin && !builtin_avatar)
    throw Error(given, "is the map of the built-in avatar, but the batch has another avatar",
                "name one of the layouts, which fit any humanoid, or a PNG for this avatar");
  return read_map_files(avatar, given);
}

/// Adds the problems that 'vestige map check' finds as warnings.
void add_problems(BatchMap& map, const ActuatorMap& parsed, const BatchPlan& plan) {
  constexpr std::size_t kMostTold = 3;
  std::size_t problems = 0;
  for (const MapFinding& finding : check_map(Body(plan.avatar), parsed, plan.avatar_given).findings)
    if (finding.severity == Severity::kProblem && ++problems <= kMostTold)
      map.warnings.push_back(fmt::format("{}; {}", finding.cause, finding.remedy));
  if (problems > kMostTold)
    map.warnings.push_back(
        fmt::format("and {}; 'vestige map check' lists them", counted(problems - kMostTold, "more problem")));
}

void load_map(BatchMap& map, const BatchPlan& plan, bool builtin_avatar) {
  map.files = map_files(map.given, plan.avatar, builtin_avatar);
  ActuatorMap parsed = parse_actuator_map(map.files, plan.avatar, map.given);
  if (parsed.actuator_count == 0)
    throw Error(map.given, "has no actuator", "paint regions other than black, or list actuators in the sidecar");
  if (plan.actuators.model) static_cast<void>(plan.actuators.model->motors(parsed));  // throws if they lack something
  map.warnings = parsed.warnings;
  if (map.given != kBuiltin && !is_layout(map.given)) add_problems(map, parsed, plan);
  if (plan.avatar.facing.lies_deg)
    map.warnings.push_back(fmt::format("the avatar {}; scores take {} for its front",
                                       describe_lying(plan.avatar.facing), to_string(plan.avatar.facing.axis)));
  map.layout = std::make_shared<const ActuatorLayout>(plan.avatar, std::move(parsed));
  map.sha256 = sha256_of(map.files);
}

/// Of a file that cannot be read: 1. What is wrong with it shows when its turn comes.
std::size_t people_in(const std::string& file) {
  try {
    return TraceReader(file, People::kSeveral).people().size();
  } catch (const Error&) {
    return 1;
  }
}

/// pair.mcap: pair-2.mcap.
std::string numbered(const std::filesystem::path& file, std::size_t number) {
  return (file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string()))
      .string();
}

/// Calls `work` for each of 0 … count - 1. After all threads have ended, rethrows an exception of `work`, if any.
template <typename Work>
void in_threads(std::size_t threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  std::vector<std::thread> running;
  for (std::size_t i = 0; i < threads; ++i) {
    running.emplace_back([&] {
      try {
        for (std::size_t k = next++; k < count; k = next++) work(k);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
    });
  }
  for (std::thread& thread : running) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

std::vector<BatchFailure> load_inputs(BatchPlan& plan, const std::string& avatar, const std::vector<std::string>& maps,
                                      const std::string& actuator, std::size_t jobs,
                                      const std::function<bool()>& go_on) {
  if (!actuator.empty()) plan.actuators = read_actuators(actuator);
  TracedAvatar chosen = avatar.empty() ? avatar_of(plan.traces) : named_avatar(avatar, plan.traces);
  plan.avatar_given = chosen.given;
  plan.avatar_glb = std::move(chosen.glb);
  plan.avatar = parse_avatar_glb(plan.avatar_glb, plan.avatar_given);
  take_recorded_facing(plan.avatar.facing, chosen.facing);
  plan.avatar_sha256 = sha256_hex(plan.avatar_glb);
  const bool builtin = plan.avatar_sha256 == sha256_hex(builtin_avatar_glb());

  const std::vector<std::string> names = unique_names(maps);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    BatchMap& map = plan.maps.emplace_back();
    map.name = names[i];
    map.given = maps[i];
  }
  std::vector<std::optional<BatchFailure>> failed(maps.size());
  in_threads(std::min(jobs, maps.size()), maps.size(), [&](std::size_t i) {
    if (!go_on()) throw Error("batch", "was stopped before its first trace", "start it again");
    BatchMap& map = plan.maps[i];
    try {
      load_map(map, plan, builtin);
    } catch (const Error& error) {
      failed[i] = failure_of("map", map.name, map.given, error);
    }
  });
  std::vector<BatchFailure> failures;
  for (std::optional<BatchFailure>& failure : failed)
    if (failure) failures.push_back(std::move(*failure));
  return failures;
}

std::vector<BatchTrace> name_traces(const std::vector<std::string>& given, const std::vector<std::uint64_t>& seeds) {
  std::vector<BatchTrace> traces;
  std::vector<std::string> words;  // of which names are made
  for (const std::string& word : given) {
    const Scenario* scenario = find_scenario(word);
    if (const std::size_t people = scenario != nullptr ? 1 : people_in(word); people > 1) {
      for (std::size_t person = 0; person < people; ++person) {
        words.push_back(numbered(word, person + 1));
        traces.push_back({"", word, nullptr, 0, person});
      }
      continue;
    }
    for (const std::uint64_t seed : scenario == nullptr ? std::vector<std::uint64_t>{0} : seeds) {
      words.push_back(scenario != nullptr && seeds.size() > 1 ? fmt::format("{}-{}", word, seed) : word);
      traces.push_back({"", word, scenario, seed, std::nullopt});
    }
  }
  const std::vector<std::string> names = unique_names(words);
  for (std::size_t i = 0; i < traces.size(); ++i) traces[i].name = names[i];
  return traces;
}

}  // namespace vestige
