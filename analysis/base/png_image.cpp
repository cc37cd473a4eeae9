#include "analysis/base/png_image.hpp"

#include <png.h>

#include <bit>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// The objects that libpng's calls share. They are freed whether or not a call throws.
struct Writer {
  std::string failure;
  std::vector<std::byte> bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;

  ~Writer() { png_destroy_write_struct(&png, &info); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  static_cast<Writer*>(png_get_error_ptr(png))->failure = message;
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep bytes, png_size_t count) {
  auto& writer = *static_cast<Writer*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  writer.bytes.insert(writer.bytes.end(), first, first + count);
}

/// An image as libpng takes it, with rows from the top down.
struct Image {
  std::span<const std::byte> pixels;
  std::uint32_t width;
  std::uint32_t height;
  int depth;
  int colour;
};

/// Objects with a destructor must not be made between setjmp and the calls that may jump.
bool write_rows(Writer& writer, const Image& image, std::size_t row_bytes, const png_text* text) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's own way
  png_set_IHDR(writer.png, writer.info, image.width, image.height, image.depth, image.colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (text != nullptr) png_set_text(writer.png, writer.info, text, 1);
  png_write_info(writer.png, writer.info);
  if (image.depth == 16 && std::endian::native == std::endian::little) png_set_swap(writer.png);
  for (std::uint32_t row = 0; row < image.height; ++row)
    png_write_row(writer.png, reinterpret_cast<png_const_bytep>(image.pixels.data() + row * row_bytes));
  png_write_end(writer.png, nullptr);
  return true;
}

std::vector<std::byte> write_png(const Image& image, std::optional<PngText> text = std::nullopt) {
  Writer writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
  if (writer.png != nullptr) writer.info = png_create_info_struct(writer.png);
  if (writer.info == nullptr) throw Error("PNG", "libpng cannot get enough memory", "make the picture smaller");
  png_set_write_fn(writer.png, &writer, take_bytes, nullptr);
  png_text chunk = {};
  if (text) {
    chunk.compression = PNG_TEXT_COMPRESSION_NONE;
    chunk.key = text->keyword.data();
    chunk.text = text->text.data();
    chunk.text_length = text->text.size();
  }
  if (!write_rows(writer, image, image.pixels.size() / image.height, text ? &chunk : nullptr))
    throw Error("PNG", writer.failure, "make the picture smaller");
  return std::move(writer.bytes);
}

}  // namespace

std::vector<std::byte> grey_png(std::span<const std::uint8_t> pixels, std::uint32_t width, std::uint32_t height,
                                std::optional<PngText> text) {
  return write_png({std::as_bytes(pixels), width, height, 8, PNG_COLOR_TYPE_GRAY}, std::move(text));
}

std::vector<std::byte> grey_png(std::span<const std::uint16_t> pixels, std::uint32_t width, std::uint32_t height,
                                std::optional<PngText> text) {
  return write_png({std::as_bytes(pixels), width, height, 16, PNG_COLOR_TYPE_GRAY}, std::move(text));
}

std::vector<std::byte> colour_png(std::span<const std::array<std::uint8_t, 3>> pixels, std::uint32_t width,
                                  std::uint32_t height) {
  return write_png({std::as_bytes(pixels), width, height, 8, PNG_COLOR_TYPE_RGB});
}

}  // namespace vestige
