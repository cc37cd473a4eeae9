#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>

namespace vestige {

// Numbers as text. The functions that append to `out` write the shortest text that reads back to the same bits.

/// Appends a JSON value. Negative zero is -0.0. NaN and infinities are the strings "nan", "inf" and "-inf".
void append_json(std::string& out, float value);
void append_json(std::string& out, double value);
void append_json(std::string& out, const glm::dvec3& vector);

/// Appends nanoseconds as an exact decimal number of seconds: 1500000 is 0.0015.
void append_seconds(std::string& out, std::int64_t time_ns);

/// Converts seconds to nanoseconds, rounded to the nearest; exact below 2^52 ns (52 days). Precondition:
/// time_s
///  < 9e9.
std::int64_t nanoseconds_of(double time_s);

/// Returns a share in per cent with two digits: 0.0123 is "1.2", 0.5 is "50", 1 is "100".
std::string percent_text(double share);

/// "1 trace", "4 traces"
std::string counted(std::uint64_t count, std::string_view thing);

/// "a, b and c"
std::string listed(std::span<const std::string> words);

}  // namespace vestige
