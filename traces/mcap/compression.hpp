#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace vestige::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// Returns MCAP's name: "", "lz4" (the LZ4 frame format) or "zstd".
std::string_view name_of(Compression compression);

/// A buffer that is not initialised, so that only pages written to become resident. A file that claims 256 MiB costs no
/// memory until it delivers them.
class RawBuffer {
 public:
  /// Makes room for `size` bytes and returns them; their content is unspecified.
  std::span<std::byte> reset(std::size_t size);
  std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<std::byte[]> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Appends the compressed form of `bytes` to `out`. zstd runs at level 1, which compresses 340 MB/s.
void compress(Compression compression, std::span<const std::byte> bytes, std::vector<std::byte>& out);

/// Expands `bytes` to exactly `size` bytes in `out`. Throws `Malformed` if the compression is unknown, `size` exceeds
/// kMaxChunkBytes, or the content is damaged or expands to another size.
void decompress(std::string_view compression, std::span<const std::byte> bytes, std::uint64_t size, RawBuffer& out);

/// Expands cut or damaged content, block by block, as far as possible and to at most `limit` bytes. Returns the bytes,
/// which lie in `out`. Returns no bytes if the compression is unknown.
std::span<const std::byte> decompress_beginning(std::string_view compression, std::span<const std::byte> bytes,
                                                std::size_t limit, RawBuffer& out);

}  // namespace vestige::mcap
