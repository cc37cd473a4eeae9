#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vestige {

// Consistent Overhead Byte Stuffing (Cheshire and Baker, SIGCOMM 1997): frames without a zero in them, so that a zero
// ends a frame whatever came before it. One byte more for every 254 begun.

/// The frame without the zero that ends it.
std::vector<std::uint8_t> cobs_encode(std::span<const std::uint8_t> payload);

/// The payload of a frame that stood before a zero; none when no payload gives this frame.
std::optional<std::vector<std::uint8_t>> cobs_decode(std::span<const std::uint8_t> frame);

}  // namespace vestige
