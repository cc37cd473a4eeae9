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
  std::string name;    ///< unique; usable as a file's name and as a CSV field
  std::string given;   ///< the word on the command line
  std::string sha256;  ///< of the PNG and then the sidecar; empty: the map cannot be used
  ActuatorMapFiles files;
  std::shared_ptr<const ActuatorLayout> layout;  ///< on the avatar; null: the map cannot be used
  std::vector<std::string> warnings;             ///< one sentence each
};

/// The motors of all maps. Without a model, motors are ideal and follow at once.
struct BatchActuators {
  std::string given;  ///< the model's file on the command line
  std::string json;   ///< the file's text
  std::string sha256;
  std::shared_ptr<const ActuatorModel> model;
};

struct BatchTrace {
  std::string name;                        ///< unique, as for maps
  std::string given;                       ///< a file or a scenario's name
  const Scenario* scenario = nullptr;      ///< the scenario to record; null for a file
  std::uint64_t seed = 1;                  ///< of the scenario
  std::optional<std::size_t> person = {};  ///< counted from 0, if the file holds several people
};

/// How scenarios among the traces are recorded.
struct ScenarioRecording {
  double rate_hz = 1000;
  double duration_s = 2;
  std::optional<std::uint32_t> count;  ///< none: each scenario's own count
};

/// An input that could not be used. The batch continues without it.
struct BatchFailure {
  std::string what;  ///< "map" or "trace"
  std::string name;
  std::string given;
  std::string cause;
  std::string remedy;
};
BatchFailure failure_of(std::string_view what, std::string_view name, std::string_view given, const Error& error);

/// Everything that determines a batch's results, except the bytes of its traces.
struct BatchPlan {
  std::string avatar_given;
  std::vector<std::byte> avatar_glb;
  std::string avatar_sha256;
  Avatar avatar;
  std::vector<BatchMap> maps;  ///< includes maps that cannot be used
  std::vector<BatchTrace> traces;
  std::vector<std::string> laws;
  LawOptions law_options;
  std::optional<double> unfelt_m;  ///< the error of a contact that is not felt, in `error_with_unfelt_mm`
  BatchActuators actuators;
  std::string detector;
  bool approximate = false;  ///< the detector puts simpler shapes in place of the skin
  bool takes_radii = true;   ///< the detector tests spheres; otherwise traces with radii are refused
  double keep = 0.1;         ///< share of the triangles that `decimated` keeps
  std::string method;
  std::string skip;
  ScenarioRecording recording;
  std::uint64_t seed = 1;

  bool has_scenario() const;
};

/// Returns a unique name for each path, for example "man", "man-2". It is made of the path's last part without
/// extension. It has only letters, digits, '.', '_', '-' and UTF-8 letters outside ASCII, so that it can be a file's
/// name and a CSV field.
std::vector<std::string> unique_names(std::span<const std::string> given);

/// Returns the content of "batch" in run.json: avatar, maps, laws, options, traces, program.
nlohmann::ordered_json to_json(const BatchPlan& plan);

/// Returns the part of `batch` that the user typed. A folder belongs to one such command, and only the same command may
/// continue it. Also accepts a batch of an earlier version. Throws nlohmann's exceptions if `batch` is not a batch.
nlohmann::json command_of(const nlohmann::ordered_json& batch);

/// Returns a SHA-256 of everything that a trace's result depends on, except the trace: program, avatar, usable maps
/// with their bytes, laws, options.
std::string item_key(const nlohmann::ordered_json& batch);

/// Returns the version and commit of this program.
std::string program_version();

/// Returns the SHA-256 of a file's bytes. Throws `Error` with the file's name.
std::string sha256_of_file(const std::string& path);

}  // namespace vestige
