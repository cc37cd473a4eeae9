#include "analysis/base/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "traces/base/utf8.hpp"
#include "version.hpp"

namespace vestige {

namespace {

/// Returns the value of `key` in a file of "key<separator>value" lines, without quotes; empty if the key is missing.
std::string value_in(const char* path, std::string_view key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t place = line.find(separator);
    if (!line.starts_with(key) || place == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", place + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    return first == std::string::npos ? "" : line.substr(first, last - first + 1);
  }
  return "";
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.processor = value_in("/proc/cpuinfo", "model name", ':');
  machine.cores = std::thread::hardware_concurrency();
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  machine.memory_bytes = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  utsname name = {};
  ::uname(&name);
  machine.system = fmt::format("{}, {} {} {}", value_in("/etc/os-release", "PRETTY_NAME", '='), name.sysname,
                               name.release, name.machine);
  return machine;
}

nlohmann::ordered_json provenance(std::span<const std::string> argv) {
  nlohmann::ordered_json json;
  json["schema_version"] = 1;
  json["argv"] = nlohmann::ordered_json::array();
  for (const std::string& argument : argv) json["argv"].push_back(valid_utf8(argument));
  json["version"] = kVersion;
  json["commit"] = kCommit;
  json["dirty"] = kDirty;
  json["time"] = utc_now();
  json["machine"] = to_json(this_machine());
  return json;
}

nlohmann::ordered_json with_provenance(std::span<const std::string> argv, const nlohmann::ordered_json& result) {
  nlohmann::ordered_json json = provenance(argv);
  json.update(result);
  return json;
}

std::map<std::string, std::string> provenance_texts(std::span<const std::string> argv) {
  std::map<std::string, std::string> texts;
  const nlohmann::ordered_json json = provenance(argv);
  for (const auto& [key, value] : json.items())
    texts[key] = value.is_string() ? value.get<std::string>() : value.dump();
  return texts;
}

nlohmann::ordered_json to_json(const Machine& machine) {
  return {{"processor", machine.processor},
          {"cores", machine.cores},
          {"memory_bytes", machine.memory_bytes},
          {"system", machine.system}};
}

nlohmann::ordered_json to_json(const GlInfo& gl) {
  if (gl.context.empty()) return nullptr;
  nlohmann::ordered_json arithmetic = nlohmann::ordered_json::array();
  for (const StageArithmetic& stage : gl.arithmetic)
    arithmetic.push_back({{"stage", stage.stage},
                          {"rounding", stage.rounding},
                          {"keeps_denormal_operands", stage.keeps_denormal_operands},
                          {"keeps_denormal_results", stage.keeps_denormal_results},
                          {"contracts", stage.contracts},
                          {"division_error_ulp", stage.division_error_ulp}});
  return {{"renderer", gl.renderer}, {"version", gl.version},   {"context", gl.context},
          {"vendor", gl.vendor},     {"software", gl.software}, {"arithmetic", arithmetic}};
}

nlohmann::ordered_json to_json(const Avatar& avatar) {
  return {{"vertices", avatar.position_bind.size()},
          {"triangles", avatar.triangles.size()},
          {"joints", avatar.joint_count},
          {"facing", to_string(avatar.facing.axis)},
          {"facing_by", to_string(avatar.facing.by)}};
}

std::string commit() {
  return fmt::format("{}{}", kCommit, kDirty ? "+" : "");
}

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace vestige
