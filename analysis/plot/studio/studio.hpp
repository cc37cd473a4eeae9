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

/// The colour of a surface where a triangle's second and third vertex weigh u and v.
using Paint = std::function<Colour(std::uint32_t triangle, double u, double v)>;

/// A view that fills a cell of a page, at `unit_per_pt`; where it looks is still to be set.
View view_of_cell(const Camera& camera, double width_pt, double height_pt, double unit_per_pt);

/// A surface in soft light: a key light from the upper left, sky all around, both with shadows, on white ground.
/// Lengths are in the surface's unit.
class StudioShot {
 public:
  /// `surface` must stay. Without `ground_y` it floats.
  StudioShot(const Surface& surface, const View& view, std::optional<double> ground_y);

  const View& view() const { return view_; }
  /// Where a point of the world comes to lie, in dots from the picture's upper left corner.
  glm::dvec2 dot_of(const glm::dvec3& point) const;
  /// What is seen in the middle of a dot.
  const Sample& at(std::size_t column, std::size_t row) const;

  /// Draws over the surface, in one colour: a line from `from` to `to`, `width_dots` wide with round ends, as opaque as
  /// the ends say; `hidden` times as much where the surface is in front by more than `tolerance`. Where lines overlap,
  /// the most opaque one counts.
  class Overlay {
   public:
    Overlay(const StudioShot& shot, Colour colour);
    struct End {
      glm::dvec3 point;
      double opacity;
    };
    void line(const End& from, const End& to, double width_dots, double hidden, double tolerance);
    /// All dots of an overlay are alike. Of many whose middles fall into one dot of the picture the nearest is drawn.
    void dot(const glm::dvec3& centre, double width_dots, double opacity, double hidden, double tolerance);

   private:
    friend class StudioShot;
    const StudioShot& shot_;
    Colour colour_;
    std::vector<float> opacity_;  ///< one for each sample; empty: nothing was drawn
    std::vector<float> nearest_;  ///< depth of the nearest dot in each dot of the picture; empty: there is none
  };

  Raster picture(const Paint& paint, const std::vector<Overlay>& overlays = {}) const;

 private:
  void light(const Surface& surface, std::optional<double> ground_y);

  View view_;
  View fine_;  ///< the same with kFineness² samples a dot
  std::vector<Sample> samples_;
  std::vector<float> light_;  ///< of each sample: 1 is a white surface that comes out white
};

}  // namespace vestige::plot
