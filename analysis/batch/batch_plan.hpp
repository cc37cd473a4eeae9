#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/base/error.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

/// Part `number` (from 1) of `count`: the traces whose position modulo `count` is `number` - 1.
struct Shard {
  std::size_t number = 1;
  std::size_t count = 1;

  bool has(std::size_t position) const { return position % count == number - 1; }
  friend bool operator==(const Shard&, const Shard&) = default;
};

struct BatchMap {
  std::string name;    ///< unique; a file's name and a CSV field
  std::string given;   ///< on the command line
  std::string sha256;  ///< of the PNG, then the sidecar; empty: it cannot be used
  ActuatorMapFiles files;
  std::shared_ptr<const ActuatorLayout> layout;  ///< on the avatar; null: it cannot be used
  std::vector<std::string> warnings;             ///< one sentence each
};

/// The motors of all maps; none: ideal ones, that do at once what they are told.
struct BatchActuators {
  std::string given;  ///< the model's file
  std::string json;   ///< its text
  std::string sha256;
  std::shared_ptr<const ActuatorModel> model;
};

struct BatchTrace {
  std::string name;                    ///< unique, as for maps
  std::string given;                   ///< a file, or the scenario's name
  const Scenario* scenario = nullptr;  ///< to be recorded
};

/// How scenarios among the traces are recorded.
struct ScenarioRecording {
  double rate_hz = 1000;
  double duration_s = 2;
  std::optional<std::uint32_t> count;  ///< none: each scenario's own
};

/// An input that could not be used; the rest goes on.
struct BatchFailure {
  std::string what;  ///< "map" or "trace"
  std::string name;
  std::string given;
  std::string cause;
  std::string remedy;
};
BatchFailure failure_of(std::string_view what, std::string_view name, std::string_view given, const Error& error);

/// Everything that a batch's results follow from, apart from the bytes of its traces.
struct BatchPlan {
  std::string avatar_given;
  std::vector<std::byte> avatar_glb;
  std::string avatar_sha256;
  Avatar avatar;
  std::vector<BatchMap> maps;  ///< those that cannot be used included
  std::vector<BatchTrace> traces;
  std::vector<std::string> laws;
  LawOptions law_options;
  BatchActuators actuators;
  std::string detector;
  std::string method;
  std::string skip;
  ScenarioRecording recording;
  std::uint64_t seed = 1;

  bool has_scenario() const;
};

/// "man", "man-2", …: one name for each path, made of its last part without extension, unique, of letters, digits, '.',
/// '_', '-' and whatever of UTF-8 is not ASCII, so that it can be a file's name and a CSV field.
std::vector<std::string> unique_names(std::span<const std::string> given);

/// What run.json says under "batch": avatar, maps, laws, options, traces, program.
nlohmann::ordered_json to_json(const BatchPlan& plan);

/// The part of it that was typed: a folder belongs to one such command and is gone on with by the same only.
/// Of an earlier version's batch too. Throws nlohmann's exceptions where `batch` is none.
nlohmann::json command_of(const nlohmann::ordered_json& batch);

/// A SHA-256 of what a trace's result follows from, apart from the trace: program, avatar, usable maps with their
/// bytes, laws, options.
std::string item_key(const nlohmann::ordered_json& batch);

/// Version and commit of this program.
std::string program_version();

/// Of a file's bytes. Throws `Error` naming it.
std::string sha256_of_file(const std::string& path);

}  // namespace vestige
