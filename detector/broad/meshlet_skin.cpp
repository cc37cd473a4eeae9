#include "detector/broad/meshlet_skin.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/meshlet_skin.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;

constexpr std::size_t kCorners = 3 * kMeshletTriangles;

/// One row of the blended matrices.
struct BlendedRow {
  hn::Vec<D> x;
  hn::Vec<D> y;
  hn::Vec<D> z;
  hn::Vec<D> offset;
};

/// `row` points at that row's element of the matrix's first column.
HWY_INLINE void blend_in(BlendedRow& blend, hn::Vec<D> weight, const float* row) {
  const D d;
  blend.x = hn::Add(blend.x, hn::Mul(weight, hn::Set(d, row[0])));
  blend.y = hn::Add(blend.y, hn::Mul(weight, hn::Set(d, row[4])));
  blend.z = hn::Add(blend.z, hn::Mul(weight, hn::Set(d, row[8])));
  blend.offset = hn::Add(blend.offset, hn::Mul(weight, hn::Set(d, row[12])));
}

HWY_INLINE hn::Vec<D> times_bind(const BlendedRow& blend, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z) {
  return hn::Add(hn::Add(hn::Add(hn::Mul(blend.x, x), hn::Mul(blend.y, y)), hn::Mul(blend.z, z)), blend.offset);
}

/// Computes `skin_vertex` for all corners of a meshlet. Every vertex is blended over all entries of the meshlet, in
/// ascending order. A weight of 0 adds a zero, which changes no bit of a sum that starts at +0.
void skin_corners(const float* numbers, std::span<const std::uint32_t> entries, const SkinMatrix* palette,
                  MeshletCorners& out) {
  const D d;
  const auto zero = hn::Zero(d);
  for (std::size_t i = 0; i < kCorners; i += hn::Lanes(d)) {
    BlendedRow row_x = {zero, zero, zero, zero};
    BlendedRow row_y = row_x;
    BlendedRow row_z = row_x;
    const float* weights = numbers + 3 * kCorners + i;
    for (const std::uint32_t entry : entries) {
      const auto weight = hn::LoadU(d, weights);
      const float* matrix = &palette[entry].column[0].x;
      blend_in(row_x, weight, matrix);
      blend_in(row_y, weight, matrix + 1);
      blend_in(row_z, weight, matrix + 2);
      weights += kCorners;
    }
    const auto x = hn::LoadU(d, numbers + i);
    const auto y = hn::LoadU(d, numbers + kCorners + i);
    const auto z = hn::LoadU(d, numbers + 2 * kCorners + i);
    float* position = &out.position[0][0][0] + i;
    hn::StoreU(times_bind(row_x, x, y, z), d, position);
    hn::StoreU(times_bind(row_y, x, y, z), d, position + kCorners);
    hn::StoreU(times_bind(row_z, x, y, z), d, position + 2 * kCorners);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(skin_corners);

/// A meshlet with more palette entries is skinned vertex by vertex, because almost all of its weights would be 0.
constexpr std::size_t kMostEntries = 24;

}  // namespace

MeshletSkin::MeshletSkin(const Avatar& avatar, const Meshlets& meshlets) : avatar_(avatar), meshlets_(meshlets) {
  constexpr std::size_t kCorners = 3 * kMeshletTriangles;
  blocks_.resize(meshlets.size());
  for (std::size_t m = 0; m < blocks_.size(); ++m) {
    const std::span<const RestBox> rest = meshlets.rest_boxes(0, m);
    if (rest.empty() || rest.size() > kMostEntries) continue;
    blocks_[m] = {numbers_.size(), entries_.size(), rest.size()};
    for (const RestBox& box : rest) entries_.push_back(box.entry);
    numbers_.resize(numbers_.size() + (3 + rest.size()) * kCorners);
    float* numbers = &numbers_[blocks_[m].first_number];
    const std::span<const std::uint32_t> triangles = meshlets.triangles(m);
    for (std::size_t i = 0; i < kCorners; ++i) {
      const std::size_t triangle = i % kMeshletTriangles < triangles.size() ? i % kMeshletTriangles : 0;
      const std::uint32_t vertex = avatar.triangles[triangles[triangle]][static_cast<int>(i / kMeshletTriangles)];
      for (int axis = 0; axis < 3; ++axis)
        numbers[static_cast<std::size_t>(axis) * kCorners + i] = avatar.position_bind[vertex][axis];
      const Influences& influences = avatar.influences[vertex];
      for (std::size_t k = 0; k < avatar.influence_count; ++k) {
        if (influences.weight[k] == 0) continue;
        const auto place = std::ranges::lower_bound(rest, influences.palette[k], {}, &RestBox::entry);
        numbers[(3 + static_cast<std::size_t>(place - rest.begin())) * kCorners + i] = influences.weight[k];
      }
    }
  }
}

void MeshletSkin::skin(std::size_t meshlet, std::span<const SkinMatrix> palette, MeshletCorners& out) const {
  const Block& block = blocks_[meshlet];
  if (block.entries > 0) {
    HWY_DYNAMIC_DISPATCH(skin_corners)
    (&numbers_[block.first_number], std::span(entries_).subspan(block.first_entry, block.entries), palette.data(), out);
    return;
  }
  const std::span<const std::uint32_t> triangles = meshlets_.triangles(meshlet);
  for (std::size_t i = 0; i < kMeshletTriangles; ++i) {
    const glm::uvec3& corners = avatar_.triangles[triangles[i < triangles.size() ? i : 0]];
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 position = skin_vertex(avatar_, palette, corners[corner]);
      for (int axis = 0; axis < 3; ++axis)
        out.position[static_cast<std::size_t>(axis)][static_cast<std::size_t>(corner)][i] = position[axis];
    }
  }
}

}  // namespace vestige
#endif
