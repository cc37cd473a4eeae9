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

/// Skins one vertex at a time, a column of the blended matrix in each vector. The order of operations on each number is
/// that of `skin_vertex`. An influence without weight is left out: it would add a zero, which changes no bit of a sum
/// that starts at +0. All numbers of the palette must be finite.
void skin_all_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::span<glm::vec3> out) {
  const hn::CappedTag<float, 4> d;
  alignas(16) std::array<float, 4> position;
  for (std::size_t vertex = 0; vertex < out.size(); ++vertex) {
    const Influences& influences = avatar.influences[vertex];
    const glm::vec3 bind = avatar.position_bind[vertex];
    for (std::size_t row = 0; row < position.size(); row += hn::Lanes(d)) {
      auto x = hn::Zero(d);
      auto y = x;
      auto z = x;
      auto offset = x;
      for (std::size_t k = 0; k < avatar.influence_count; ++k) {
        if (influences.weight[k] == 0) continue;
        const auto weight = hn::Set(d, influences.weight[k]);
        const float* matrix = &palette[influences.palette[k]].column[0].x + row;
        x = hn::Add(x, hn::Mul(weight, hn::LoadU(d, matrix)));
        y = hn::Add(y, hn::Mul(weight, hn::LoadU(d, matrix + 4)));
        z = hn::Add(z, hn::Mul(weight, hn::LoadU(d, matrix + 8)));
        offset = hn::Add(offset, hn::Mul(weight, hn::LoadU(d, matrix + 12)));
      }
      const auto sum = hn::Add(hn::Mul(x, hn::Set(d, bind.x)), hn::Mul(y, hn::Set(d, bind.y)));
      hn::Store(hn::Add(hn::Add(sum, hn::Mul(z, hn::Set(d, bind.z))), offset), d, &position[row]);
    }
    out[vertex] = {position[0], position[1], position[2]};
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

void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::span<glm::vec3> out) {
  HWY_DYNAMIC_DISPATCH(skin_all_vertices)(avatar, palette, out);
}

void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::vector<glm::vec3>& out) {
  out.resize(avatar.position_bind.size());
  skin_vertices(avatar, palette, std::span(out));
}

}  // namespace vestige
#endif
