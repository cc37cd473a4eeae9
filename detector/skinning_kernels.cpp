#include "detector/skinning.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/skinning_kernels.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 4>;

/// Multiplies in the order of glm's dmat4: ((a0 x + a1 y) + a2 z) + a3 w for each column (x, y, z, w) of `b`.
void multiply_and_round(const glm::dmat4& a, const glm::dmat4& b, const glm::dvec4& offset, SkinMatrix& out) {
  const D d;
  const hn::Rebind<float, D> as_float;
  for (int row = 0; row < 4; row += static_cast<int>(hn::Lanes(d))) {
    const auto column_of = [&](int column) { return hn::LoadU(d, &a[column][row]); };
    const auto a0 = column_of(0);
    const auto a1 = column_of(1);
    const auto a2 = column_of(2);
    const auto a3 = column_of(3);
    for (int column = 0; column < 4; ++column) {
      const glm::dvec4& by = b[column];
      auto sum = hn::Add(hn::Mul(a0, hn::Set(d, by.x)), hn::Mul(a1, hn::Set(d, by.y)));
      sum = hn::Add(hn::Add(sum, hn::Mul(a2, hn::Set(d, by.z))), hn::Mul(a3, hn::Set(d, by.w)));
      if (column == 3) sum = hn::Add(sum, hn::LoadU(d, &offset[row]));
      hn::StoreU(hn::DemoteTo(as_float, sum), as_float, &out.column[static_cast<std::size_t>(column)][row]);
    }
  }
  for (glm::vec4& column : out.column) column.w = 0;
}

void all_entries(const Avatar& avatar, std::span<const glm::dmat4> world, const glm::dvec4& offset_m,
                 std::span<SkinMatrix> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const PaletteEntry& entry = avatar.palette[i];
    multiply_and_round(world[static_cast<std::size_t>(entry.node)], entry.inverse_bind, offset_m, out[i]);
  }
}

/// A blended column must not overflow even if the bind pose is flat: infinity times 0 is not a number, and then nothing
/// is below the limit.
bool largest_reach(std::span<const SkinMatrix> palette, const glm::dvec3& extent_m, double limit_m, glm::dvec4& out) {
  const D d;
  const hn::Rebind<float, D> as_float;
  bool is_below = true;
  for (int row = 0; row < 4; row += static_cast<int>(hn::Lanes(d))) {
    auto all = hn::Zero(d);
    for (const SkinMatrix& matrix : palette) {
      const auto magnitude = [&](std::size_t column) {
        return hn::Abs(hn::PromoteTo(d, hn::LoadU(as_float, &matrix.column[column][row])));
      };
      const auto x = magnitude(0);
      const auto y = magnitude(1);
      const auto z = magnitude(2);
      const auto place = magnitude(3);
      auto reach = hn::Add(hn::Mul(x, hn::Set(d, extent_m.x)), hn::Mul(y, hn::Set(d, extent_m.y)));
      reach = hn::Add(hn::Add(reach, hn::Mul(z, hn::Set(d, extent_m.z))), place);
      is_below = is_below && hn::AllTrue(d, hn::Lt(reach, hn::Set(d, limit_m)));
      all = hn::Max(all, hn::Max(reach, hn::Max(hn::Max(x, y), hn::Max(z, place))));
    }
    hn::StoreU(all, d, &out[row]);
  }
  return is_below && out.x < limit_m && out.y < limit_m && out.z < limit_m;
}

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

HWY_EXPORT(all_entries);
HWY_EXPORT(largest_reach);
HWY_EXPORT(skin_all_vertices);

}  // namespace

void build_palette(const Avatar& avatar, std::span<const glm::dmat4> world, const glm::dvec3& offset_m,
                   std::vector<SkinMatrix>& out) {
  out.resize(avatar.palette.size());
  HWY_DYNAMIC_DISPATCH(all_entries)(avatar, world, glm::dvec4(offset_m, 0), out);
}

std::optional<glm::dvec3> palette_reach_m(std::span<const SkinMatrix> palette, const glm::dvec3& extent_m,
                                          double limit_m) {
  glm::dvec4 reach_m(0);
  if (!HWY_DYNAMIC_DISPATCH(largest_reach)(palette, extent_m, limit_m, reach_m)) return {};
  return glm::dvec3(reach_m);
}

void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::span<glm::vec3> out) {
  HWY_DYNAMIC_DISPATCH(skin_all_vertices)(avatar, palette, out);
}

void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::vector<glm::vec3>& out) {
  out.resize(avatar.position_bind.size());
  skin_vertices(avatar, palette, std::span(out));
}

}  // namespace vestige
#endif
