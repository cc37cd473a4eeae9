#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace vestige {

/// JSON that a person has written (RFC 8259). `Error` at the byte where it ends to be JSON, and where an object has a
/// name twice, since only one of the two could be meant; `name` is said of what, `remedy` what to write instead.
nlohmann::json parse_strict_json(std::string_view text, std::string_view name, std::string_view remedy);

}  // namespace vestige
