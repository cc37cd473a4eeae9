#include "analysis/frequency/claims.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <map>
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
    claim.claim = fmt::format("`{}`{}{}{} detects at", series.at("detector").get<std::string>(),
                              context.empty() ? "" : " on " + context,
                              series.value("skip", "off") == "on" ? " with skipping" : "",
                              series.value("renderer", "off") == "on" ? " beside a renderer" : "");
    for (const auto& point : series.at("points")) {
      const int colliders = point.at("colliders").get<int>();
      if (!kQuotedCounts.contains(colliders)) continue;
      std::string interval;
      if (!point.at("hz_low").is_null())
        interval = fmt::format(" ({:.0f} to {:.0f})", point["hz_low"].get<double>(), point.at("hz_high").get<double>());
      fmt::format_to(std::back_inserter(claim.claim), "{} {:.0f} Hz{} with {}", claim.claim.ends_with(" at") ? "" : ",",
                     point.at("hz").get<double>(), interval, colliders);
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

void add_query(const nlohmann::json& result, Claim claim, std::vector<Claim>& claims) {
  claim.machine = machine_of(result, nullptr);
  const auto& total = result.at("total");
  const auto count = [&total](const char* field) { return total.at(field).get<std::uint64_t>(); };
  claim.claim = fmt::format(
      "`{}` by `{}` answers {} queries ({}) with {} false negatives and {} false positives; median {:.2f} us, worst "
      "{:.0f} us",
      result.at("method").get<std::string>(), result.at("detector").get<std::string>(), count("queries"),
      result.at("arithmetic").get<std::string>(), count("false_negatives"), count("false_positives"),
      total.at("median_us").get<double>(), total.at("max_us").get<double>());
  claims.push_back(claim);
}

void add_accuracy(const nlohmann::json& result, const Claim& base, std::vector<Claim>& claims) {
  for (const auto& scene : result.at("scenes"))
    for (const auto& series : scene.at("series")) {
      Claim claim = base;
      claim.machine = machine_of(result, result.at("gl"));
      claim.claim =
          fmt::format("`{}` with `{}`, {}: of {} true contacts it misses", series.at("detector").get<std::string>(),
                      series.at("method").get<std::string>(), scene.at("colliders").get<std::string>(),
                      scene.at("truth").at("events").get<std::uint64_t>());
      for (const auto& point : series.at("points"))
        fmt::format_to(std::back_inserter(claim.claim), "{} {:.1f} % at {} Hz",
                       claim.claim.ends_with(" misses") ? "" : ",", 100 * point.at("missed_share").get<double>(),
                       point.at("rate_hz").get<double>());
      claims.push_back(claim);
    }
}

void add_stress(const nlohmann::json& result, const Claim& base, std::vector<Claim>& claims) {
  struct Sum {
    std::uint64_t cases = 0;
    std::uint64_t missed = 0;
    std::uint64_t false_positives = 0;
    std::uint64_t wrong_winner = 0;
  };
  std::map<std::pair<std::string, std::string>, Sum> sums;
  for (const auto& row : result.at("families")) {
    Sum& sum = sums[{row.at("detector").get<std::string>(), row.at("method").get<std::string>()}];
    sum.cases += row.at("cases").get<std::uint64_t>();
    sum.missed += row.at("false_negatives").get<std::uint64_t>();
    sum.false_positives += row.at("false_positives").get<std::uint64_t>();
    sum.wrong_winner += row.at("wrong_winner").get<std::uint64_t>();
  }
  for (const auto& [contestant, sum] : sums) {
    Claim claim = base;
    claim.machine = machine_of(result, result.at("gl"));
    claim.claim =
        fmt::format("`{}` with `{}`, of {} hostile cases: {} false negatives, {} false positives, {} wrong winners",
                    contestant.first, contestant.second, sum.cases, sum.missed, sum.false_positives, sum.wrong_winner);
    claims.push_back(claim);
  }
}

void add_agreement(const nlohmann::json& result, Claim claim, std::vector<Claim>& claims) {
  claim.machine = machine_of(result, nullptr);
  std::uint64_t pairs = 0;
  std::uint64_t differences = 0;
  for (const auto& family : result.at("families")) {
    pairs += family.at("pairs").get<std::uint64_t>();
    differences += family.at("differences").get<std::uint64_t>();
  }
  claim.claim = fmt::format("the deciding code and the slow truth differ in {} of {} pairs (`{}`)", differences, pairs,
                            result.at("method").get<std::string>());
  claims.push_back(claim);
}

void add_geometry_agreement(const nlohmann::json& result, Claim claim, std::vector<Claim>& claims) {
  for (const auto& method : result.at("methods")) {
    claim.machine = machine_of(result, method.at("renderer") == "" ? nlohmann::json() : method);
    claim.claim =
        fmt::format("`{}`{} against `cpu` on {} adversarial pairs (`{}`): {} missed, {} winners differ",
                    method.value("detector", "geometry"), method.value("skip", false) ? " with skipping" : "",
                    method.at("pairs").get<std::uint64_t>(), method.at("method").get<std::string>(),
                    method.at("missed").get<std::uint64_t>(), method.at("winners_differing").get<std::uint64_t>());
    claims.push_back(claim);
  }
}

void add_exactness(const nlohmann::json& result, Claim claim, std::vector<Claim>& claims) {
  claim.machine = machine_of(result, nullptr);
  for (const auto& frame : result.at("frames")) {
    claim.claim = fmt::format(
        "exact decisions take {:.3f} times the time of plain double ones ({}, whole frame, skip {})",
        frame.at("ratio").get<double>(), frame.at("colliders").get<std::string>(), frame.value("skip", "off"));
    claims.push_back(claim);
  }
}

}  // namespace

nlohmann::json with_run(nlohmann::json result, const nlohmann::json& run) {
  nlohmann::json gl = run.value("gl", nlohmann::json());
  for (const auto& scene : run.value("scenes", nlohmann::json::array()))
    for (const auto& series : scene.at("series"))
      if (gl.is_null()) gl = series.value("gl", nlohmann::json());
  for (const char* field : {"argv", "time", "commit", "dirty", "machine"}) result[field] = run.at(field);
  result["gl"] = gl;
  if (run.contains("complete")) result["complete"] = run["complete"];
  return result;
}

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
  if (result.contains("files") && result.contains("total")) add_query(result, base, claims);
  if (result.contains("scenes") && result.contains("duration_s")) add_accuracy(result, base, claims);
  if (result.contains("families")) {
    if (result["families"].is_array()) {
      add_stress(result, base, claims);
    } else {
      add_agreement(result, base, claims);
    }
  }
  if (result.contains("methods")) add_geometry_agreement(result, base, claims);
  if (result.contains("decisions")) add_exactness(result, base, claims);
  if (!result.value("complete", true))
    for (Claim& claim : claims) claim.claim += " (**not complete**: stopped before its end, or from a damaged trace)";
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
