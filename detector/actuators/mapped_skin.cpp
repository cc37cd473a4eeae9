#include "detector/actuators/mapped_skin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "detector/actuators/texture_stretch.hpp"

namespace vestige {

namespace {

/// Margin around the texels of a triangle, for the rounding of texture coordinates, in fp64 and on a GPU in fp32.
constexpr double kMarginTexels = 1;
/// Up to here, a texture coordinate in fp32 errs by less than the margin after a few operations.
constexpr double kFarthestTexel = 1 << 20;

/// The texels with actuators as runs by row. So a query for an interval of a row is a binary search.
class MappedTexels {
 public:
  explicit MappedTexels(const ActuatorMap& map) : width_(map.width), height_(map.height), rows_(map.height) {
    for (std::uint32_t row = 0; row < height_; ++row) {
      const auto begin = map.actuator.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * width_);
      const auto end = begin + width_;
      const auto is_mapped = [](std::uint16_t actuator) { return actuator != 0; };
      for (auto first = std::find_if(begin, end, is_mapped); first != end;) {
        const auto last = std::find_if_not(first, end, is_mapped);
        rows_[row].push_back({first - begin, last - begin});
        first = std::find_if(last, end, is_mapped);
      }
    }
  }

  double width() const { return width_; }
  double height() const { return height_; }

  /// Returns whether a texel in the columns first … last of a row has an actuator; both row and columns wrap around.
  bool any(std::int64_t row, std::int64_t first, std::int64_t last) const {
    const std::vector<Run>& runs = rows_[static_cast<std::size_t>(wrapped(row, height_))];
    if (last - first + 1 >= width_) return !runs.empty();
    const std::int64_t begin = wrapped(first, width_);
    const std::int64_t end = begin + (last - first) + 1;
    return meets(runs, begin, std::min<std::int64_t>(end, width_)) || (end > width_ && meets(runs, 0, end - width_));
  }

 private:
  struct Run {
    std::int64_t begin;
    std::int64_t end;
  };

  static std::int64_t wrapped(std::int64_t value, std::int64_t size) { return ((value % size) + size) % size; }

  static bool meets(const std::vector<Run>& runs, std::int64_t begin, std::int64_t end) {
    const auto run = std::ranges::upper_bound(runs, begin, {}, &Run::end);
    return run != runs.end() && run->begin < end;
  }

  std::uint32_t width_;
  std::uint32_t height_;
  std::vector<std::vector<Run>> rows_;
};

/// Returns whether any texel within the margin of the triangle has an actuator: conservative rasterisation
/// (Akenine-Möller & Aila 2005), row by row. Corners are in texels.
bool covers_mapped(const MappedTexels& texels, const std::array<glm::dvec2, 3>& corners) {
  const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  const bool near = std::ranges::all_of(corners, [](const glm::dvec2& corner) {
    return std::abs(corner.x) <= kFarthestTexel && std::abs(corner.y) <= kFarthestTexel;  // false for NaN
  });
  if (!near || high.x - low.x > texels.width() || high.y - low.y > texels.height()) return true;
  const auto first = static_cast<std::int64_t>(std::floor(low.y - kMarginTexels));
  const auto last = static_cast<std::int64_t>(std::floor(high.y + kMarginTexels));
  for (std::int64_t row = first; row <= last; ++row) {
    const auto y = static_cast<double>(row);
    const Stretch stretch = stretch_within(corners, y - kMarginTexels, y + 1 + kMarginTexels);
    if (stretch.low > stretch.high) continue;
    if (texels.any(row, static_cast<std::int64_t>(std::floor(stretch.low - kMarginTexels)),
                   static_cast<std::int64_t>(std::floor(stretch.high + kMarginTexels))))
      return true;
  }
  return false;
}

Avatar with_triangles(const Avatar& avatar, const std::vector<std::uint32_t>& numbers) {
  Avatar part = avatar;
  part.triangles.clear();
  part.animations.clear();
  part.triangles.reserve(numbers.size());
  for (const std::uint32_t number : numbers) part.triangles.push_back(avatar.triangles[number]);
  return part;
}

/// Returns nothing if the map needs no other numbers.
std::optional<ActuatorMap> with_triangles(const ActuatorMap& map, const std::vector<std::uint32_t>& numbers) {
  if (map.triangle_count == 0) return std::nullopt;
  ActuatorMap part = map;
  // The texture keeps the size of the whole map, which fits into a GPU's texture.
  for (std::size_t i = 0; i < numbers.size(); ++i) part.actuator[i] = map.actuator[numbers[i]];
  part.triangle_count = numbers.size();
  return part;
}

class MappedSkinDetector final : public Detector {
 public:
  MappedSkinDetector(const Avatar& avatar, const ActuatorMap& map, std::vector<std::uint32_t> numbers,
                     const DetectorMaker& make)
      : left_out_(avatar.triangles.size() - numbers.size()),
        numbers_(std::move(numbers)),
        part_(with_triangles(avatar, numbers_)),
        map_(with_triangles(map, numbers_)),
        detector_(make(part_, map_ ? *map_ : map)) {}

  const char* name() const override { return detector_->name(); }
  Method method() const override { return detector_->method(); }
  Skip skip() const override { return detector_->skip(); }
  std::uint64_t run_length() const override { return detector_->run_length(); }
  bool is_approximate() const override { return detector_->is_approximate(); }
  GlInfo gl_info() const override { return detector_->gl_info(); }
  bool skins_in_shader() const override { return detector_->skins_in_shader(); }
  std::size_t triangles_left_out() const override { return left_out_; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    const DetectorWork work = detector_->detect(frame, row);
    for (Contact& contact : row)
      if (contact.hit()) contact.triangle = numbers_[contact.triangle];
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    detector_->skinned_vertices(frame, out);
  }

 private:
  std::size_t left_out_;
  std::vector<std::uint32_t>
      numbers_;  ///< numbers, in the whole avatar, of the triangles of `part_`; ascending, as ties need
  Avatar part_;  ///< with all vertices
  std::optional<ActuatorMap> map_;  ///< of `part_`
  std::unique_ptr<Detector> detector_;
};

}  // namespace

std::vector<std::uint32_t> mapped_triangles(const Avatar& avatar, const ActuatorMap& map) {
  std::vector<std::uint32_t> found;
  if (map.triangle_count != 0) {
    for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i)
      if (map.at(i, {}) != 0) found.push_back(i);
    return found;
  }
  const MappedTexels texels(map);
  const glm::dvec2 size(texels.width(), texels.height());
  const auto texel_of = [&](std::uint32_t vertex) { return glm::dvec2(avatar.texture_coordinate[vertex]) * size; };
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) {
    const glm::uvec3& corner = avatar.triangles[i];
    if (covers_mapped(texels, {texel_of(corner.x), texel_of(corner.y), texel_of(corner.z)})) found.push_back(i);
  }
  return found;
}

std::unique_ptr<Detector> on_mapped_skin(const Avatar& avatar, const ActuatorMap& map, const DetectorMaker& make) {
  std::vector<std::uint32_t> numbers = mapped_triangles(avatar, map);
  // Avoid a detector without triangles: keep one triangle, which fires nothing either.
  if (numbers.empty() && !avatar.triangles.empty()) numbers.push_back(0);
  if (numbers.size() == avatar.triangles.size()) return make(avatar, map);
  return std::make_unique<MappedSkinDetector>(avatar, map, std::move(numbers), make);
}

}  // namespace vestige
