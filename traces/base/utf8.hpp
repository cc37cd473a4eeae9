#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vestige {

/// The length of the UTF-8 sequence (RFC 3629) that `text` starts with, 0 where it is none.
std::size_t utf8_length(std::string_view text);

/// `text` with U+FFFD in place of each byte that is no UTF-8: file names may be anything, JSON and MCAP may not.
std::string valid_utf8(std::string_view text);

}  // namespace vestige
