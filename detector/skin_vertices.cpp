#include "detector/skinning.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/skin_vertices.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Skins one vertex at a time. It computes as many of the 16 numbers of the blended matrix at once as there are lanes.
/// The order of operations on each number is that of `skin_vertex`.
void skin_all_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::span<glm::vec3> out) {
  const hn::CappedTag<float, 16> d;
  alignas(64) std::array<float, 16> blend;
  for (std::size_t vertex = 0; vertex < out.size(); ++vertex) {
    const Influences& influences = avatar.influences[vertex];
    for (std::size_t i = 0; i < blend.size(); i += hn::Lanes(d)) {
      auto sum = hn::Zero(d);
      for (std::size_t k = 0; k < avatar.influence_count; ++k) {
        const float* matrix = &palette[influences.palette[k]].column[0].x;
        sum = hn::Add(sum, hn::Mul(hn::Set(d, influences.weight[k]), hn::LoadU(d, matrix + i)));
      }
      hn::Store(sum, d, &blend[i]);
    }
    const glm::vec3 bind = avatar.position_bind[vertex];
    const auto row = [&](std::size_t i) {
      return ((blend[i] * bind.x + blend[i + 4] * bind.y) + blend[i + 8] * bind.z) + blend[i + 12];
    };
    out[vertex] = {row(0), row(1), row(2)};
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(skin_all_vertices);

}  // namespace

void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::vector<glm::vec3>& out) {
  out.resize(avatar.position_bind.size());
  HWY_DYNAMIC_DISPATCH(skin_all_vertices)(avatar, palette, out);
}

}  // namespace vestige
#endif
