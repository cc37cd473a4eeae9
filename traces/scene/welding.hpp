#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

namespace vestige {

/// Returns, for each of `count` vertices, the first vertex with the same `key(vertex)`, which represents all of them.
/// Keys must have an order.
template <typename Key>
std::vector<std::uint32_t> weld(std::size_t count, const Key& key) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const auto key_a = key(a);
    const auto key_b = key(b);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<std::uint32_t> welded(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool same = i > 0 && key(order[i - 1]) == key(order[i]);
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

/// Returns, for each of these positions, the first one that is equal to it.
template <typename Position>
std::vector<std::uint32_t> weld_places(const std::vector<Position>& positions) {
  return weld(positions.size(), [&](std::uint32_t i) {
    return std::array{positions[i].x, positions[i].y, positions[i].z};
  });
}

}  // namespace vestige
