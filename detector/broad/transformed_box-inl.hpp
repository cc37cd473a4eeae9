// This file is included once for each instruction set, after hwy/highway.h. So the include guard follows Highway's
// pattern.
#if defined(VESTIGE_TRANSFORMED_BOX_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VESTIGE_TRANSFORMED_BOX_INL
#undef VESTIGE_TRANSFORMED_BOX_INL
#else
#define VESTIGE_TRANSFORMED_BOX_INL
#endif

#include <glm/vec4.hpp>

#include "detector/broad/meshlets.hpp"

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

using BoxTag = hwy::HWY_NAMESPACE::CappedTag<float, 4>;

/// The centre and the half extent of a box along some axes.
struct TransformedBox {
  hwy::HWY_NAMESPACE::Vec<BoxTag> centre;
  hwy::HWY_NAMESPACE::Vec<BoxTag> half;
};

/// Returns a rest box under a matrix along the axes `first` and following, as many as there are lanes: its centre is
/// M c, and its half extent |M| h. `Transform` has the columns of M, and as `magnitude` the absolute values of the
/// first three.
template <typename Transform>
inline TransformedBox transformed_box(const RestBox& box, const Transform& t, int first) {
  namespace hn = hwy::HWY_NAMESPACE;
  const BoxTag d;
  const auto axes_of = [&](const glm::vec4& column) { return hn::Load(d, &column[first]); };
  const auto product = [&](const glm::vec4& column, float x) { return hn::Mul(axes_of(column), hn::Set(d, x)); };
  const auto xy = hn::Add(product(t.column[0], box.centre.x), product(t.column[1], box.centre.y));
  const auto half_xy = hn::Add(product(t.magnitude[0], box.half_extent.x), product(t.magnitude[1], box.half_extent.y));
  return {hn::Add(hn::Add(xy, product(t.column[2], box.centre.z)), axes_of(t.column[3])),
          hn::Add(half_xy, product(t.magnitude[2], box.half_extent.z))};
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#endif
