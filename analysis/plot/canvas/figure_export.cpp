#include "analysis/plot/canvas/figure_export.hpp"

#include <fmt/format.h>
#include <vtkBase64Utilities.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkRenderer.h>
#include <vtkSVGContextDevice2D.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "analysis/plot/canvas/headless_window.hpp"

namespace vestige::plot {

namespace {

/// SVG has no resolution; this one makes a point ten units, so that nothing visible is lost to rounding.
constexpr double kSvgDotsPerInch = 720;
constexpr double kSvgUnitsPerPt = kSvgDotsPerInch / 72;

int dots(double length_pt, double dots_per_inch) {
  return static_cast<int>(std::lround(length_pt * dots_per_inch / 72));
}

void set_page(vtkRenderWindow& window, const Figure& figure, double dots_per_inch) {
  window.SetSize(dots(figure.width_pt(), dots_per_inch), dots(figure.height_pt(), dots_per_inch));
  window.SetDPI(static_cast<int>(std::lround(dots_per_inch)));
}

/// Corrects VTK's SVG text. VTK writes sizes in pt whatever the page's units are, gives the height by an attribute that
/// viewers ignore, says "right" where SVG says "end", and turns text the wrong way.
void mend_text(vtkXMLDataElement& element) {
  if (std::strcmp(element.GetName(), "text") == 0) {
    const double size_pt = std::strtod(element.GetAttribute("font-size"), nullptr);
    element.SetDoubleAttribute("font-size", size_pt * kSvgUnitsPerPt);
    element.SetDoubleAttribute("y", -kDescent * size_pt * kSvgUnitsPerPt);
    element.SetAttribute("font-family", "Liberation Sans, Arial, Helvetica, sans-serif");
    element.RemoveAttribute("alignment-baseline");
    const char* anchor = element.GetAttribute("text-anchor");
    if (anchor != nullptr && std::strcmp(anchor, "right") == 0) element.SetAttribute("text-anchor", "end");
    const std::string transform = element.GetAttribute("transform");
    constexpr std::string_view kTurn = "rotate(";
    const std::size_t turn = transform.find(kTurn);
    if (turn != std::string::npos) {
      const std::size_t degrees = turn + kTurn.size();
      element.SetAttribute("transform",
                           fmt::format("{}-{}", transform.substr(0, degrees), transform.substr(degrees)).c_str());
    }
  }
  for (int i = 0; i < element.GetNumberOfNestedElements(); ++i) mend_text(*element.GetNestedElement(i));
}

std::string png_bytes(vtkImageData& image) {
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(&image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray& bytes = *writer->GetResult();
  std::string png(static_cast<std::size_t>(bytes.GetNumberOfValues()), '\0');
  std::memcpy(png.data(), bytes.GetPointer(0), png.size());
  return png;
}

/// VTK embeds pictures without compression, a hundred times as large.
void compress_pictures(vtkXMLDataElement& definitions) {
  constexpr const char* kReference = "xlink:href";
  constexpr std::string_view kPrefix = "data:image/png;base64,";
  const auto bytes_of = [](auto* text) { return reinterpret_cast<const unsigned char*>(text); };
  for (int i = 0; i < definitions.GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& element = *definitions.GetNestedElement(i);
    const char* reference = element.GetAttribute(kReference);
    if (reference == nullptr || !std::string_view(reference).starts_with(kPrefix)) continue;
    const std::string_view encoded = std::string_view(reference).substr(kPrefix.size());
    std::string plain(encoded.size(), '\0');
    plain.resize(vtkBase64Utilities::DecodeSafely(bytes_of(encoded.data()), encoded.size(),
                                                  reinterpret_cast<unsigned char*>(plain.data()), plain.size()));
    vtkNew<vtkPNGReader> reader;
    reader->SetMemoryBuffer(plain.data());
    reader->SetMemoryBufferLength(static_cast<vtkIdType>(plain.size()));
    reader->Update();
    const std::string png = png_bytes(*reader->GetOutput());
    std::string text(png.size() * 2 + 4, '\0');  // a third more, and room for the end
    text.resize(
        vtkBase64Utilities::Encode(bytes_of(png.data()), png.size(), reinterpret_cast<unsigned char*>(text.data())));
    element.SetAttribute(kReference, fmt::format("{}{}", kPrefix, text).c_str());
  }
}

vtkNew<vtkXMLDataElement> new_element(const char* name) {
  vtkNew<vtkXMLDataElement> result;
  result->SetName(name);
  return result;
}

class FigureItem : public vtkContextItem {
 public:
  static FigureItem* New();  // NOLINT(readability-identifier-naming): VTK's factory
  vtkTypeMacro(FigureItem, vtkContextItem)

      const Figure* figure = nullptr;
  double dots_per_inch = kPrintDotsPerInch;

  bool Paint(vtkContext2D* painter) override {
    Canvas canvas(*painter, dots_per_inch);
    figure->draw(canvas);
    return true;
  }
};

vtkStandardNewMacro(FigureItem);

}  // namespace

std::string svg_of(const Figure& figure) {
  vtkNew<vtkGenericOpenGLRenderWindow> window;  // only its size and resolution are asked for
  set_page(*window, figure, kSvgDotsPerInch);
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);

