#include "traces/gltf/glb_container.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vestige::gltf {

namespace {

static_assert(std::endian::native == std::endian::little,
              "glTF stores little-endian numbers, which are copied as they are");

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::string at(std::size_t offset) {
  return fmt::format("byte {}", offset);
}

/// Checks the header and returns the file without the bytes after its stated length.
std::span<const std::byte> check_header(std::span<const std::byte> glb, Report& report) {
  if (glb.size() < kHeaderBytes)
    report.fail(at(glb.size()), fmt::format("{} bytes are too few for a GLB header of {}", glb.size(), kHeaderBytes),
                "name a complete .glb, .vrm or .gltf file");
  if (read_u32(glb, 0) != kMagic)
    report.fail(at(0), "does not start with 'glTF', so it is not a binary glTF file",
                "name a .glb, .vrm or .gltf file");
  if (const std::uint32_t version = read_u32(glb, 4); version != 2)
    report.fail(at(4), fmt::format("is GLB version {}, but only 2 can be read", version),
                "export the file as glTF 2.0");
  const std::size_t length = read_u32(glb, 8);
  if (length < kHeaderBytes + kChunkHeaderBytes)
    report.fail(at(8), fmt::format("a length of {} bytes leaves no room for a chunk", length));
  if (length > glb.size())
    report.fail(at(8), fmt::format("says {} bytes, but the file has only {}", length, glb.size()),
                "the file was cut short: copy or download it again");
  if (length < glb.size()) report.warn(at(length), "ignored the bytes after the end of the glTF");
  return glb.first(length);
}

}  // namespace

GlbChunks split_glb(std::span<const std::byte> glb, Report& report) {
  const std::span<const std::byte> file = check_header(glb, report);
  GlbChunks chunks;
  std::size_t index = 0;
  for (std::size_t offset = kHeaderBytes; offset < file.size(); ++index) {
    if (file.size() - offset < kChunkHeaderBytes) report.fail(at(offset), "the chunk header is cut short");
    const std::size_t length = read_u32(file, offset);
    const std::uint32_t type = read_u32(file, offset + 4);
    const std::size_t left = file.size() - offset - kChunkHeaderBytes;
    if (length > left)
      report.fail(at(offset), fmt::format("the chunk claims {} bytes, but only {} are left", length, left));
    if (length % 4 != 0) report.warn(at(offset), "the chunk's length is not a multiple of 4");
    const std::span<const std::byte> content = file.subspan(offset + kChunkHeaderBytes, length);
    if (index == 0 && type != kJsonChunk) report.fail(at(offset), "the first chunk is not JSON");
    if (index == 0 && content.empty()) report.fail(at(offset), "the JSON chunk is empty");
    if (index > 0 && type == kJsonChunk) report.fail(at(offset), "has a second JSON chunk");
    if (index > 1 && type == kBinChunk) report.fail(at(offset), "a BIN chunk can only be the second chunk");
    if (type == kJsonChunk)
      chunks.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    else if (type == kBinChunk)
      chunks.bin = content;
    else
      report.warn(at(offset), "skipped a chunk of unknown type");
    offset += kChunkHeaderBytes + length;
  }
  return chunks;
}

std::vector<std::byte> join_glb(std::string_view json, std::span<const std::byte> bin, const Report& report) {
  const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
  const std::size_t total = kHeaderBytes + kChunkHeaderBytes + padded(json.size()) +
                            (bin.empty() ? 0 : kChunkHeaderBytes + padded(bin.size()));
  if (total > std::numeric_limits<std::uint32_t>::max())
    report.fail("", "needs more than the 4 GiB that a GLB can hold", "remove the parts that the avatar does not need");
  std::vector<std::byte> glb(total);
  std::size_t offset = 0;
  const auto put_u32 = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(glb.data() + offset, &word, sizeof word);
    offset += sizeof word;
  };
  const auto put_chunk = [&](std::uint32_t type, std::span<const std::byte> content, char padding) {
    put_u32(padded(content.size()));
    put_u32(type);
    std::memcpy(glb.data() + offset, content.data(), content.size());
    std::memset(glb.data() + offset + content.size(), padding, padded(content.size()) - content.size());
    offset += padded(content.size());
  };
  put_u32(kMagic);
  put_u32(2);
  put_u32(total);
  put_chunk(kJsonChunk, std::as_bytes(std::span(json)), ' ');
  if (!bin.empty()) put_chunk(kBinChunk, bin, '\0');
  return glb;
}

}  // namespace vestige::gltf
