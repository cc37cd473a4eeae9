#include "analysis/plot/canvas/canvas.hpp"

#include <fmt/format.h>
#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextDevice2D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkRect.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

constexpr double kPointsPerInch = 72;

const std::string& font_file(Weight weight) {
  static const std::string folder = "/usr/share/fonts/truetype/liberation2/";
  static const std::string regular = folder + "LiberationSans-Regular.ttf";
  static const std::string bold = folder + "LiberationSans-Bold.ttf";
  const std::string& file = weight == Weight::kBold ? bold : regular;
  if (!std::filesystem::exists(file))
    throw Error(file, "this font is missing", "install it: apt-get install fonts-liberation2");
  return file;
}

void set_text(vtkTextProperty& out, const TextStyle& style) {
  out.SetFontFamily(VTK_FONT_FILE);
  out.SetFontFile(font_file(style.weight).c_str());
  out.SetFontSize(style.size_pt);
  out.SetBold(style.weight == Weight::kBold ? 1 : 0);
  out.SetColor(style.colour.red / 255.0, style.colour.green / 255.0, style.colour.blue / 255.0);
  out.SetOpacity(style.colour.alpha / 255.0);
  out.SetOrientation(style.turned_degrees);
  out.SetJustification(style.anchor == Anchor::kLeft     ? VTK_TEXT_LEFT
                       : style.anchor == Anchor::kCentre ? VTK_TEXT_CENTERED
                                                         : VTK_TEXT_RIGHT);
  out.SetVerticalJustification(VTK_TEXT_BOTTOM);
}

}  // namespace

Colour faded(Colour colour, double opacity) {
  colour.alpha = static_cast<std::uint8_t>(std::lround(std::clamp(opacity, 0.0, 1.0) * 255));
  return colour;
}

std::size_t print_dots(double length_pt) {
  return static_cast<std::size_t>(std::lround(length_pt * kPrintDotsPerInch / kPointsPerInch));
}

double whole_dots_pt(double length_pt) {
  constexpr double kStepPt = 6;
  return std::max(kStepPt, std::floor(length_pt / kStepPt) * kStepPt);
}

double text_width_pt(std::string_view text, const TextStyle& style) {
  constexpr int kFineDotsPerInch = 720;
  vtkNew<vtkTextProperty> property;
  set_text(*property, style);
  property->SetOrientation(0);
  std::array<int, 4> bounds{};
  vtkTextRenderer::GetInstance()->GetBoundingBox(property, vtkStdString(std::string(text)), bounds.data(),
                                                 kFineDotsPerInch);
  return (bounds[1] - bounds[0] + 1) * kPointsPerInch / kFineDotsPerInch;
}

Canvas::Canvas(vtkContext2D& context, double dots_per_inch)
    : context_(context), dots_per_pt_(dots_per_inch / kPointsPerInch) {}

float Canvas::dots(double length_pt) const {
  return static_cast<float>(length_pt * dots_per_pt_);
}

void Canvas::line(Place from, Place to, const Pen& pen) {
  const std::array<Place, 2> ends = {from, to};
  polyline(ends, pen);
}

void Canvas::polyline(std::span<const Place> places, const Pen& pen) {
  if (places.size() < 2) return;
  vtkPen& out = *context_.GetPen();
  out.SetColor(pen.colour.red, pen.colour.green, pen.colour.blue, pen.colour.alpha);
  out.SetWidth(dots(pen.width_pt));
  out.SetLineType(vtkPen::SOLID_LINE);
  switch (pen.dash) {
    case Dash::kSolid:
      return stroke(places);
    case Dash::kDashed:
      return dash(places, 4, 2.5);
    case Dash::kDotted:
      return dash(places, 1, 2);
  }
}

void Canvas::stroke(std::span<const Place> places) {
  std::vector<float> coordinates;
  coordinates.reserve(places.size() * 2);
  for (const Place& place : places) {
    coordinates.push_back(dots(place.x_pt));
    coordinates.push_back(dots(place.y_pt));
  }
  context_.GetDevice()->DrawPoly(coordinates.data(), static_cast<int>(places.size()));
}

/// VTK's own dashes differ in length between formats and resolutions.
void Canvas::dash(std::span<const Place> places, double drawn_pt, double left_out_pt) {
  std::vector<Place> piece = {places.front()};
  bool drawing = true;
  double remaining_pt = drawn_pt;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Place from = places[i - 1];
    const Place to = places[i];
    const double length_pt = std::hypot(to.x_pt - from.x_pt, to.y_pt - from.y_pt);
    double walked_pt = 0;
    while (length_pt - walked_pt > remaining_pt) {
      walked_pt += remaining_pt;
      const double part = walked_pt / length_pt;
      const Place here = {std::lerp(from.x_pt, to.x_pt, part), std::lerp(from.y_pt, to.y_pt, part)};
      piece.push_back(here);
      if (drawing) stroke(piece);
      piece = {here};
      drawing = !drawing;
      remaining_pt = drawing ? drawn_pt : left_out_pt;
    }
    remaining_pt -= length_pt - walked_pt;
    piece.push_back(to);
  }
  if (drawing && piece.size() > 1) stroke(piece);
}

