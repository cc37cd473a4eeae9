#include "traces/trace_file/trace_nodes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "traces/mcap/decode.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

std::optional<std::vector<std::string>> parse_node_names(const mcap::Channel& pose_channel) {
  const auto entry = pose_channel.metadata.find(std::string(trace_format::kNodesKey));
  const auto names =
      entry == pose_channel.metadata.end() ? nlohmann::json() : nlohmann::json::parse(entry->second, nullptr, false);
  const auto is_text = [](const nlohmann::json& name) { return name.is_string(); };
  if (!names.is_array() || !std::all_of(names.begin(), names.end(), is_text)) return {};
  return names.get<std::vector<std::string>>();
}

std::optional<std::size_t> glb_node_count(std::span<const std::byte> glb) {
  constexpr std::size_t kHeaderBytes = 12;
  try {
    mcap::Cursor cursor(glb);
    cursor.bytes(kHeaderBytes);
    const auto length = cursor.number<std::uint32_t>();
    cursor.number<std::uint32_t>();
    const mcap::Bytes text = cursor.bytes(length);
    const auto* begin = reinterpret_cast<const char*>(text.data());
    const auto document = nlohmann::json::parse(begin, begin + text.size(), nullptr, false);
    if (!document.is_object()) return {};
    const auto nodes = document.find("nodes");
    if (nodes == document.end() || !nodes->is_array()) return 0;
    return nodes->size();
  } catch (const mcap::Malformed&) {
    return {};
  }
}

}  // namespace vestige
