#include "traces/live/live_ndjson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "traces/base/nanoseconds.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/scene/radius.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using Json = nlohmann::json;
/// Numbers are read directly as floats, because some would be rounded twice by way of double.
using FloatJson = nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

constexpr std::size_t kMostLineBytes = std::size_t{64} << 20;
constexpr std::size_t kMostBadLinesTold = 10;
constexpr std::size_t kDeepestJson = 128;  ///< nesting
constexpr double kMost_s = 9e9;            ///< limit of nanoseconds in 63 bits

std::map<std::string, std::size_t, std::less<>> nodes_by_name(const Avatar& avatar) {
  std::map<std::string, std::size_t, std::less<>> nodes;
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) nodes.emplace(avatar.nodes[i].name, i);
  return nodes;
}

/// Returns how deep arrays and objects are nested in JSON text, without parsing it; any number if the text is not JSON.
/// Nlohmann's library parses any depth, but copies by recursion.
std::size_t depth_of(std::string_view text) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char character = text[i];
    if (is_string) {
      if (character == '\\') ++i;
      if (character == '"') is_string = false;
    } else if (character == '"') {
      is_string = true;
    } else if (character == '[' || character == '{') {
      deepest = std::max(deepest, ++depth);
    } else if ((character == ']' || character == '}') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

template <typename Number, typename AnyJson>
Number number_of(const AnyJson& json, std::string_view name) {
  constexpr Number kInfinity = std::numeric_limits<Number>::infinity();
  if (json.is_number()) {
    const auto number = json.template get<Number>();
    if (!std::isfinite(number)) throw Malformed(fmt::format("'{}' has a number that does not fit into a float", name));
    return number;
  }
  if (json.is_string()) {
    const auto& text = json.template get_ref<const std::string&>();
    if (text == "nan") return std::numeric_limits<Number>::quiet_NaN();
    if (text == "inf") return kInfinity;
    if (text == "-inf") return -kInfinity;
  }
  throw Malformed(fmt::format("'{}' has {} instead of a number", name, json.type_name()));
}

template <typename AnyJson>
void require_array(const AnyJson& json, std::size_t size, std::string_view name) {
  if (!json.is_array() || json.size() != size) throw Malformed(fmt::format("'{}' is not an array of {}", name, size));
}

glm::dvec3 position_of(const Json& json, std::string_view name) {
  require_array(json, 3, name);
  return {number_of<double>(json[0], name), number_of<double>(json[1], name), number_of<double>(json[2], name)};
}

glm::vec3 vector_of(const FloatJson& json, std::size_t at, std::string_view name) {
  return {number_of<float>(json[at], name), number_of<float>(json[at + 1], name), number_of<float>(json[at + 2], name)};
}

glm::quat rotation_of(const FloatJson& json, std::size_t at, std::string_view name) {
  const glm::vec3 xyz = vector_of(json, at, name);
  return {number_of<float>(json[at + 3], name), xyz.x, xyz.y, xyz.z};
}

std::uint32_t id_of(const Json& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw Malformed("a collider's id is not a whole number of 32 bits");
  return json.get<std::uint32_t>();
}

/// Reads the line again, with floats in place of doubles. If a position exceeds float, the line is converted from
/// double instead. That rounds about one in some hundred million numbers twice, by one bit, which hardly matters so far
/// out.
FloatJson in_floats(std::string_view line, const Json& json) {
  try {
    return FloatJson::parse(line);
  } catch (const nlohmann::json::exception&) {
    return FloatJson(json);
  }
}

void read_nodes(const FloatJson& nodes, Pose& pose) {
  require_array(nodes, pose.nodes.size(), "nodes");
  for (std::size_t i = 0; i < pose.nodes.size(); ++i) {
    require_array(nodes[i], 10, fmt::format("nodes[{}]", i));
    pose.nodes[i] = {.translation = vector_of(nodes[i], 0, "nodes"),
                     .rotation = rotation_of(nodes[i], 3, "nodes"),
                     .scale = vector_of(nodes[i], 7, "nodes")};
  }
}

void read_joint(const FloatJson& joint, NodeLocal& node) {
  if (!joint.is_object()) throw Malformed("a joint is not an object");
  if (const auto t = joint.find("t"); t != joint.end()) {
    require_array(*t, 3, "t");
    node.translation = vector_of(*t, 0, "t");
  }
  if (const auto r = joint.find("r"); r != joint.end()) {
    require_array(*r, 4, "r");
    node.rotation = rotation_of(*r, 0, "r");
  }
  if (const auto s = joint.find("s"); s != joint.end()) {
    require_array(*s, 3, "s");
    node.scale = vector_of(*s, 0, "s");
  }
}

float radius_of(const Json& collider, const FloatJson& in_float) {
  const auto radius_m = number_of<double>(collider["radius"], "radius");
  if (const std::string_view fault = radius_fault(radius_m); !fault.empty())
    throw Malformed(fmt::format("a collider's radius, {} m, {}", radius_m, fault));
  return number_of<float>(in_float["radius"], "radius");
}

/// Lines are of one person. Of several, somebody would be left out, and limbs would touch the person they belong to.
constexpr std::string_view kOnePerson = "lines are of one person; of several, 'vestige import' reads .h5 and folders";

void refuse_other_poses(const Json& line) {
  for (const auto& [name, value] : line.items())
    if (name.starts_with("pose."))
      throw Malformed(fmt::format("has '{}', the pose of another person: {}", name, kOnePerson));
}

void refuse_owner(const Json& collider) {
  const auto owner = collider.find("owner");
  if (owner != collider.end() && *owner != 0)
    throw Malformed(fmt::format("has a collider with an owner: {}", kOnePerson));
}

/// `floats` returns the whole line in floats, which takes as long as reading it.
template <typename Floats>
std::vector<ColliderSample> colliders_of(const Json& json, const Floats& floats) {
  if (!json.is_array()) throw Malformed("'colliders' is not an array");
  std::vector<ColliderSample> colliders;
  colliders.reserve(json.size());
  for (const Json& one : json) {
    if (!one.is_object() || !one.contains("id") || !one.contains("position"))
      throw Malformed("a collider has no id or no position");
    refuse_owner(one);
    colliders.push_back({.id = id_of(one["id"]), .position_m = position_of(one["position"], "position")});
    if (one.contains("radius")) colliders.back().radius_m = radius_of(one, floats()["colliders"][colliders.size() - 1]);
  }
  std::vector<std::uint32_t> ids;
  ids.reserve(colliders.size());
  for (const ColliderSample& collider : colliders) ids.push_back(collider.id);
  std::sort(ids.begin(), ids.end());
  if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end())
    throw Malformed(fmt::format("it has collider {} twice", *twice));
  return colliders;
}

