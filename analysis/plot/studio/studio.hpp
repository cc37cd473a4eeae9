#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"
#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/depth_map.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// Returns the colour of a surface at which a triangle's second and third vertex weigh u and v.
using Paint = std::function<Colour(std::uint32_t triangle, double u, double v)>;

/// Returns a view that fills a cell of a page at `unit_per_pt`. The caller must still set what the view looks at.
View view_of_cell(const Camera& camera, double width_pt, double height_pt, double unit_per_pt);

/// A surface in soft light on white ground. A key light comes from the upper left, and a sky from all around. Both cast
/// shadows. Lengths are in the surface's unit.
class StudioShot {
 public:
  /// Reads `surface` only during construction. Without `ground_y`, the surface floats.
  StudioShot(const Surface& surface, const View& view, std::optional<double> ground_y);

  const View& view() const { return view_; }
  /// Returns the place of a point of the world, in dots from the picture's upper left corner.
  glm::dvec2 dot_of(const glm::dvec3& point) const;
  /// Returns what is visible in the middle of a dot.
  const Sample& at(std::size_t column, std::size_t row) const;

  /// Draws over the surface in one colour. A line goes from `from` to `to`, `width_dots` wide with round ends. Its
  /// opacity goes from `from_opacity` to `to_opacity`. The opacity is multiplied by `hidden` where the surface is in
  /// front by more than `tolerance`. Where lines overlap, the most opaque line counts.
  class Overlay {
   public:
    Overlay(const StudioShot& shot, Colour colour);
    struct End {
      glm::dvec3 point;
      double opacity;
    };
    void line(const End& from, const End& to, double width_dots, double hidden, double tolerance);
    /// Draws a dot. All dots of an overlay must be alike. If several centres fall into one dot of the picture, only the
    /// nearest is drawn.
    void dot(const glm::dvec3& centre, double width_dots, double opacity, double hidden, double tolerance);

    /// Draws a sphere as if of glass: its rim is the most opaque. What lies behind the surface is drawn as with `line`.
    void sphere(const glm::dvec3& centre, double radius, double opacity, double hidden);

   private:
    friend class StudioShot;
    const StudioShot& shot_;
    Colour colour_;
    std::vector<float> opacity_;  ///< one for each sample; empty: nothing was drawn
    /// Depth of the nearest overlay dot at each dot of the picture; empty: no dot was drawn.
    std::vector<float> nearest_;
  };

  Raster picture(const Paint& paint, const std::vector<Overlay>& overlays = {}) const;

 private:
  void light(const Surface& surface, std::optional<double> ground_y);

  View view_;
  View fine_;  ///< the same view with kFineness² samples in each dot
  std::vector<Sample> samples_;
  std::vector<float> light_;  ///< for each sample; 1 shows a white surface as white
};

}  // namespace vestige::plot
