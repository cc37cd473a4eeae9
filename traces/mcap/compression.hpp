#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace vestige::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// MCAP's name for it: "", "lz4" (the LZ4 frame format) or "zstd".
std::string_view name_of(Compression compression);

/// Memory of which only what is written becomes resident: a file that claims 256 MiB costs nothing until it delivers
/// them.
class RawBuffer {
 public:
  /// Makes room for `size` bytes of unspecified content.
  std::span<std::byte> reset(std::size_t size);
  std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<std::byte[]> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Appends the compressed form of `bytes` to `out`. zstd at level 1, which writes 340 MB/s.
void compress(Compression compression, std::span<const std::byte> bytes, std::vector<std::byte>& out);

/// Expands `bytes` to exactly `size` bytes in `out`. Throws `Malformed`: an unknown compression, a `size` beyond
/// kMaxChunkBytes, content that is damaged or expands to another size.
void decompress(std::string_view compression, std::span<const std::byte> bytes, std::uint64_t size, RawBuffer& out);

/// Expands as much of `bytes` as can be expanded, block by block, to at most `limit` bytes, which are returned in
/// `out`: for content that is cut or damaged. An unknown compression gives nothing.
std::span<const std::byte> decompress_beginning(std::string_view compression, std::span<const std::byte> bytes,
                                                std::size_t limit, RawBuffer& out);

}  // namespace vestige::mcap
