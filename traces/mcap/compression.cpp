#include "traces/mcap/compression.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

namespace {

constexpr int kZstdLevel = 1;

struct FreeZstd {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

// One context a thread, because making one costs more than compressing a small chunk.
ZSTD_CCtx& zstd_compressor() {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeZstd> context(ZSTD_createCCtx());
  if (!context) throw std::bad_alloc();
  return *context;
}

ZSTD_DCtx& zstd_decompressor() {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  return *context;
}

void expand_zstd(std::span<const std::byte> bytes, std::span<std::byte> out) {
  const std::size_t size =
      ZSTD_decompressDCtx(&zstd_decompressor(), out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) throw Malformed(fmt::format("its zstd data is damaged ({})", ZSTD_getErrorName(size)));
  if (size != out.size()) throw Malformed("it expands to fewer bytes than it claims");
}

void expand_lz4(std::span<const std::byte> bytes, std::span<std::byte> out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  std::size_t hint = 1;
  while (!bytes.empty()) {
    std::size_t produced = out.size();
    std::size_t consumed = bytes.size();
    hint = LZ4F_decompress(context.get(), out.data(), &produced, bytes.data(), &consumed, nullptr);
    if (LZ4F_isError(hint) != 0) throw Malformed(fmt::format("its lz4 data is damaged ({})", LZ4F_getErrorName(hint)));
    if (produced == 0 && consumed == 0) throw Malformed("it expands to more bytes than it claims");
    out = out.subspan(produced);
    bytes = bytes.subspan(consumed);
  }
  if (hint != 0) throw Malformed("its lz4 data ends early, or is longer than it claims");
  if (!out.empty()) throw Malformed("it expands to fewer bytes than it claims");
}

// If a call ends in an error, both libraries discard what that call expanded. So each call gets one block: the number
// of input bytes the library asks for completes exactly one block.

std::size_t expand_zstd_beginning(std::span<const std::byte> bytes, std::span<std::byte> out) {
  ZSTD_DCtx& context = zstd_decompressor();
  std::size_t wanted = ZSTD_initDStream(&context);
  ZSTD_outBuffer target = {out.data(), out.size(), 0};
  while (!bytes.empty() && target.pos < target.size && wanted != 0 && ZSTD_isError(wanted) == 0) {
    ZSTD_inBuffer block = {bytes.data(), std::min(wanted, bytes.size()), 0};
    const std::size_t before = target.pos;
    wanted = ZSTD_decompressStream(&context, &target, &block);
    if (block.pos == 0 && target.pos == before) break;
    bytes = bytes.subspan(block.pos);
  }
  return target.pos;
}

std::size_t expand_lz4_beginning(std::span<const std::byte> bytes, std::span<std::byte> out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  std::size_t written = 0;
  std::size_t wanted = LZ4F_MIN_SIZE_TO_KNOW_HEADER_LENGTH;
  while (!bytes.empty() && written < out.size() && wanted != 0) {
    std::size_t produced = out.size() - written;
    std::size_t consumed = std::min(wanted, bytes.size());
    wanted = LZ4F_decompress(context.get(), out.data() + written, &produced, bytes.data(), &consumed, nullptr);
    if (LZ4F_isError(wanted) != 0 || (produced == 0 && consumed == 0)) break;
    written += produced;
    bytes = bytes.subspan(consumed);
  }
  return written;
}

constexpr std::size_t kMostNameBytes = 200;  ///< longest part of a name from a file that an error message quotes

}  // namespace

std::string_view name_of(Compression compression) {
  switch (compression) {
    case Compression::kNone:
      return "";
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
  }
  return "";
}

std::span<std::byte> RawBuffer::reset(std::size_t size) {
  if (size > capacity_) {
    data_.reset();
    capacity_ = 0;
    data_ = std::make_unique_for_overwrite<std::byte[]>(size);
    capacity_ = size;
  }
  size_ = size;
  return {data_.get(), size_};
}

void compress(Compression compression, std::span<const std::byte> bytes, std::vector<std::byte>& out) {
  const std::size_t before = out.size();
  std::size_t size = 0;
  switch (compression) {
    case Compression::kNone:
      out.insert(out.end(), bytes.begin(), bytes.end());
      return;
    case Compression::kZstd:
      out.resize(before + ZSTD_compressBound(bytes.size()));
      size = ZSTD_compressCCtx(&zstd_compressor(), out.data() + before, out.size() - before, bytes.data(), bytes.size(),
                               kZstdLevel);
      if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
      break;
    case Compression::kLz4: {
      LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
      preferences.frameInfo.contentSize = bytes.size();
      out.resize(before + LZ4F_compressFrameBound(bytes.size(), &preferences));
      size = LZ4F_compressFrame(out.data() + before, out.size() - before, bytes.data(), bytes.size(), &preferences);
      if (LZ4F_isError(size) != 0) throw std::runtime_error(LZ4F_getErrorName(size));
      break;
    }
  }
  out.resize(before + size);
}

void decompress(std::string_view compression, std::span<const std::byte> bytes, std::uint64_t size, RawBuffer& out) {
  if (size > kMaxChunkBytes)
    throw Malformed(fmt::format("it claims to expand to {} bytes, more than the {} allowed", size, kMaxChunkBytes));
  const std::span<std::byte> target = out.reset(static_cast<std::size_t>(size));
  if (compression.empty()) {
    if (bytes.size() != size) throw Malformed("its size is not the size that it claims");
    if (size > 0) std::memcpy(target.data(), bytes.data(), bytes.size());
  } else if (compression == name_of(Compression::kZstd)) {
    expand_zstd(bytes, target);
  } else if (compression == name_of(Compression::kLz4)) {
    expand_lz4(bytes, target);
  } else {
    throw Malformed(
        fmt::format("its compression '{}' is not one of \"\", lz4 and zstd", compression.substr(0, kMostNameBytes)));
  }
}

std::span<const std::byte> decompress_beginning(std::string_view compression, std::span<const std::byte> bytes,
                                                std::size_t limit, RawBuffer& out) {
  const std::span<std::byte> target = out.reset(limit);
  std::size_t written = 0;
  if (compression.empty()) {
    written = std::min(bytes.size(), limit);
    if (written > 0) std::memcpy(target.data(), bytes.data(), written);
  } else if (compression == name_of(Compression::kZstd)) {
    written = expand_zstd_beginning(bytes, target);
  } else if (compression == name_of(Compression::kLz4)) {
    written = expand_lz4_beginning(bytes, target);
  }
  return target.first(written);
}

}  // namespace vestige::mcap
