#pragma once

#include <expat.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/test_data.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::test {

inline void write_text(const std::filesystem::path& path, std::string_view text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The words of an SVG document; fails the test when it is not well-formed XML.
inline std::string words_of(const std::filesystem::path& svg) {
  const std::string document = read_text_file(svg);
  std::string words;
  const XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &words);
  XML_SetCharacterDataHandler(parser, [](void* out, const XML_Char* text, int length) {
    static_cast<std::string*>(out)->append(text, static_cast<std::size_t>(length));
  });
  const bool is_xml = XML_Parse(parser, document.data(), static_cast<int>(document.size()), XML_TRUE) == XML_STATUS_OK;
  EXPECT_TRUE(is_xml) << svg << ": " << XML_ErrorString(XML_GetErrorCode(parser)) << " in line "
                      << XML_GetCurrentLineNumber(parser);
  XML_ParserFree(parser);
  return words;
}

struct Pixel {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Pixel&) const = default;
};
constexpr Pixel kWhite = {255, 255, 255};

struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Pixel> pixels;

  /// The number of pixels of that colour in columns [begin, end).
  std::size_t count(Pixel colour, std::size_t begin, std::size_t end) const {
    std::size_t result = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (i % width >= begin && i % width < end && pixels[i] == colour) ++result;
    return result;
  }
};

inline Picture read_png(const std::filesystem::path& path) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGB;
  Picture picture = {image.width, image.height, std::vector<Pixel>(std::size_t{image.width} * image.height)};
  static_assert(sizeof(Pixel) == 3);
  if (png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  return picture;
}

/// Runs vestige-plot as a user does, in a folder of its own.
class PlotTest : public ::testing::Test {
 protected:
  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    return test::run("env -u DISPLAY " + environment + " vestige-plot " + arguments, folder_.path());
  }

  std::size_t file_count() const {
    const std::filesystem::directory_iterator files(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }

  TemporaryFolder folder_;
};

}  // namespace vestige::test
