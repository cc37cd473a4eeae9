#include "detector/gl/captured_pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "shaders/constants.h"

namespace vestige {

namespace {

/// std430 layout of the shaders' Captured: this head, then the pairs.
struct Head {
  std::uint32_t count = 0;
  std::uint32_t capacity = 0;
};

/// The initial capacity, and the number of pairs that the first read-back fetches together with the head.
constexpr std::size_t kStartingCapacity = 1024;
constexpr std::size_t kPairsReadAtOnce = 64;

}  // namespace

CapturedPairs::CapturedPairs(const GlFunctions& gl) : gl_(gl), buffer_(gl) {
  grow(kStartingCapacity);
}

void CapturedPairs::begin() {
  const Head head = {0, static_cast<std::uint32_t>(capacity_)};
  buffer_.upload(&head, sizeof(head), GL_STREAM_READ);
}

bool CapturedPairs::read(std::vector<CapturedPair>& pairs) {
  struct Beginning {
    Head head;
    std::array<CapturedPair, kPairsReadAtOnce> pairs;
  } beginning;
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl_.GetNamedBufferSubData(buffer_.name(), 0, sizeof(beginning), &beginning);
  const std::size_t count = beginning.head.count;
  if (count > capacity_) {
    grow(count);
    return false;
  }
  pairs.resize(count);
  const std::size_t read = std::min(count, kPairsReadAtOnce);
  std::copy_n(beginning.pairs.begin(), read, pairs.begin());
  if (count > read)
    gl_.GetNamedBufferSubData(buffer_.name(), static_cast<GLintptr>(sizeof(beginning)),
                              static_cast<GLsizeiptr>((count - read) * sizeof(CapturedPair)), &pairs[read]);
  return true;
}

void CapturedPairs::grow(std::size_t pairs) {
  capacity_ = std::bit_ceil(pairs);
  buffer_.upload(nullptr, sizeof(Head) + capacity_ * sizeof(CapturedPair), GL_STREAM_READ);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_CAPTURED, buffer_.name());
}

}  // namespace vestige
