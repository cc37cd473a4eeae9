#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vestige::mcap {

/// CRC-32 (IEEE 802.3, as in zip and PNG). `before` is the CRC of the bytes that precede `bytes`, or 0 if there are
/// none.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace vestige::mcap
