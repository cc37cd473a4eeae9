#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

class vtkContext2D;

namespace vestige::plot {

/// sRGB and opacity, 0..255 each.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 255;
};

/// `colour` with another opacity (0..1).
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
/// Which part of the capitals is at the given height: their foot, middle or top.
enum class Level { kFoot, kMiddle, kTop };
enum class Weight { kRegular, kBold };
enum class Mark { kCircle, kSquare, kDiamond, kTriangleUp };

struct Pen {
  Colour colour = {};
  double width_pt = 0.5;
  Dash dash = Dash::kSolid;
};

/// How far letters such as g reach below the line they stand on, and capitals above it, as a part of the type size
/// (Liberation Sans).
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

/// Dots per inch of the PNG, and of the pictures inside the SVG.
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

/// The printed dots along `length_pt`. Boxes for pictures have their edges at multiples of 6 pt, which are whole dots,
/// so that a raster of as many pixels comes out sharp.
std::size_t print_dots(double length_pt);

/// The longest such length up to `length_pt`, at least one step.
double whole_dots_pt(double length_pt);

/// The same on every canvas.
double text_width_pt(std::string_view text, const TextStyle& style);

/// Its words in lines that are no wider than that, unless a word alone is.
std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_pt);

/// As much of it as fits, with an ellipsis where something is left out.
std::string shortened(std::string text, const TextStyle& style, double width_pt);

/// What a figure is drawn with: lengths in points, text in Liberation Sans. Draws through VTK, into a window (PNG) or
/// an SVG document alike.
class Canvas {
 public:
  /// `context` is one that VTK is drawing with; `dots_per_inch` is its window's.
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
