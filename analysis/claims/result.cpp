#include "analysis/claims/result.hpp"

#include <fmt/format.h>

namespace vestige {

ResultKind kind_of(const nlohmann::json& result) {
  if (!result.is_object() || !result.contains("argv")) return ResultKind::kOther;
  const auto has = [&result](const char* field) { return result.contains(field); };
  if (has("series")) return ResultKind::kSweep;
  if (has("by_colliders")) return ResultKind::kGrowth;
  if (has("recording_s")) return ResultKind::kRecord;
  if (has("texture_hash")) return ResultKind::kReplay;
  if (has("files") && has("total")) return ResultKind::kQuery;
  if (has("scenes") && has("duration_s")) return ResultKind::kAccuracy;
  if (has("families")) return result["families"].is_array() ? ResultKind::kStress : ResultKind::kAgreement;
  if (has("methods")) return ResultKind::kGeometryAgreement;
  if (has("decisions")) return ResultKind::kExactness;
  return ResultKind::kOther;
}

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

Error not_ours(const std::string& path, const nlohmann::json::exception& exception) {
  return {path, fmt::format("is not a result of Vestige: {}", exception.what()), "remove it, or write it again"};
}

}  // namespace vestige
