#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// A tEXt chunk (PNG, third edition, 11.3.3.3). Its text is Latin-1, its keyword has 1 to 79 characters.
struct PngText {
  std::string keyword;
  std::string text;
};

// These return PNG files of width x height pixels, row 0 at the top. The same pixels give the same bytes. They throw
// `Error` if libpng fails.
std::vector<std::byte> grey_png(std::span<const std::uint8_t> pixels, std::uint32_t width, std::uint32_t height,
                                std::optional<PngText> text = std::nullopt);
std::vector<std::byte> grey_png(std::span<const std::uint16_t> pixels, std::uint32_t width, std::uint32_t height,
                                std::optional<PngText> text = std::nullopt);
std::vector<std::byte> colour_png(std::span<const std::array<std::uint8_t, 3>> pixels, std::uint32_t width,
                                  std::uint32_t height);

}  // namespace vestige
