#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace vestige {

/// Parses JSON that a person wrote (RFC 8259). Throws `Error` at the byte where the text stops being JSON. Also throws
/// if an object has a name twice, because only one of the two can be meant. Errors mention `name` as the source of the
/// text and `remedy` as the advice.
nlohmann::json parse_strict_json(std::string_view text, std::string_view name, std::string_view remedy);

}  // namespace vestige
