#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/view/collider_tracks.hpp"
#include "analysis/view/page_data.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

/// The influences that a page draws a vertex with: the four largest, or fewer.
struct PageInfluences {
  std::array<std::uint16_t, 4> palette = {};
  std::array<std::uint16_t, 4> weight = {};  ///< shares of 65535, which they sum to
};
PageInfluences page_influences(const Influences& influences);

/// Thins a person's poses for the eye. It keeps 60 in a second, more where a joint turns fast, and the first and the
/// last of every stretch without a gap. It compares the skin half-way between kept poses with the trace's own: often at
/// first, later now and then.
class PoseKeys {
 public:
  static constexpr double kRate_hz = 60;

  /// Keeps a reference to the avatar.
  explicit PoseKeys(const Avatar& avatar);

  /// Takes the next frame's pose. One that is missing, not finite or out of the page's reach is left out.
  void add(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m);
  /// Adds the arrays pose_… of `PageArrays` and returns `matrix_step`. `prefix` goes before the names.
  std::array<double, 2> finish(PageArrays& arrays, const std::string& prefix);

  /// How far any vertex was drawn from its place where it was measured. Final after `finish`.
  double largest_error_mm() const { return 1e3 * largest_error_m_; }

 private:
  struct Posed {
    PageRow at;
    glm::dvec3 root_m = glm::dvec3(0);  ///< from the page's origin
    std::vector<glm::dmat4> palette;    ///< relative to the root
  };

  bool take(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m);
  void keep(const Posed& posed);
  void measure(const Posed& before, const Posed& after);
  double rounding_m(const std::array<double, 2>& steps) const;

  const Avatar& avatar_;
  std::vector<PageInfluences> influences_;
  Posed now_;
  Posed kept_;
  std::optional<Posed> middle_;  ///< the first pose half-way to the next key
  std::optional<Posed> last_;    ///< the pose before `now_`, unless it was kept
  std::vector<std::uint32_t> rows_;
  std::vector<std::int32_t> roots_;
  std::vector<float> matrices_;
  std::size_t intervals_ = 0;
  double largest_error_m_ = 0;
};

}  // namespace vestige
