#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vestige {

// Consistent Overhead Byte Stuffing (Cheshire and Baker, SIGCOMM 1997). Frames contain no zero, so a zero ends a frame
// whatever came before it. Adds one byte for every 254 bytes begun.

/// Returns the frame without the zero that ends it.
std::vector<std::uint8_t> cobs_encode(std::span<const std::uint8_t> payload);

/// Returns the payload of a frame (without its final zero), or nothing if no payload encodes to this frame.
std::optional<std::vector<std::uint8_t>> cobs_decode(std::span<const std::uint8_t> frame);

}  // namespace vestige
