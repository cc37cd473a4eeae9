#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige::mcap {

/// A sequence of bytes with random access. Its size never changes.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// The name that error messages use.
  virtual std::string name() const = 0;
  virtual std::uint64_t size() const = 0;
  /// Fills `out`. Precondition: offset + out.size() <= size(). Throws `Error` when reading fails.
  virtual void read_at(std::uint64_t offset, std::span<std::byte> out) const = 0;
};

/// A file, read with pread. The file is never mapped, because a mapped file that shrinks kills its reader. Standard
/// input ("-"), pipes and devices have no random access, so their content is first copied to a nameless temporary file.
class FileSource final : public ByteSource {
 public:
  /// Throws `Error` if the file does not exist, is a folder, or cannot be read. Also throws if `path` is a device whose
  /// content does not begin as an MCAP file.
  explicit FileSource(const std::filesystem::path& path);
  ~FileSource() override;

  std::string name() const override { return path_.string(); }
  std::uint64_t size() const override { return size_; }
  void read_at(std::uint64_t offset, std::span<std::byte> out) const override;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Bytes in memory. The caller keeps them alive and unchanged.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::string name() const override { return "memory"; }
  std::uint64_t size() const override { return bytes_.size(); }
  void read_at(std::uint64_t offset, std::span<std::byte> out) const override;

 private:
  std::span<const std::byte> bytes_;
};

/// Reads small pieces of a source in mostly ascending order, with few system calls. Buffers 4 KiB, or the largest piece
/// that was asked for.
class ReadWindow {
 public:
  explicit ReadWindow(const ByteSource& source) : source_(source) {}
  /// Returns `count` bytes at `offset`, valid until the next call. Precondition: they lie within the source.
  std::span<const std::byte> at(std::uint64_t offset, std::size_t count);

 private:
  const ByteSource& source_;
  std::vector<std::byte> window_;
  std::uint64_t start_ = 0;
};

}  // namespace vestige::mcap
