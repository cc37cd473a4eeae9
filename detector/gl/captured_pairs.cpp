#include "detector/gl/captured_pairs.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "shaders/constants.h"
#include "traces/base/error.hpp"

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

CapturedPairs::CapturedPairs(const GlFunctions& gl) : gl_(gl), buffer_(gl), timer_(gl) {
  GLint64 block_bytes = 0;
  gl_.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_bytes);
  largest_ = std::min((static_cast<std::size_t>(block_bytes) - sizeof(Head)) / sizeof(CapturedPair), kLargestCount);
  grow(kStartingCapacity);
}

void CapturedPairs::begin() {
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_CAPTURED, buffer_.name());
  const Head head = {0, static_cast<std::uint32_t>(capacity_)};
  buffer_.upload(&head, sizeof(head), GL_STREAM_READ);
}

std::size_t CapturedPairs::read(std::size_t items) {
  struct Beginning {
    Head head;
    std::array<CapturedPair, kPairsReadAtOnce> pairs;
  } beginning;
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl_.GetNamedBufferSubData(buffer_.name(), 0, sizeof(beginning), &beginning);
  check_gl(gl_, "capturing pairs");
  const std::size_t count = beginning.head.count;
  if (count > capacity_) {
    if (count > largest_ && items == 1)
      throw Error("OpenGL",
                  fmt::format("{} pairs of segment and triangle do not fit into the driver's largest buffer, {} pairs",
                              count, largest_),
                  "use --detector cpu, or fewer colliders");
    grow(count);
    return count > largest_ ? items / 2 : items;
  }
  pairs_.resize(count);
  const std::size_t read = std::min(count, kPairsReadAtOnce);
  std::copy_n(beginning.pairs.begin(), read, pairs_.begin());
  if (count > read) {
    gl_.GetNamedBufferSubData(buffer_.name(), static_cast<GLintptr>(sizeof(beginning)),
                              static_cast<GLsizeiptr>((count - read) * sizeof(CapturedPair)), &pairs_[read]);
    check_gl(gl_, "reading captured pairs");
  }
  return 0;
}

void CapturedPairs::grow(std::size_t pairs) {
  capacity_ = std::min(std::bit_ceil(pairs), largest_);
  buffer_.upload(nullptr, sizeof(Head) + capacity_ * sizeof(CapturedPair), GL_STREAM_READ);
}

}  // namespace vestige
