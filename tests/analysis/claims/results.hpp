#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/claims/result.hpp"

namespace vestige::test {

/// What every result says of where it comes from.
inline nlohmann::json origin(const std::vector<std::string>& argv = {"build/bin/vestige", "sweep", "-o", "out"}) {
  return {{"argv", argv},
          {"time", "2026-01-02T03:04:05Z"},
          {"commit", "0123456789abcdef"},
          {"dirty", true},
          {"machine", {{"processor", "Abacus"}, {"cores", 2}}}};
}

inline nlohmann::json gl(const char* renderer) {
  return {{"renderer", renderer}, {"context", "osmesa"}};
}

inline nlohmann::json point(int colliders, double hz) {
  return {{"colliders", colliders}, {"hz", hz}, {"hz_low", hz - 1}, {"hz_high", hz + 1}};
}

inline nlohmann::json series(const char* detector, const nlohmann::json& gl,
                             const std::vector<nlohmann::json>& points) {
  return {{"detector", detector}, {"context", gl.is_object() ? "osmesa" : ""}, {"gl", gl}, {"points", points}};
}

inline nlohmann::json sweep(const std::vector<nlohmann::json>& all_series) {
  nlohmann::json sweep = origin();
  sweep["trace"] = "out/walk.mcap";
  sweep["avatar"] = {{"triangles", 4998}};
  sweep["series"] = all_series;
  return sweep;
}

inline nlohmann::json record(double seconds) {
  nlohmann::json record = origin();
  record["frames"] = 10;
  record["recording_s"] = seconds;
  return record;
}

inline nlohmann::json replay(const char* detector, const nlohmann::json& gl, const char* hash) {
  nlohmann::json replay = origin();
  replay["trace"] = "walk.mcap";
  replay["detector"] = detector;
  replay["method"] = "ccd";
  replay["gl"] = gl;
  replay["frames"] = 10;
  replay["reading_s"] = 2.0;
  replay["texture_hash"] = hash;
  replay["skinning"] = {{"largest_error_of_height", 1e-7}, {"identical_to_cpu", 5}, {"vertices", 5}};
  return replay;
}

inline Result result(const std::string& file, const nlohmann::json& json) {
  return {"/results/" + file, file, json};
}

}  // namespace vestige::test
