#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/scene/scene_sight.hpp"
#include "analysis/plot/studio/subject.hpp"

namespace vestige::plot {

/// An actuator's line in the timeline.
struct FilmLine {
  std::string name;  ///< empty: nobody named it
  Colour colour;     ///< of its region
};

/// Returns the lines of all people's actuators, in the order of `FeltTrace::duty`.
std::vector<FilmLine> film_lines(const std::vector<Subject>& people);

/// What all pictures of a film have in common.
struct FilmSheet {
  std::string title;
  double speed = 1;      ///< 1 is not shown
  double step_s = 0.04;  ///< from a picture to the next, in the trace's time
  double fade_s = 0;     ///< how long contacts are shown, for the key
  bool follows = false;  ///< the camera goes along with the people
  std::vector<FilmLine> lines;
  double begin_s = 0;  ///< of the timeline
  double end_s = 1;    ///< later
};

/// Where everything is on a film's pictures. All lengths are whole dots.
class FilmLayout {
 public:
  FilmLayout(std::size_t width_dots, const SceneSight& sight, const std::vector<FilmLine>& lines);

  /// Returns the resolution of pictures of this width.
  static double dots_per_inch(std::size_t width_dots);

  std::size_t width_dots() const { return width_dots_; }
  std::size_t height_dots() const { return dots_of(height_pt()); }
  double dots_per_pt() const { return dots_per_pt_; }
  std::size_t body_height_dots() const { return body_height_dots_; }
  double m_per_dot() const { return m_per_dot_; }
  std::size_t timeline_width_dots() const { return timeline_right_dots_ - timeline_left_dots_; }
  std::size_t timeline_height_dots() const { return timeline_height_dots_; }

  double width_pt() const { return pt_of(width_dots_); }
  double height_pt() const;
  Box body() const;
  /// Of no height if there is no actuator: then only the axis is drawn.
  Box timeline() const;

 private:
  double pt_of(std::size_t dots) const { return static_cast<double>(dots) / dots_per_pt_; }
  std::size_t dots_of(double length_pt) const;

  double dots_per_pt_;
  std::size_t width_dots_;
  std::size_t body_height_dots_;
  double m_per_dot_;
  std::size_t timeline_left_dots_;
  std::size_t timeline_right_dots_;
  std::size_t timeline_height_dots_;
};

/// A picture of a film: the scene, the time, and below it the timeline of the duties with a cursor.
class FilmFigure : public Figure {
 public:
  /// `duties` is the timeline as `duty_raster` draws it, of the layout's size. It is not drawn if there is no actuator.
  FilmFigure(FilmSheet sheet, const FilmLayout& layout, Raster duties);

  /// Sets what the next picture shows: the scene, the layout's size, and the duty of each line.
  void show(double time_s, Raster scene, std::span<const std::uint8_t> duty);

  double width_pt() const override { return layout_.width_pt(); }
  double height_pt() const override { return layout_.height_pt(); }
  std::string description() const override;
  void draw(Canvas& canvas) const override;

 private:
  void draw_title(Canvas& canvas) const;
  void draw_timeline(Canvas& canvas) const;
  void draw_labels(Canvas& canvas, const Box& plot) const;
  void draw_key(Canvas& canvas) const;

  FilmSheet sheet_;
  FilmLayout layout_;
  Raster duties_;
  double time_s_ = 0;
  Raster scene_{1, 1, {}};
  std::vector<std::uint8_t> duty_;
};

}  // namespace vestige::plot
