#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vestige {

/// Returns the length of the UTF-8 sequence (RFC 3629) at the start of `text`, or 0 if there is no valid one.
std::size_t utf8_length(std::string_view text);

/// Returns `text` with each byte that is not valid UTF-8 replaced by U+FFFD. File names may hold any bytes, JSON and
/// MCAP strings may not.
std::string valid_utf8(std::string_view text);

/// Returns the length of the control character or line separator at the start of `text`, or 0 if there is none.
std::size_t control_length(std::string_view text);

/// Returns `text` as valid UTF-8 with each control character and line separator replaced by a space, so that it can be
/// printed in a line.
std::string in_one_line(std::string_view text);

}  // namespace vestige
