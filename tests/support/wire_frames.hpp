#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// The vest's wire protocol, implemented a second time and as plainly as possible. The tests of the firmware and of the
// product's codec use it, and it shares no code with either. transport/firmware/README.md has the protocol as tables.
namespace vestige::test {

using Bytes = std::vector<std::uint8_t>;

/// Returns CRC-16/CCITT-FALSE, computed bit by bit.
inline std::uint16_t crc_ccitt_false(const std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const unsigned out = (crc >> 15) ^ ((static_cast<unsigned>(byte) >> bit) & 1U);
      crc = (crc << 1) & 0xFFFF;
      if (out != 0) crc ^= 0x1021;
    }
  }
  return static_cast<std::uint16_t>(crc);
}

/// Returns payload and CRC encoded with COBS, followed by 0x00.
inline Bytes wire_frame(Bytes payload) {
  const unsigned crc = crc_ccitt_false(payload);
  payload.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  payload.push_back(static_cast<std::uint8_t>(crc >> 8));
  // COBS puts a zero behind each message, so that every block ends with a zero.
  payload.push_back(0);
  Bytes frame;
  Bytes block;
  for (const std::uint8_t byte : payload) {
    if (byte != 0) block.push_back(byte);
    if (byte != 0 && block.size() < 254) continue;
    frame.push_back(static_cast<std::uint8_t>(block.size() + 1));
    frame.insert(frame.end(), block.begin(), block.end());
    block.clear();
  }
  frame.push_back(0);
  return frame;
}

/// Returns a frame of type 'S' or 'P': one level for each actuator, held for ttl hundredths of a second.
inline Bytes levels_frame(const char type, const std::uint8_t sequence, const std::uint8_t ttl_10ms,
                          const Bytes& levels) {
  Bytes payload = {static_cast<std::uint8_t>(type), sequence, ttl_10ms, static_cast<std::uint8_t>(levels.size())};
  payload.insert(payload.end(), levels.begin(), levels.end());
  return wire_frame(payload);
}

inline Bytes hello_frame(const std::uint8_t sequence) {
  return wire_frame({'H', sequence});
}
inline Bytes off_frame(const std::uint8_t sequence) {
  return wire_frame({'X', sequence, 0, 0});
}

/// Returns the payload of a frame without its delimiter, or nothing if COBS or CRC is wrong.
inline std::optional<Bytes> wire_payload(const std::span<const std::uint8_t> frame) {
  Bytes payload;
  for (std::size_t at = 0; at < frame.size();) {
    const std::size_t block_end = at + frame[at];
    if (frame[at] == 0 || block_end > frame.size()) return std::nullopt;
    payload.insert(payload.end(), frame.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                   frame.begin() + static_cast<std::ptrdiff_t>(block_end));
    if (frame[at] != 0xFF && block_end < frame.size()) payload.push_back(0);
    at = block_end;
  }
  if (payload.size() < 2) return std::nullopt;
  const unsigned sent = payload[payload.size() - 2] | (static_cast<unsigned>(payload.back()) << 8);
  payload.resize(payload.size() - 2);
  if (crc_ccitt_false(payload) != sent) return std::nullopt;
  return payload;
}

/// Returns the payloads of all whole frames that a board has sent. Damaged frames give empty payloads.
inline std::vector<Bytes> wire_payloads(const Bytes& line) {
  std::vector<Bytes> payloads;
  Bytes frame;
  for (const std::uint8_t byte : line) {
    if (byte != 0) {
      frame.push_back(byte);
    } else if (!frame.empty()) {
      payloads.push_back(wire_payload(frame).value_or(Bytes{}));
      frame.clear();
    }
  }
  return payloads;
}

}  // namespace vestige::test
