#include "transport/wire/crc16.hpp"

#include <boost/crc.hpp>

namespace vestige {

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace vestige