void Canvas::polygon(std::span<const Place> corners, Colour colour) {
  context_.GetBrush()->SetColor(colour.red, colour.green, colour.blue, colour.alpha);
  std::vector<float> coordinates;
  coordinates.reserve(corners.size() * 2);
  for (const Place& corner : corners) {
    coordinates.push_back(dots(corner.x_pt));
    coordinates.push_back(dots(corner.y_pt));
  }
  // The context would also draw an outline with the current pen.
  context_.GetDevice()->DrawPolygon(coordinates.data(), static_cast<int>(corners.size()));
}

void Canvas::rectangle(const Box& box, Colour fill) {
  const std::array<Place, 4> corners = {Place{box.left_pt, box.bottom_pt}, Place{box.right_pt, box.bottom_pt},
                                        Place{box.right_pt, box.top_pt}, Place{box.left_pt, box.top_pt}};
  polygon(corners, fill);
}

void Canvas::frame(const Box& box, const Pen& pen) {
  const std::array<Place, 5> corners = {Place{box.left_pt, box.bottom_pt}, Place{box.right_pt, box.bottom_pt},
                                        Place{box.right_pt, box.top_pt}, Place{box.left_pt, box.top_pt},
                                        Place{box.left_pt, box.bottom_pt}};
  polyline(corners, pen);
}

void Canvas::mark(Place centre, Mark mark, double size_pt, Colour fill, Colour outline) {
  const double radius_pt = size_pt / 2;
  std::vector<Place> corners;
  const auto corner = [&](double degrees, double reach) {
    const double angle = degrees * std::numbers::pi / 180;
    corners.push_back({centre.x_pt + reach * radius_pt * std::cos(angle),  //
                       centre.y_pt + reach * radius_pt * std::sin(angle)});
  };
  switch (mark) {
    case Mark::kCircle:
      for (int i = 0; i < 24; ++i) corner(i * 15.0, 1);
      break;
    case Mark::kSquare:
      for (int i = 0; i < 4; ++i) corner(45 + i * 90.0, 1.25);
      break;
    case Mark::kDiamond:
      for (int i = 0; i < 4; ++i) corner(i * 90.0, 1.25);
      break;
    case Mark::kTriangleUp:
      for (int i = 0; i < 3; ++i) corner(90 + i * 120.0, 1.3);
      break;
  }
  polygon(corners, fill);
  corners.push_back(corners.front());
  polyline(corners, {outline, 0.5, Dash::kSolid});
}

void Canvas::text(Place place, std::string_view text, const TextStyle& style) {
  set_text(*context_.GetTextProp(), style);
  // VTK places text by its lowest descender.
  double up_pt = -kDescent * style.size_pt;
  if (style.level == Level::kMiddle) up_pt -= kCapitalHeight / 2 * style.size_pt;
  if (style.level == Level::kTop) up_pt -= kCapitalHeight * style.size_pt;
  const double angle = style.turned_degrees * std::numbers::pi / 180;
  const double x_pt = place.x_pt - up_pt * std::sin(angle);
  const double y_pt = place.y_pt + up_pt * std::cos(angle);
  context_.DrawString(dots(x_pt), dots(y_pt), std::string(text).c_str());
}

void Canvas::image(const Box& box, const Raster& raster) {
  vtkNew<vtkImageData> pixels;
  pixels->SetDimensions(static_cast<int>(raster.width()), static_cast<int>(raster.height()), 1);
  pixels->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*>(pixels->GetScalarPointer());
  for (std::size_t row = raster.height(); row-- > 0;) {
    for (std::size_t column = 0; column < raster.width(); ++column) {
      const Colour colour = raster.at(column, row);
      *out++ = colour.red;
      *out++ = colour.green;
      *out++ = colour.blue;
    }
  }
  context_.DrawImage(vtkRectf(dots(box.left_pt), dots(box.bottom_pt), dots(box.width_pt()), dots(box.height_pt())),
                     pixels);
}

std::string shortened(std::string text, const TextStyle& style, double width_pt) {
  if (text_width_pt(text, style) <= width_pt) return text;
  while (!text.empty() && text_width_pt(text + "…", style) > width_pt) {
    // A whole character, which may be several bytes.
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
    text.pop_back();
  }
  return text + "…";
}

std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_pt) {
  std::vector<std::string> lines;
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = line.empty() ? word : fmt::format("{} {}", line, word);
    if (!line.empty() && text_width_pt(longer, style) > width_pt) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  lines.push_back(line);
  return lines;
}

}  // namespace vestige::plot
