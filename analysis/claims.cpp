#include "analysis/claims.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <set>

namespace vestige {

namespace {

/// The counts at which the paper quotes its own figures (HAVE 2010 §IV).
const std::set<int> kQuotedCounts = {1, 40, 100};

std::string command_of(const nlohmann::json& argv) {
  std::string command;
  for (const auto& word : argv) {
    const auto text = word.get<std::string>();
    command += command.empty() ? std::filesystem::path(text).filename().string() : " " + text;
  }
  return command;
}

std::string machine_of(const nlohmann::json& result, const nlohmann::json& gl) {
  const auto& machine = result.at("machine");
  return fmt::format("{}, {} cores; {}", machine.at("processor").get<std::string>(), machine.at("cores").get<int>(),
                     gl.is_object() ? gl.at("renderer").get<std::string>() : "no GL");
}

void add_sweep(const nlohmann::json& result, const Claim& base, std::vector<Claim>& claims) {
  for (const auto& series : result.at("series")) {
    Claim claim = base;
    claim.machine = machine_of(result, series.at("gl"));
    const auto context = series.at("context").get<std::string>();
    claim.claim = fmt::format("`{}`{} detects at", series.at("detector").get<std::string>(),
                              context.empty() ? "" : " on " + context);
    for (const auto& point : series.at("points")) {
      const int colliders = point.at("colliders").get<int>();
      if (!kQuotedCounts.contains(colliders)) continue;
      fmt::format_to(std::back_inserter(claim.claim), "{} {:.0f} Hz ({:.0f} to {:.0f}) with {}",
                     claim.claim.ends_with(" at") ? "" : ",", point.at("hz").get<double>(),
                     point.at("hz_low").get<double>(), point.at("hz_high").get<double>(), colliders);
    }
    if (claim.claim.ends_with(" at")) continue;  // none of the paper's counts
    claim.claim += " colliders";
    claims.push_back(claim);
  }
}

void add_record(const nlohmann::json& result, Claim claim, std::vector<Claim>& claims) {
  claim.machine = machine_of(result, nullptr);
  const auto frames = result.at("frames").get<double>();
  const auto seconds = result.at("recording_s").get<double>();
  claim.claim = fmt::format("`record` samples and writes {:.0f} frames in {:.3f} s: {:.0f} frames/s", frames, seconds,
                            frames / seconds);
  claims.push_back(claim);
}

void add_replay(const nlohmann::json& result, const Claim& base, std::vector<Claim>& claims) {
  Claim claim = base;
  claim.machine = machine_of(result, result.at("gl"));
  const auto detector = result.at("detector").get<std::string>();
  const std::string context = result.at("gl").is_object() ? " on " + result["gl"]["context"].get<std::string>() : "";
  const auto trace = std::filesystem::path(result.at("trace").get<std::string>()).filename().string();
  claim.claim = fmt::format("`{}`{}, {} ({} frames, {} colliders): ", detector, context, trace,
                            result.at("frames").get<int>(), result.at("colliders").get<int>());
  if (result.contains("verify") && result["verify"].contains("differing"))
    fmt::format_to(std::back_inserter(claim.claim), "{} of {} contacts differ from {}; ",
                   result["verify"].at("differing").get<std::uint64_t>(),
                   result["verify"].at("expected").get<std::uint64_t>(),
                   result["verify"].at("against").get<std::string>());
  const auto& skinning = result.at("skinning");
  fmt::format_to(std::back_inserter(claim.claim),
                 "skinned vertices lie within {:.2g} of the avatar's height of the double reference, {} of {} with the "
                 "bits of the CPU's; the reader delivers {:.0f} frames/s; texture_hash {:.16}…",
                 skinning.at("largest_error_of_height").get<double>(),
                 skinning.at("identical_to_cpu").get<std::uint64_t>(), skinning.at("vertices").get<std::uint64_t>(),
                 result.at("frames").get<double>() / result.at("reading_s").get<double>(),
                 result.at("texture_hash").get<std::string>());
  claims.push_back(claim);
}

}  // namespace

std::vector<Claim> claims_of(const nlohmann::json& result, const std::string& file) {
  std::vector<Claim> claims;
  if (!result.is_object() || !result.contains("argv")) return claims;
  Claim base;
  base.command = command_of(result.at("argv"));
  base.time = result.at("time").get<std::string>();
  base.commit =
      fmt::format("{:.10}{}", result.at("commit").get<std::string>(), result.at("dirty").get<bool>() ? "+" : "");
  base.file = file;
  if (result.contains("series")) add_sweep(result, base, claims);
  if (result.contains("recording_s")) add_record(result, base, claims);
  if (result.contains("texture_hash")) add_replay(result, base, claims);
  return claims;
}

std::string claims_table(const std::vector<Claim>& claims) {
  std::string table = "| claim | command | time | machine | commit | file |\n|---|---|---|---|---|---|\n";
  for (const Claim& claim : claims)
    fmt::format_to(std::back_inserter(table), "| {} | `{}` | {} | {} | {} | [{}]({}) |\n", claim.claim, claim.command,
                   claim.time, claim.machine, claim.commit, claim.file, claim.file);
  return table;
}

}  // namespace vestige
