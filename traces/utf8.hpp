#pragma once

#include <cstddef>
#include <string_view>

namespace vestige {

/// The length of the UTF-8 sequence (RFC 3629) that `text` starts with, 0 where it is none.
std::size_t utf8_length(std::string_view text);

}  // namespace vestige