  const auto definitions = new_element("defs");
  const auto page = new_element("g");
  page->SetAttribute("fill", "none");  // VTK leaves it out of lines, and SVG's default is to fill them
  page->SetAttribute("stroke-linejoin", "round");
  vtkNew<vtkSVGContextDevice2D> device;
  device->SetSVGContext(page, definitions);
  device->SetTextAsPath(false);
  device->Begin(renderer);
  vtkNew<vtkContext2D> context;
  context->Begin(device);
  Canvas canvas(*context, kSvgDotsPerInch);
  canvas.rectangle({0, 0, figure.width_pt(), figure.height_pt()}, {255, 255, 255});
  figure.draw(canvas);
  context->End();
  device->GenerateDefinitions();
  compress_pictures(*definitions);
  mend_text(*page);

  const auto description = new_element("desc");
  const std::string words = figure.description();
  description->SetCharacterData(words.c_str(), static_cast<int>(words.size()));
  const auto root = new_element("svg");
  root->SetAttribute("xmlns", "http://www.w3.org/2000/svg");
  root->SetAttribute("xmlns:xlink", "http://www.w3.org/1999/xlink");
  root->SetAttribute("version", "1.1");
  root->SetAttribute("width", fmt::format("{}pt", figure.width_pt()).c_str());
  root->SetAttribute("height", fmt::format("{}pt", figure.height_pt()).c_str());
  root->SetAttribute(
      "viewBox",
      fmt::format("0 0 {} {}", figure.width_pt() * kSvgUnitsPerPt, figure.height_pt() * kSvgUnitsPerPt).c_str());
  root->AddNestedElement(description);
  root->AddNestedElement(definitions);
  root->AddNestedElement(page);
  std::ostringstream out;
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  vtkXMLUtilities::FlattenElement(root, out);
  out << '\n';
  return out.str();
}

struct FigureScreen::Parts {
  explicit Parts(double dots_per_inch) {
    window().SetMultiSamples(4);  // the most that llvmpipe has
    item->dots_per_inch = dots_per_inch;
    actor->GetScene()->AddItem(item);
    renderer->SetBackground(1, 1, 1);
    renderer->AddActor(actor);
    window().AddRenderer(renderer);
  }
  ~Parts() { window().RemoveRenderer(renderer); }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  vtkRenderWindow& window() const { return headless.window(); }

  vtkNew<vtkWindowToImageFilter> grab(const Figure& figure) {
    set_page(window(), figure, item->dots_per_inch);
    item->figure = &figure;
    window().Render();
    vtkNew<vtkWindowToImageFilter> grabbed;
    grabbed->SetInput(&window());
    grabbed->SetInputBufferTypeToRGB();
    grabbed->ReadFrontBufferOff();
    grabbed->ShouldRerenderOff();
    grabbed->Update();  // whole: asked for a part, as a writer does, this filter writes out of bounds
    return grabbed;
  }

  HeadlessWindow headless;
  vtkNew<FigureItem> item;
  vtkNew<vtkContextActor> actor;
  vtkNew<vtkRenderer> renderer;
};

FigureScreen::FigureScreen(double dots_per_inch) : parts_(std::make_unique<Parts>(dots_per_inch)) {}

FigureScreen::~FigureScreen() = default;

Raster FigureScreen::raster_of(const Figure& figure) {
  const auto grabbed = parts_->grab(figure);
  vtkImageData& image = *grabbed->GetOutput();
  const int* size = image.GetDimensions();
  Raster raster(static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]), {});
  const auto* from = static_cast<const std::uint8_t*>(image.GetScalarPointer());
  for (std::size_t row = raster.height(); row-- > 0;)
    for (std::size_t column = 0; column < raster.width(); ++column, from += 3)
      raster.at(column, row) = {from[0], from[1], from[2]};
  return raster;
}

std::string FigureScreen::png_of(const Figure& figure) {
  return png_bytes(*parts_->grab(figure)->GetOutput());
}

std::string png_of(const Figure& figure) {
  return FigureScreen(kPrintDotsPerInch).png_of(figure);
}

}  // namespace vestige::plot
