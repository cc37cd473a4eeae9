#include "transport/wire/cobs.hpp"

#include <algorithm>

namespace vestige {

namespace {
/// A block of 254 bytes without a zero after it: the longest possible block.
constexpr std::uint8_t kFullBlock = 0xFF;
}  // namespace

std::vector<std::uint8_t> cobs_encode(std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame{1};
  frame.reserve(payload.size() + payload.size() / 254 + 1);
  std::size_t block = 0;  // index of the length of the block being written
  for (const std::uint8_t byte : payload) {
    // A new block begins only if a byte follows: nothing comes after a payload that ends with a full block.
    if (frame[block] == kFullBlock) {
      block = frame.size();
      frame.push_back(1);
    }
    if (byte == 0) {
      block = frame.size();
      frame.push_back(1);
    } else {
      frame.push_back(byte);
      ++frame[block];
    }
  }
  return frame;
}

std::optional<std::vector<std::uint8_t>> cobs_decode(std::span<const std::uint8_t> frame) {
  if (frame.empty() || std::find(frame.begin(), frame.end(), 0) != frame.end()) return std::nullopt;
  std::vector<std::uint8_t> payload;
  payload.reserve(frame.size());
  while (true) {
    const std::uint8_t block = frame.front();
    if (block > frame.size()) return std::nullopt;
    payload.insert(payload.end(), frame.begin() + 1, frame.begin() + block);
    frame = frame.subspan(block);
    if (frame.empty()) return payload;
    if (block != kFullBlock) payload.push_back(0);
  }
}

}  // namespace vestige
