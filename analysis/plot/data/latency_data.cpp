#include "analysis/plot/data/latency_data.hpp"

#include <array>
#include <utility>

#include "analysis/base/json_field.hpp"

namespace vestige::plot {

namespace {

constexpr const char* kRemedy = "draw what 'vestige live --json FILE' wrote";
constexpr double kMost = 1e18;

constexpr std::array<std::pair<const char*, const char*>, 4> kStages = {{{"arrival_to_decoded", "decoded"},
                                                                         {"arrival_to_detected", "contacts found"},
                                                                         {"arrival_to_written", "last byte written"},
                                                                         {"arrival_to_acknowledged", "acknowledged"}}};

LatencyLine read_line(const JsonField& stage, const char* name) {
  LatencyLine line;
  line.stage = name;
  line.count = stage.at("count").within(0, kMost);
  if (line.count == 0) return line;
  line.p50_ms = stage.at("p50_ms").within(0, kMost);
  line.p99_ms = stage.at("p99_ms").within(0, kMost);
  const JsonField up_to_ms = stage.at("up_to_ms");
  const JsonField counts = stage.at("counts");
  if (counts.count() != up_to_ms.count()) counts.refuse("has not as many numbers as up_to_ms");
  double before_ms = 0;
  double seen = 0;
  for (std::size_t i = 0; i < counts.count(); ++i) {
    before_ms = up_to_ms.at(i).within(before_ms, kMost);
    if (before_ms == 0) up_to_ms.at(i).refuse("is 0");
    seen += counts.at(i).within(0, line.count);
    line.up_to_ms.push_back(before_ms);
    line.shares.push_back(seen / line.count);
  }
  return line;
}

}  // namespace

LatencyResult read_latency(const std::filesystem::path& path) {
  const nlohmann::json json = read_json(path, kRemedy);
  const JsonField document(json, path, kRemedy);
  const JsonField latency = document.at("latency");
  LatencyResult result;
  for (const auto& [field, name] : kStages) {
    LatencyLine line = read_line(latency.at(field), name);
    if (line.count > 0) result.lines.push_back(std::move(line));
  }
  if (result.lines.empty()) latency.refuse("has no frame");
  result.pose_delay_ms = latency.at("pose_delay").at("p50_ms").within(0, kMost);
  result.floor_ms = document.at("floor_us").within(0, kMost) / 1e3;
  const JsonField link = document.at("link");
  result.port = link.at("port").text();
  if (link.has("line_time_us")) result.line_time_ms = link.at("line_time_us").within(0, kMost) / 1e3;
  if (document.has("machine")) result.machine = document.at("machine").at("processor").text();
  result.commit = commit_of(document);
  return result;
}

}  // namespace vestige::plot
