#include "analysis/batch/batch_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "analysis/base/provenance.hpp"
#include "traces/base/descriptor.hpp"
#include "traces/base/sha256.hpp"
#include "traces/base/utf8.hpp"
#include "traces/files/output_file.hpp"
#include "version.hpp"

namespace vestige {

namespace {

constexpr std::size_t kLongestName = 100;  // file systems allow 255 bytes, and extensions follow

bool may_stand_in_a_name(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return byte >= 0x80 || std::isalnum(byte) != 0 || letter == '.' || letter == '_' || letter == '-';
}

/// Returns at most `most_bytes` of whole letters. A byte that belongs to no letter becomes '_'.
std::string shortened_utf8(std::string_view text, std::size_t most_bytes) {
  std::string letters;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::string_view letter = length == 0 ? "_" : text.substr(0, length);
    if (letters.size() + letter.size() > most_bytes) break;
    letters.append(letter);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return letters;
}

/// Returns the JSON as it reads back. A file's name may have bytes that are not text, which JSON cannot hold.
nlohmann::ordered_json as_read_back(const nlohmann::ordered_json& json) {
  return nlohmann::ordered_json::parse(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string name_of(const std::string& given) {
  std::string name = shortened_utf8(std::filesystem::path(given).stem().string(), kLongestName);
  std::ranges::replace_if(
      name, [](char letter) { return !may_stand_in_a_name(letter); }, '_');
  // A name that begins with these would be a hidden file, or read as a flag.
  if (name.empty() || name.front() == '.' || name.front() == '-') return fmt::format("_{}", name);
  return name;
}

/// Returns null if the option is empty.
nlohmann::ordered_json in_flags_unit(const LawParameter& known, const LawOptions& options) {
  const std::optional<double>& value = options.*known.option;
  if (!value) return nullptr;
  return *value * known.per_unit;
}

}  // namespace

BatchFailure failure_of(std::string_view what, std::string_view name, std::string_view given, const Error& error) {
  return {std::string(what), std::string(name), std::string(given), std::string(error.fault()),
          std::string(error.remedy())};
}

bool BatchPlan::has_scenario() const {
  return std::ranges::any_of(traces, [](const BatchTrace& trace) { return trace.scenario != nullptr; });
}

std::vector<std::string> unique_names(std::span<const std::string> given) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const std::string& path : given) {
    const std::string name = name_of(path);
    std::string unique = name;
    for (int number = 2; !taken.insert(unique).second; ++number) unique = fmt::format("{}-{}", name, number);
    names.push_back(unique);
  }
  return names;
}

nlohmann::ordered_json to_json(const BatchPlan& plan) {
  nlohmann::ordered_json json;
  json["program"] = program_version();
  json["avatar"] = {
      {"given", plan.avatar_given}, {"sha256", plan.avatar_sha256}, {"facing", to_string(plan.avatar.facing.axis)}};
  json["maps"] = nlohmann::ordered_json::array();
  for (const BatchMap& map : plan.maps) {
    nlohmann::ordered_json one = {{"name", map.name}, {"given", map.given}, {"sha256", nullptr}};
    if (!map.sha256.empty()) one["sha256"] = map.sha256;
    json["maps"].push_back(one);
  }
  json["laws"] = plan.laws;
  nlohmann::ordered_json& options = json["options"];
  options["hold_ms"] = plan.law_options.hold_s * 1e3;
  for (const LawParameter& known : law_parameters()) options[known.field] = in_flags_unit(known, plan.law_options);
  options["unfelt_mm"] = nullptr;
  if (plan.unfelt_m) options["unfelt_mm"] = *plan.unfelt_m * 1e3;
  options["actuator"] = nullptr;
  if (plan.actuators.model) options["actuator"] = {{"given", plan.actuators.given}, {"sha256", plan.actuators.sha256}};
  options["detector"] = plan.detector;
  if (plan.approximate) options["approximate"] = true;
  if (plan.detector == "decimated") options["keep"] = plan.keep;
  options["method"] = plan.method;
  options["skip"] = plan.skip;
  options["seed"] = plan.seed;
  options["scenarios"] = nullptr;
  if (plan.has_scenario()) {
    options["scenarios"] = {{"rate_hz", plan.recording.rate_hz}, {"duration_s", plan.recording.duration_s}};
    options["scenarios"]["count"] = nullptr;
    if (plan.recording.count) options["scenarios"]["count"] = *plan.recording.count;
  }
  json["traces"] = nlohmann::ordered_json::array();
  for (const BatchTrace& trace : plan.traces) {
    json["traces"].push_back({{"name", trace.name}, {"given", trace.given}});
    if (trace.scenario != nullptr) json["traces"].back()["seed"] = trace.seed;
    if (trace.person) json["traces"].back()["avatar"] = *trace.person + 1;
  }
  return as_read_back(json);
}

nlohmann::json command_of(const nlohmann::ordered_json& batch) {
  nlohmann::json command = batch;
  command.erase("program");
  command["avatar"].erase("sha256");
  for (nlohmann::json& map : command["maps"]) map.erase("sha256");
  nlohmann::json& options = command["options"];
  // A batch of an earlier version lacks these options. It ran as with the defaults.
  for (const LawParameter& known : law_parameters()) options.emplace(known.field, in_flags_unit(known, LawOptions()));
  options.emplace("unfelt_mm", nullptr);
  options.emplace("actuator", nullptr);
  if (nlohmann::json& actuator = options["actuator"]; !actuator.is_null()) actuator.erase("sha256");
  return command;
}

std::string item_key(const nlohmann::ordered_json& batch) {
  nlohmann::ordered_json key;
  key["program"] = batch["program"];
  key["avatar"] = batch["avatar"]["sha256"];
  for (const nlohmann::ordered_json& map : batch["maps"])
    if (!map["sha256"].is_null()) key["maps"].push_back({map["name"], map["sha256"]});
  key["laws"] = batch["laws"];
  key["options"] = batch["options"];
  if (nlohmann::ordered_json& actuator = key["options"]["actuator"]; !actuator.is_null()) actuator.erase("given");
  const std::string text = key.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return sha256_hex(std::as_bytes(std::span(text)));
}

std::string program_version() {
  return fmt::format("{} {}", kVersion, commit());
}

std::string sha256_of_file(const std::string& path) {
  InputDescriptor input(path);
  Sha256 sha;
  std::vector<std::byte> buffer(std::size_t{1} << 18);
  while (const std::size_t count = input.read(buffer)) sha.update(std::span(buffer).first(count));
  return sha.hex();
}

}  // namespace vestige
