#include "analysis/batch/batch_record.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "traces/base/number_text.hpp"

namespace vestige {

nlohmann::ordered_json trace_record(const BatchTrace& trace, const nlohmann::ordered_json& item,
                                    const BatchFolder& folder, bool earlier) {
  nlohmann::ordered_json record = {{"name", trace.name}, {"given", trace.given}, {"sha256", item["trace_sha256"]}};
  if (trace.person) record["avatar"] = *trace.person + 1;
  for (const char* field : {"frames", "colliders", "contacts", "damage"}) record[field] = item[field];
  record["earlier"] = earlier;
  const std::string path = folder.item_times(trace.name);
  const nlohmann::ordered_json run = std::filesystem::exists(path)
                                         ? read_json_object(path, "remove it: only the timings need it")
                                         : nlohmann::ordered_json::object();
  for (const char* field : {"time", "recording_s", "reading_s", "detection_s", "scoring_s"})
    record[field] = run.contains(field) ? run[field] : nullptr;
  return record;
}

nlohmann::ordered_json input_warnings(const BatchPlan& plan) {
  nlohmann::ordered_json json;
  json["avatar"] = {{"warnings", plan.avatar.warnings}};
  json["maps"] = nlohmann::ordered_json::array();
  for (const BatchMap& map : plan.maps) json["maps"].push_back({{"name", map.name}, {"warnings", map.warnings}});
  return json;
}

nlohmann::ordered_json totals(const nlohmann::ordered_json& traces, std::size_t scores_per_trace) {
  nlohmann::ordered_json sums = {{"traces", traces.size()}, {"scores", traces.size() * scores_per_trace}};
  for (const char* field : {"recording_s", "reading_s", "detection_s", "scoring_s"}) {
    double sum = 0;
    for (const nlohmann::ordered_json& trace : traces)
      if (trace[field].is_number()) sum += trace[field].get<double>();
    sums[field] = sum;
  }
  return sums;
}

nlohmann::ordered_json to_json(const BatchFailure& failure) {
  return {{"what", failure.what},
          {"name", failure.name},
          {"given", failure.given},
          {"cause", failure.cause},
          {"remedy", failure.remedy}};
}

std::vector<std::string> losses_of(const nlohmann::ordered_json& item) {
  std::vector<std::string> losses;
  for (const nlohmann::ordered_json& damage : item["damage"]) losses.push_back(damage.get<std::string>());
  const auto frames = item["non_finite_frames"].get<std::uint64_t>();
  const auto segments = item["non_finite_segments"].get<std::uint64_t>();
  if (frames + segments != 0)
    losses.push_back(fmt::format("{}: {} and the ends of {} are not finite; they fired nothing",
                                 item["trace"].get<std::string>(), counted(frames, "pose"),
                                 counted(segments, "segment")));
  return losses;
}

}  // namespace vestige
