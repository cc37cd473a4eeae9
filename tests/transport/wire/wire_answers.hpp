#pragma once

#include <cstdint>
#include <vector>

#include "transport/wire/cobs.hpp"
#include "transport/wire/crc16.hpp"

// What a board sends, put together for tests.

namespace vestige::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes sealed(Bytes payload) {
  const std::uint16_t crc = crc16(payload);
  payload.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  payload.push_back(static_cast<std::uint8_t>(crc >> 8U));
  Bytes frame = cobs_encode(payload);
  frame.push_back(0);
  return frame;
}

inline Bytes acknowledgement(std::uint8_t sequence, std::uint8_t flags, std::uint8_t receive_errors) {
  return sealed({'A', sequence, flags, receive_errors});
}

inline Bytes greeting(std::uint8_t sequence, std::uint8_t version, std::uint8_t actuators, std::uint8_t flags) {
  return sealed({'H', sequence, version, actuators, flags});
}

}  // namespace vestige::test
