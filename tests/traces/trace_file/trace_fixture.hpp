#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige::test {

/// A skeleton of `nodes` nodes; nothing else of an avatar goes into a trace's messages.
inline Avatar skeleton(std::size_t nodes) {
  Avatar avatar;
  for (std::size_t i = 0; i < nodes; ++i) {
    Node& node = avatar.nodes.emplace_back();
    node.name = fmt::format("node {} \"\xC3\xA9\"", i);
    node.parent = static_cast<int>(i) - 1;
    avatar.node_order.push_back(static_cast<int>(i));
  }
  return avatar;
}

/// The smallest binary glTF file with that many nodes.
inline std::vector<std::byte> skeleton_glb(std::size_t nodes) {
  std::string json = R"({"asset":{"version":"2.0"},"nodes":[)";
  for (std::size_t i = 0; i < nodes; ++i) json += i == 0 ? "{}" : ",{}";
  json += "]}";
  while (json.size() % 4 != 0) json += ' ';
  const auto json_bytes = static_cast<std::uint32_t>(json.size());
  const std::uint32_t head[] = {0x46546C67, 2, 20 + json_bytes, json_bytes, 0x4E4F534A};
  std::vector<std::byte> glb(sizeof head + json.size());
  std::memcpy(glb.data(), head, sizeof head);
  std::memcpy(glb.data() + sizeof head, json.data(), json.size());
  return glb;
}

/// Frame `index` of a motion in which no two numbers are alike and none is round.
inline TraceFrame frame(std::uint64_t index, std::size_t nodes, std::size_t colliders) {
  TraceFrame frame;
  frame.index = index;
  frame.time_ns = static_cast<std::int64_t>(index) * 1'000'003;
  const double phase = 0.1 + 0.37 * static_cast<double>(index);
  frame.poses.front().origin_m = {1e7 + phase, -phase / 3, phase / 7};
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto value = static_cast<float>(phase / (3.1 + static_cast<double>(i)));
    frame.poses.front().nodes.push_back({.translation = {value, -value, value / 3},
                                         .rotation = glm::normalize(glm::quat(1 - value, value, value / 5, -value / 7)),
                                         .scale = {1 + value, 1, 1 - value}});
  }
  for (std::size_t i = 0; i < colliders; ++i) {
    const double value = phase / (1.7 + static_cast<double>(i));
    frame.colliders.push_back(
        {.id = static_cast<std::uint32_t>(7 * i + 3), .position_m = {value, -value / 3, 1e6 + value}});
  }
  return frame;
}

inline bool same_bits(const glm::dvec3& a, const glm::dvec3& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

inline bool same_bits(const TraceFrame& a, const TraceFrame& b) {
  const auto equal_arrays = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
  };
  if (a.index != b.index || a.time_ns != b.time_ns || a.teleported != b.teleported) return false;
  if (a.poses.size() != b.poses.size() || a.colliders.size() != b.colliders.size()) return false;
  for (std::size_t k = 0; k < a.poses.size(); ++k)
    if (!same_bits(a.poses[k].origin_m, b.poses[k].origin_m) || !equal_arrays(a.poses[k].nodes, b.poses[k].nodes))
      return false;
  for (std::size_t i = 0; i < a.colliders.size(); ++i) {
    if (a.colliders[i].id != b.colliders[i].id || a.colliders[i].owner != b.colliders[i].owner) return false;
    if (!same_bits(a.colliders[i].position_m, b.colliders[i].position_m)) return false;
    if (std::bit_cast<std::uint32_t>(a.colliders[i].radius_m) != std::bit_cast<std::uint32_t>(b.colliders[i].radius_m))
      return false;
  }
  return true;
}

/// Chunks are closed by size only, so that files do not depend on how fast the machine is.
inline TraceWriterOptions steady_options(std::size_t chunk_bytes = std::size_t{1} << 20) {
  return {.chunk_bytes = chunk_bytes, .chunk_s = 1e9};
}

inline constexpr std::size_t kNodes = 3;
inline constexpr std::size_t kColliders = 2;

/// A finished trace of `frames` frames.
inline void write_trace(const std::filesystem::path& path, std::uint64_t frames, const TraceWriterOptions& options) {
  const std::vector<std::byte> glb = skeleton_glb(kNodes);
  TraceWriter writer(path, {{"argv", "test"}}, {{skeleton(kNodes), {.avatar_glb = glb, .actuator_map_json = "{}"}}},
                     options);
  for (std::uint64_t i = 0; i < frames; ++i) writer.write(frame(i, kNodes, kColliders));
  writer.finish();
}

inline std::vector<TraceFrame> read_frames(TraceReader& reader) {
  std::vector<TraceFrame> frames;
  TraceFrame next;
  while (reader.next(next)) frames.push_back(next);
  return frames;
}

}  // namespace vestige::test