std::vector<std::uint32_t> teleported_of(const Json& json) {
  if (!json.is_array()) throw Malformed("'teleported' is not an array");
  std::vector<std::uint32_t> ids;
  for (const Json& id : json) ids.push_back(id_of(id));
  return ids;
}

std::int64_t time_of(const Json& json, std::int64_t last_ns) {
  const auto time_s = number_of<double>(json, "time_s");
  if (!(time_s >= 0 && time_s < kMost_s))
    throw Malformed(fmt::format("'time_s' is {}, which is not from 0 to 9e9", time_s));
  const std::int64_t time_ns = std::llround(time_s * kNanosecondsPerSecond);
  if (time_ns < last_ns)
    throw Malformed(fmt::format("'time_s' is {}, which is earlier than in the line before", time_s));
  return time_ns;
}

}  // namespace

LiveNdjson::LiveNdjson(const Avatar& avatar)
    : node_of_(nodes_by_name(avatar)), rest_(rest_pose(avatar)), pose_(rest_) {}

void LiveNdjson::leave_out(std::string_view cause) {
  ++malformed_;
  if (problems_.size() < kMostBadLinesTold) problems_.push_back(fmt::format("line {}: {}", lines_, cause));
}

template <typename AnyJson>
void LiveNdjson::note_unknown(const AnyJson& object, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : object.items()) {
    if (std::find(known.begin(), known.end(), name) != known.end() || unknown_.size() >= kMostBadLinesTold) continue;
    if (unknown_.insert(name).second)
      problems_.push_back(fmt::format("line {}: '{}' is unknown and is ignored; the known names are {}", lines_, name,
                                      fmt::join(known, ", ")));
  }
}

