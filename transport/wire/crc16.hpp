#pragma once

#include <cstdint>
#include <span>

namespace vestige {

/// CRC-16 of the vest's frames: polynomial 0x1021, initial value 0xFFFF, not reflected, not inverted at the end (known
/// as CRC-16/CCITT-FALSE; "123456789" gives 0x29B1). Detects every change of up to three bits.
std::uint16_t crc16(std::span<const std::uint8_t> bytes);

}  // namespace vestige
