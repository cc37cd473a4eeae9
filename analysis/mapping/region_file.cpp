#include "analysis/mapping/region_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "traces/base/strict_json.hpp"

namespace vestige {

namespace {

using nlohmann::json;

constexpr std::size_t kMostActuators = 65534;  // an ActuatorMap's
constexpr std::size_t kMostShown = 40;

std::string list_of(std::vector<std::string> names) {
  std::ranges::sort(names);
  const std::size_t shown = std::min(names.size(), kMostShown);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// Reads the fields of one JSON object. Errors name the object's place.
class Fields {
 public:
  Fields(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) throw Error(where_, "is not an object", R"(write {"name": …})");
  }

  const std::string& where() const { return where_; }

  void allow(const std::vector<std::string>& known) const {
    for (const auto& [key, value] : object_.items())
      if (std::ranges::find(known, key) == known.end()) throw UnknownName(where_, "field", key, known);
  }
  bool has(const char* key) const { return object_.contains(key); }
  const json& at(const char* key) const { return object_[key]; }

  [[noreturn]] void refuse(const char* key, const char* what, const char* example) const {
    throw Error(where_, fmt::format("'{}' {}", key, what), fmt::format("write \"{}\": {}", key, example));
  }

  std::string text(const char* key, const char* example) const {
    if (!has(key)) throw Error(where_, fmt::format("has no '{}'", key), fmt::format("write \"{}\": {}", key, example));
    if (!at(key).is_string() || at(key).get<std::string>().empty()) refuse(key, "is not a text", example);
    auto text = at(key).get<std::string>();
    const auto is_control = [](char letter) { return static_cast<unsigned char>(letter) < ' '; };
    if (std::ranges::any_of(text, is_control)) refuse(key, "holds a control character", example);
    return text;
  }

  /// Returns one text, or a list of texts; empty if there is none.
  std::vector<std::string> texts(const char* key, const char* example) const {
    if (!has(key)) return {};
    const json& value = at(key);
    std::vector<std::string> found;
    const auto add = [&](const json& item) {
      if (!item.is_string() || item.get<std::string>().empty())
        refuse(key, "is neither a text nor a list of texts", example);
      found.push_back(item.get<std::string>());
    };
    if (!value.is_array()) {
      add(value);
      return found;
    }
    for (const json& item : value) add(item);
    if (found.empty()) refuse(key, "is an empty list", example);
    return found;
  }

  double number(const char* key, const char* example) const {
    if (!has(key) || !is_finite(at(key))) refuse(key, "is not a number", example);
    return at(key).get<double>();
  }

  std::size_t count(const char* key, const char* example) const {
    if (!has(key) || !at(key).is_number_unsigned() || at(key).get<std::uint64_t>() == 0 ||
        at(key).get<std::uint64_t>() > kMostActuators)
      refuse(key, "is not a whole number from 1 to 65534", example);
    return at(key).get<std::size_t>();
  }

  std::optional<Extent> interval(const char* key, double least, double most, const char* example) const {
    if (!has(key)) return std::nullopt;
    const json& value = at(key);
    if (!value.is_array() || value.size() != 2 || !std::ranges::all_of(value, is_finite))
      refuse(key, "is not two numbers", example);
    const Extent interval = {value[0].get<double>(), value[1].get<double>()};
    if (!(interval.low < interval.high)) refuse(key, "does not go from the lower number to the higher", example);
    if (interval.low < least || interval.high > most)
      refuse(key, fmt::format("is not within {} and {}", least, most).c_str(), example);
    return interval;
  }

  static bool is_finite(const json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

 private:
  const json& object_;
  std::string where_;
};

RegionGrid parse_grid(const Fields& region) {
  const Fields fields(region.at("grid"), region.where() + ", grid");
  fields.allow({"rows", "columns", "names"});
  RegionGrid grid;
  grid.rows = fields.count("rows", "5");
  grid.columns = fields.count("columns", "4");
  grid.names = fields.texts("names", R"(["upper right", …])");
  if (grid.rows * grid.columns > kMostActuators)
    throw Error(fields.where(), "has more than 65534 actuators", "write fewer rows or columns");
  if (!grid.names.empty() && grid.names.size() != grid.rows * grid.columns)
    throw Error(fields.where(),
                fmt::format("has {} names for {} actuators", grid.names.size(), grid.rows * grid.columns),
                "name each, row by row from the top, or leave 'names' out");
  return grid;
}

std::vector<RegionActuator> parse_actuators(const Fields& region) {
  constexpr const char* kExample = R"([{"name": "heart", "position_m": [0.05, 1.3, 0.1]}])";
  const json& list = region.at("actuators");
  if (!list.is_array() || list.empty()) region.refuse("actuators", "is not a list of actuators", kExample);
  std::vector<RegionActuator> actuators;
  for (const json& item : list) {
    const Fields fields(item, fmt::format("{}, actuators[{}]", region.where(), actuators.size()));
    fields.allow({"name", "position_m", "height", "angle"});
    RegionActuator actuator;
    actuator.name = fields.text("name", R"("heart")");
    const bool by_angle = fields.has("height") || fields.has("angle");
    if (fields.has("position_m") == by_angle)
      throw Error(fields.where(), "needs either 'position_m', or 'height' and 'angle'",
                  R"(write "position_m": [0.05, 1.3, 0.1], or "height": 0.5, "angle": 0)");
    if (by_angle) {
      actuator.height = fields.number("height", "0.5");
      actuator.angle_degrees = fields.number("angle", "0");
    } else {
      const json& p = fields.at("position_m");
      if (!p.is_array() || p.size() != 3 || !std::ranges::all_of(p, Fields::is_finite))
        fields.refuse("position_m", "is not three finite numbers", "[0.05, 1.3, 0.1]");
      actuator.position_m = glm::dvec3(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
    }
    actuators.push_back(std::move(actuator));
  }
  return actuators;
}

RegionSpec parse_region(const json& item, const std::string& where) {
  const Fields fields(item, where);
  fields.allow(
      {"name", "part", "joints", "below", "height", "height_m", "angle", "side", "grid", "actuators", "radius_m"});
  RegionSpec region;
  region.name = fields.text("name", R"("chest left")");
  region.parts = fields.texts("part", R"("torso")");
  region.joints = fields.texts("joints", R"(["spine*"])");
  region.below = fields.texts("below", R"(["upper_arm_left"])");
  region.height = fields.interval("height", 0, 1,
                                  "[0.5, 1], which are shares of the height of the skin that 'part', 'joints' or "
                                  "'below' choose: 0 is its lowest point, 1 its highest; 'height_m' takes metres");
  region.height_m = fields.interval("height_m", -1e9, 1e9, "[1.1, 1.3]");
  region.angle_degrees = fields.interval("angle", -360, 720, "[-45, 45]");
  if (region.angle_degrees && region.angle_degrees->high - region.angle_degrees->low > 360)
    fields.refuse("angle", "is more than a full turn", "[0, 360]");
  if (region.height && region.height_m) throw Error(where, "has both 'height' and 'height_m'", "leave one of them out");
  region.sides = fields.texts("side", R"("front")");
  const std::vector<std::string> sides = {"front", "back", "left", "right"};
  for (const std::string& side : region.sides)
    if (std::ranges::find(sides, side) == sides.end()) throw UnknownName(where, "side", side, sides);
  if (fields.has("grid") && fields.has("actuators"))
    throw Error(where, "has both 'grid' and 'actuators'", "leave one of them out");
  if (fields.has("grid")) region.grid = parse_grid(fields);
  if (fields.has("actuators")) region.actuators = parse_actuators(fields);
  if (fields.has("radius_m")) {
    region.radius_m = fields.number("radius_m", "0.06");
    if (!(*region.radius_m > 0)) fields.refuse("radius_m", "is not above 0", "0.06");
    if (region.actuators.empty())
      throw Error(where, "has a 'radius_m', but no 'actuators'", "list the actuators, or leave 'radius_m' out");
  }
  return region;
}

}  // namespace

UnknownName::UnknownName(std::string_view where, std::string_view what, std::string word,
                         std::vector<std::string> known)
    : Error(where, fmt::format("there is no {} '{}'", what, word), fmt::format("there are: {}", list_of(known))),
      where_(where),
      what_(what),
      word_(std::move(word)),
      known_(std::move(known)) {}

Error UnknownName::with_hint(const std::string& hint) const {
  return {where_, fmt::format("there is no {} '{}'", what_, word_),
          fmt::format("{}there are: {}", hint, list_of(known_))};
}

std::vector<RegionSpec> parse_region_file(std::string_view json_text, std::string_view name) {
  constexpr const char* kRemedy = R"(write {"regions": [{"name": "chest", "part": "torso", "side": "front"}]})";
  const json document = parse_strict_json(json_text, name, kRemedy);
  if (!document.is_object() || !document.contains("regions") || !document["regions"].is_array() ||
      document["regions"].empty())
    throw Error(name, "has no list 'regions'", kRemedy);
  for (const auto& [key, value] : document.items())
    if (key != "regions" && key != "fires") throw UnknownName(name, "field", key, {"regions", "fires"});
  std::vector<RegionSpec> regions;
  for (const json& item : document["regions"])
    regions.push_back(parse_region(item, fmt::format("{}, regions[{}]", name, regions.size())));
  return regions;
}

std::string fires_of_region_file(std::string_view json_text) {
  const nlohmann::ordered_json document = nlohmann::ordered_json::parse(json_text);
  return document.contains("fires") ? document["fires"].dump() : std::string();
}

}  // namespace vestige
