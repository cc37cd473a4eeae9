#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/colours/colour.hpp"

class vtkContext2D;

namespace vestige::plot {

/// Returns `colour` with this opacity (0..1).
Colour faded(Colour colour, double opacity);

/// A place on the page in points (1/72 inch), from the lower left corner.
struct Place {
  double x_pt = 0;
  double y_pt = 0;
};

/// A rectangle on the page, `left <= right`, `bottom <= top`.
struct Box {
  double left_pt = 0;
  double bottom_pt = 0;
  double right_pt = 0;
  double top_pt = 0;

  double width_pt() const { return right_pt - left_pt; }
  double height_pt() const { return top_pt - bottom_pt; }
};

enum class Dash { kSolid, kDashed, kDotted };
enum class Anchor { kLeft, kCentre, kRight };
/// The part of the capitals that is at the given height: their foot, middle or top.
enum class Level { kFoot, kMiddle, kTop };
enum class Weight { kRegular, kBold };
enum class Mark { kCircle, kSquare, kDiamond, kTriangleUp };

struct Pen {
  Colour colour = {};
  double width_pt = 0.5;
  Dash dash = Dash::kSolid;
};

/// How far letters such as g reach below the base line, and capitals above it, as a share of the type size (Liberation
/// Sans).
inline constexpr double kDescent = 0.212;
inline constexpr double kCapitalHeight = 0.729;

struct TextStyle {
  int size_pt = 8;
  Colour colour = {};
  Anchor anchor = Anchor::kLeft;
  Level level = Level::kMiddle;
  Weight weight = Weight::kRegular;
  double turned_degrees = 0;  ///< counterclockwise
};

/// Dots per inch of the PNG file, and of pictures inside the SVG file.
inline constexpr double kPrintDotsPerInch = 300;

/// A picture of opaque pixels, rows from the top.
class Raster {
 public:
  Raster(std::size_t width, std::size_t height, Colour fill) : width_(width), pixels_(width * height, fill) {}

  std::size_t width() const { return width_; }
  std::size_t height() const { return pixels_.size() / width_; }
  Colour& at(std::size_t column, std::size_t row) { return pixels_[row * width_ + column]; }
  Colour at(std::size_t column, std::size_t row) const { return pixels_[row * width_ + column]; }

 private:
  std::size_t width_;
  std::vector<Colour> pixels_;
};

/// Returns the number of printed dots along `length_pt`. The edges of boxes for pictures lie at multiples of 6 pt,
/// which are whole dots, so that a raster of as many pixels is sharp.
std::size_t print_dots(double length_pt);

/// Returns the longest multiple of 6 pt up to `length_pt`, at least 6 pt.
double whole_dots_pt(double length_pt);

/// Returns the width of a text. It is the same on every canvas.
double text_width_pt(std::string_view text, const TextStyle& style);

/// Returns the words of `text` in lines of at most `width_pt`. A word that is wider alone has its own line.
std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_pt);

/// Returns as much of the text as fits, with an ellipsis if something is left out.
std::string shortened(std::string text, const TextStyle& style, double width_pt);

/// The surface that a figure is drawn on. Lengths are in points, text is in Liberation Sans. Draws through VTK, either
/// into a window (PNG) or into an SVG document.
class Canvas {
 public:
  /// `context` must be active in VTK. `dots_per_inch` is that of its window.
  Canvas(vtkContext2D& context, double dots_per_inch);

  void line(Place from, Place to, const Pen& pen);
  void polyline(std::span<const Place> places, const Pen& pen);
  /// A convex polygon without an outline.
  void polygon(std::span<const Place> corners, Colour colour);
  void rectangle(const Box& box, Colour fill);
  void frame(const Box& box, const Pen& pen);
  /// A filled mark with a thin outline, `size_pt` wide.
  void mark(Place centre, Mark mark, double size_pt, Colour fill, Colour outline);
  void text(Place place, std::string_view text, const TextStyle& style);
  /// Fills `box` with the pixels.
  void image(const Box& box, const Raster& raster);

 private:
  float dots(double length_pt) const;
  void stroke(std::span<const Place> places);
  void dash(std::span<const Place> places, double drawn_pt, double left_out_pt);

  vtkContext2D& context_;
  double dots_per_pt_;
};

}  // namespace vestige::plot