void LiveNdjson::push(std::string_view bytes, std::int64_t now_ns, const TakeFrame& take) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, end);
    bytes.remove_prefix(std::min(bytes.size(), end == std::string_view::npos ? end : end + 1));
    if (line_.size() + piece.size() > kMostLineBytes) too_long_ = true;
    if (end == std::string_view::npos) {
      if (too_long_) {
        line_.clear();
      } else {
        line_ += piece;
      }
      return;
    }
    ++lines_;
    if (too_long_) {
      leave_out("is longer than 64 MiB");
    } else if (line_.empty()) {
      take_line(piece, now_ns, take);
    } else {
      line_ += piece;
      take_line(line_, now_ns, take);
    }
    line_.clear();
    too_long_ = false;
  }
}

void LiveNdjson::finish(std::int64_t now_ns, const TakeFrame& take) {
  if (line_.empty() && !too_long_) return;
  push("\n", now_ns, take);
}

void LiveNdjson::take_line(std::string_view line, std::int64_t now_ns, const TakeFrame& take) {
  if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
  try {
    if (depth_of(line) > kDeepestJson) throw Malformed(fmt::format("is nested deeper than {} levels", kDeepestJson));
    const Json json = Json::parse(line);
    if (!json.is_object()) throw Malformed("is not a JSON object");
    refuse_other_poses(json);
    note_unknown(json, {"frame", "time_s", "pose", "colliders", "teleported"});
    TraceFrame frame;
    frame.index = next_index_;
    if (const auto number = json.find("frame"); number != json.end()) {
      if (!number->is_number_unsigned()) throw Malformed("'frame' is not a whole number");
      frame.index = number->get<std::uint64_t>();
      if (frame.index < next_index_) throw Malformed(fmt::format("frame {} comes twice or too late", frame.index));
    }
    if (frame.index > std::numeric_limits<std::uint32_t>::max())
      throw Malformed("its frame number has more than 32 bits");
    const auto time = json.find("time_s");
    frame.time_ns = time == json.end() ? std::max(now_ns, last_ns_) : time_of(*time, last_ns_);
    frame.poses.front() = pose_;
    std::optional<FloatJson> read_floats;
    const auto floats = [&]() -> FloatJson& {
      return read_floats ? *read_floats : read_floats.emplace(in_floats(line, json));
    };
    if (const auto pose = json.find("pose"); pose != json.end()) {
      if (!pose->is_object()) throw Malformed("'pose' is not an object");
      note_unknown(*pose, {"origin", "nodes", "joints"});
      frame.poses.front().origin_m =
          pose->contains("origin") ? position_of((*pose)["origin"], "origin") : glm::dvec3(0);
      const FloatJson& in_float = floats()["pose"];
      if (const auto nodes = in_float.find("nodes"); nodes != in_float.end()) {
        read_nodes(*nodes, frame.poses.front());
      } else if (const auto joints = in_float.find("joints"); joints != in_float.end() && joints->is_object()) {
        frame.poses.front().nodes = rest_.nodes;
        for (const auto& [name, joint] : joints->items()) {
          const auto node = node_of_.find(name);
          if (node == node_of_.end()) throw Malformed(fmt::format("the avatar has no node '{}'", name));
          note_unknown(joint, {"t", "r", "s"});
          read_joint(joint, frame.poses.front().nodes[node->second]);
        }
      } else {
        throw Malformed("'pose' has neither 'nodes' nor 'joints'");
      }
    }
    if (const auto colliders = json.find("colliders"); colliders != json.end()) {
      frame.colliders = colliders_of(*colliders, floats);
      for (const Json& collider : *colliders) note_unknown(collider, {"id", "position", "radius", "owner"});
    }
    if (const auto teleported = json.find("teleported"); teleported != json.end())
      frame.teleported = teleported_of(*teleported);
    pose_ = frame.poses.front();
    last_ns_ = frame.time_ns;
    next_index_ = frame.index + 1;
    take(std::move(frame));
  } catch (const Malformed& malformed) {
    leave_out(malformed.what());
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: …": the number is the library's own.
    const std::string_view text = error.what();
    const std::size_t after_number = text.find("] ");
    leave_out(fmt::format("is not JSON: {}", after_number == text.npos ? text : text.substr(after_number + 2)));
  }
}

}  // namespace vestige
