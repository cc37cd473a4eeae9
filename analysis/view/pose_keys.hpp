#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

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

/// Thins a person's poses for the eye. It leaves a pose out where a straight, even motion of the palette between the
/// poses kept takes no vertex farther than `kTolerance_m` from its place, but it keeps 60 poses in a second. Where the
/// trace has a gap or a pose that cannot be drawn, a new motion begins.
class PoseKeys {
 public:
  static constexpr double kRate_hz = 60;
  static constexpr double kTolerance_m = 1e-3;

  /// Keeps a reference to the avatar.
  explicit PoseKeys(const Avatar& avatar);

  /// Takes the next frame's pose. One that is missing, not finite or out of the page's reach is left out.
  void add(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m);
  /// Adds the arrays pose_… of `PageArrays`. Returns the steps of `pose_matrix`: of each entry of the palette two.
  std::vector<double> finish(PageArrays& arrays, const std::string& prefix);

  /// How many poses there are that cannot be drawn.
  std::size_t left_out() const { return left_out_; }
  /// How far any vertex is drawn from its place in any frame, at most. Final after `finish`.
  double largest_error_mm() const { return 1e3 * (thinned_m_ + cut_m_ + rounded_m_); }
  /// Where the person looks in the first pose, as an angle about +Y in degrees: 0 along +z, 90 along +x.
  double facing_deg() const;

 private:
  struct Posed {
    PageRow at;
    glm::dvec3 root_m = glm::dvec3(0);  ///< from the page's origin
    std::vector<glm::dmat4> palette;    ///< relative to the root
  };
  /// The box around the vertices in the bind pose that an entry of the palette moves.
  struct Reach {
    glm::dvec3 middle_m = glm::dvec3(0);
    glm::dvec3 half_m = glm::dvec3(0);
  };

  std::optional<Posed> take(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m) const;
  void keep(Posed posed, bool begins);
  void end_stretch();
  double thinning_m(const Posed& end) const;
  void measure_cut(std::size_t vertex, const Posed& posed);

  const Avatar& avatar_;
  std::vector<PageInfluences> influences_;
  std::vector<std::size_t> cut_;  ///< the vertices with more influences than a page draws
  std::vector<Reach> reach_;      ///< of each entry of the palette
  Posed kept_;                    ///< the pose kept last
  std::vector<Posed> since_;      ///< the poses after it, all of the same stretch
  double since_m_ = 0;            ///< how far the last of them, if kept, would move a vertex in one before it
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint8_t> begins_;
  std::vector<std::int32_t> roots_;
  std::vector<float> matrices_;
  glm::dvec3 looks_ = glm::dvec3(0);
  double thinned_m_ = 0;
  double cut_m_ = 0;  ///< by fewer and rounded influences
  double rounded_m_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace vestige
