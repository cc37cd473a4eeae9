#include "traces/scene/subdivision.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

struct Weighted {
  std::uint16_t palette = 0;
  double weight = 0;
};

/// Symmetric in its arguments, because an edge at a seam may be visited in either direction.
Influences mean_of(const Influences& a, const Influences& b) {
  std::vector<Weighted> all;
  all.reserve(2 * kMaxInfluences);
  for (const Influences* one : {&a, &b})
    for (std::size_t k = 0; k < kMaxInfluences; ++k) {
      if (one->weight[k] == 0) continue;
      const auto known = std::ranges::find(all, one->palette[k], &Weighted::palette);
      if (known == all.end()) {
        all.push_back({one->palette[k], static_cast<double>(one->weight[k])});
      } else {
        known->weight += static_cast<double>(one->weight[k]);
      }
    }
  std::ranges::sort(all, [](const Weighted& x, const Weighted& y) {
    return x.weight != y.weight ? x.weight > y.weight : x.palette < y.palette;
  });
  all.resize(std::min(all.size(), kMaxInfluences));
  std::ranges::sort(all, {}, &Weighted::palette);
  double sum = 0;
  for (const Weighted& one : all) sum += one.weight;
  // A weight that rounds to 0 would precede others that do not, and would be counted in their place.
  std::erase_if(all, [sum](const Weighted& one) { return static_cast<float>(one.weight / sum) == 0; });
  Influences mean;
  for (std::size_t k = 0; k < all.size(); ++k) {
    mean.palette[k] = all[k].palette;
    mean.weight[k] = static_cast<float>(all[k].weight / sum);
  }
  return mean;
}

/// Adds the middle of each edge once.
class Middles {
 public:
  explicit Middles(Avatar& avatar) : avatar_(avatar) {}

  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
    const auto [place, is_new] = vertices_.try_emplace(edge, static_cast<std::uint32_t>(avatar_.position_bind.size()));
    if (is_new) add(a, b);
    return place->second;
  }

 private:
  void add(std::uint32_t a, std::uint32_t b) {
    // Halve before adding, because the sum of two huge coordinates may overflow fp32.
    avatar_.position_bind.push_back(0.5F * avatar_.position_bind[a] + 0.5F * avatar_.position_bind[b]);
    avatar_.texture_coordinate.push_back(0.5F * avatar_.texture_coordinate[a] + 0.5F * avatar_.texture_coordinate[b]);
    avatar_.influences.push_back(mean_of(avatar_.influences[a], avatar_.influences[b]));
    const Influences& added = avatar_.influences.back();
    const auto count = static_cast<std::size_t>(std::ranges::count_if(added.weight, [](float w) { return w != 0; }));
    avatar_.influence_count = std::max(avatar_.influence_count, count);
  }

  Avatar& avatar_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

}  // namespace

Avatar subdivided(const Avatar& avatar) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 4;
  if (avatar.triangles.size() > kMost || avatar.position_bind.size() + 3 * avatar.triangles.size() > kMost)
    throw Error("the avatar", "cannot be subdivided: it has too many triangles already", "subdivide it less often");
  Avatar fine = avatar;
  fine.triangles.clear();
  fine.triangles.reserve(4 * avatar.triangles.size());
  Middles middles(fine);
  for (const glm::uvec3& corner : avatar.triangles) {
    const std::uint32_t ab = middles.of(corner.x, corner.y);
    const std::uint32_t bc = middles.of(corner.y, corner.z);
    const std::uint32_t ca = middles.of(corner.z, corner.x);
    fine.triangles.emplace_back(corner.x, ab, ca);
    fine.triangles.emplace_back(ab, corner.y, bc);
    fine.triangles.emplace_back(ca, bc, corner.z);
    fine.triangles.emplace_back(ab, bc, ca);
  }
  return fine;
}

}  // namespace vestige
