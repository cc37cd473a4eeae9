#include "traces/scene/frame_json.hpp"

#include <fmt/format.h>

#include <iterator>

#include "traces/base/number_text.hpp"

namespace vestige {

void append_json(std::string& out, const Pose& pose) {
  out += R"({"origin":)";
  append_json(out, pose.origin_m);
  out += R"(,"nodes":[)";
  for (std::size_t i = 0; i < pose.nodes.size(); ++i) {
    const NodeLocal& node = pose.nodes[i];
    const float numbers[] = {node.translation.x, node.translation.y, node.translation.z, node.rotation.x,
                             node.rotation.y,    node.rotation.z,    node.rotation.w,    node.scale.x,
                             node.scale.y,       node.scale.z};
    out += i == 0 ? "[" : ",[";
    for (std::size_t k = 0; k < std::size(numbers); ++k) {
      if (k > 0) out += ',';
      append_json(out, numbers[k]);
    }
    out += ']';
  }
  out += "]}";
}

void append_json(std::string& out, const std::vector<ColliderSample>& colliders) {
  out += '[';
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    fmt::format_to(std::back_inserter(out), R"({}{{"id":{},"position":)", i == 0 ? "" : ",", colliders[i].id);
    append_json(out, colliders[i].position_m);
    if (colliders[i].radius_m != 0) {
      out += R"(,"radius":)";
      append_json(out, colliders[i].radius_m);
    }
    if (colliders[i].owner != kNobody) fmt::format_to(std::back_inserter(out), R"(,"owner":{})", colliders[i].owner);
    out += '}';
  }
  out += ']';
}

}  // namespace vestige
