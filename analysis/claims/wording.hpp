#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "traces/base/number_text.hpp"

namespace vestige {

/// Returns "14 million" for 14000000, and other numbers as they are.
std::string in_words(std::uint64_t count);

/// Returns a duration with three digits: "9.80 µs", "113 µs", "5.52 ms", "4.89 s".
std::string duration(double microseconds);

enum class ContextName { kSaid, kLeftOut };

/// Returns " on llvmpipe (software, egl-surfaceless)" for an object with `renderer` and `context`, or "" for anything
/// else. Software renderers say so, wherever they are named.
std::string on_renderer(const nlohmann::json& gl, ContextName context = ContextName::kLeftOut);

/// Returns the context that all series of a result share, or "" if they have none, or several.
std::string shared_context(const nlohmann::json& series);

/// Returns the `gl` of a result if this detector uses OpenGL, otherwise null. Returns an object that says so if the
/// detector uses OpenGL and the result does not know its renderer.
nlohmann::json gl_used_by(const std::string& detector, const nlohmann::json& gl);

/// Returns " (approximate)" or " (approximate, 500 triangles)" for a series whose detector is, otherwise "".
std::string approximate_words(const nlohmann::json& series);

/// A detector, and " on …" as on_renderer() says it.
using DetectorOnRenderer = std::pair<std::string, std::string>;

/// Returns "`paper` and `geometry` on llvmpipe (software, osmesa), `cpu` and `embree`": those with OpenGL first.
std::string listed(const std::vector<DetectorOnRenderer>& contestants);

/// Returns the file name of a path, as code.
std::string file_name(const nlohmann::json& path);

}  // namespace vestige
