#include "analysis/batch/batch_plan.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <set>

#include "analysis/provenance.hpp"
#include "traces/output_file.hpp"
#include "traces/sha256.hpp"
#include "version.hpp"

namespace vestige {

namespace {

constexpr std::size_t kLongestName = 100;  // file systems end at 255 bytes, and extensions come behind

bool may_stand_in_a_name(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return byte >= 0x80 || std::isalnum(byte) != 0 || letter == '.' || letter == '_' || letter == '-';
}

std::string name_of(const std::string& given) {
  std::string name = std::filesystem::path(given).stem().string().substr(0, kLongestName);
  std::ranges::replace_if(
      name, [](char letter) { return !may_stand_in_a_name(letter); }, '_');
  // A name that begins with these would be a hidden file, or read as a flag.
  if (name.empty() || name.front() == '.' || name.front() == '-') return fmt::format("_{}", name);
  return name;
}

}  // namespace

BatchFailure failure_of(std::string_view what, std::string_view name, std::string_view given, const Error& error) {
  const std::string_view text = error.what();
  const std::size_t end = text.find("\n  ");
  return {std::string(what), std::string(name), std::string(given), std::string(text.substr(0, end)),
          end == std::string_view::npos ? "" : std::string(text.substr(end + 3))};
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
  json["avatar"] = {{"given", plan.avatar_given}, {"sha256", plan.avatar_sha256}};
  json["maps"] = nlohmann::ordered_json::array();
  for (const BatchMap& map : plan.maps) {
    nlohmann::ordered_json one = {{"name", map.name}, {"given", map.given}, {"sha256", nullptr}};
    if (!map.sha256.empty()) one["sha256"] = map.sha256;
    json["maps"].push_back(one);
  }
  json["laws"] = plan.laws;
  nlohmann::ordered_json& options = json["options"];
  options["hold_ms"] = plan.hold_s * 1e3;
  options["detector"] = plan.detector;
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
  for (const BatchTrace& trace : plan.traces) json["traces"].push_back({{"name", trace.name}, {"given", trace.given}});
  return json;
}

nlohmann::ordered_json command_of(const nlohmann::ordered_json& batch) {
  nlohmann::ordered_json command = batch;
  command.erase("program");
  command["avatar"].erase("sha256");
  for (nlohmann::ordered_json& map : command["maps"]) map.erase("sha256");
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
  const std::string text = key.dump();
  return sha256_hex(std::as_bytes(std::span(text)));
}

std::string program_version() {
  return fmt::format("{} {}", kVersion, commit());
}

std::string sha256_of_file(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw system_error(path, "could not open", errno);
  Sha256 sha;
  std::vector<std::byte> buffer(std::size_t{1} << 18);
  ssize_t count = 0;
  while ((count = ::read(file, buffer.data(), buffer.size())) > 0)
    sha.update(std::span(buffer).first(static_cast<std::size_t>(count)));
  const int failure = errno;
  ::close(file);
  if (count < 0) throw system_error(path, "could not read", failure);
  return sha.hex();
}

}  // namespace vestige
