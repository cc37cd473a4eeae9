#include "traces/base/strict_json.hpp"

#include <fmt/format.h>

#include <set>
#include <string>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

nlohmann::json parse_strict_json(std::string_view text, std::string_view name, std::string_view remedy) {
  using nlohmann::json;
  std::vector<std::set<std::string>> names;  // one set for each open object
  const auto check = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) names.emplace_back();
    if (event == json::parse_event_t::object_end) names.pop_back();
    if (event == json::parse_event_t::key && !names.back().insert(parsed.get<std::string>()).second)
      throw Error(name, fmt::format("an object has '{}' twice", parsed.get<std::string>()), "remove one of them");
    return true;
  };
  try {
    return json::parse(text, check);
  } catch (const json::parse_error& error) {
    throw Error(fmt::format("{}, byte {}", name, error.byte), "is not JSON from this byte on", remedy);
  } catch (const json::exception&) {
    throw Error(name, "is not readable JSON", remedy);
  }
}

}  // namespace vestige
