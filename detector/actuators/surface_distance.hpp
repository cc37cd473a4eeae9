#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "traces/scenarios/skin.hpp"

namespace vestige {

/// How far it is where no way leads.
inline constexpr double kUnreached_m = std::numeric_limits<double>::infinity();

/// How far it is along a surface from a point of it to every vertex: fast marching (Kimmel & Sethian 1998, "Computing
/// geodesic paths on manifolds"), where a triangle hands distances on as from a point source unfolded into its plane
/// (Novotni & Klein 2002, "Computing geodesic distances on triangular meshes"): exact on a plane; where edges are a
/// fifth of the radius of curvature, as on a coarse torso, too short by 0.6 % a quarter turn away and 1.4 % half a turn
/// away, and less in proportion on finer meshes. A vertex whose distance turns out shorter is marched on from again, so
/// obtuse triangles need no splitting.
///
/// Never longer than the shortest way along edges, never shorter than the straight line. Vertices in the same place
/// are one; edges may have any number of triangles. Triangles without area are passed along their edges. The same bits
/// on every machine.
class SurfaceDistance {
 public:
  /// What lies between parts of the surface that share no vertex, such as skin and clothes.
  enum class Gaps {
    kOpen,  ///< nothing: one cannot be reached from the other
    /// Every vertex is joined by a straight line to the nearest one of another part within 1 % of the longest side of
    /// the box around all; parts that are still apart are joined where they come nearest.
    kBridged,
  };

  /// `position_m`: a vertex each; `triangles`: indices into it.
  SurfaceDistance(std::vector<glm::dvec3> position_m, std::span<const glm::uvec3> triangles, Gaps gaps);

  /// Metres, for every vertex; kUnreached_m for one that is not reached, or not finite.
  std::vector<double> from(const SkinPoint& source) const;

  const std::vector<glm::dvec3>& position_m() const { return position_m_; }
  const std::vector<glm::uvec3>& triangles() const { return triangles_; }
  glm::dvec3 position_of(const SkinPoint& point) const;
  /// Parts that share no vertex, before bridges; vertices without a triangle do not count.
  std::size_t parts() const { return parts_; }

 private:
  /// A triangle as its corner 0 sees it: two other vertices and the lengths of the sides.
  struct Fan {
    std::array<std::uint32_t, 2> other;
    std::array<double, 2> side_m;  ///< to each of the two
    double base_m;                 ///< between them
  };
  struct Bridge {
    std::uint32_t to;
    double length_m;
  };

  void build_fans();
  std::vector<std::uint32_t> find_parts();
  void build_bridges(std::vector<std::uint32_t> part);

  std::vector<glm::dvec3> position_m_;
  std::vector<glm::uvec3> triangles_;
  std::vector<std::uint32_t> weld_;  ///< of each vertex: the one that stands for all in its place
  std::vector<std::uint32_t> first_fan_;
  std::vector<Fan> fans_;
  std::vector<std::vector<Bridge>> bridges_;  ///< of each vertex; empty where there is none at all
  std::size_t parts_ = 0;
};

}  // namespace vestige
