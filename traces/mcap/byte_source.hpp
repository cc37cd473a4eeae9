#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige::mcap {

/// Bytes that can be read anywhere. The size never changes.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// What errors call it.
  virtual std::string name() const = 0;
  virtual std::uint64_t size() const = 0;
  /// Fills `out`. Precondition: offset + out.size() <= size(). Throws `Error` when reading fails.
  virtual void read_at(std::uint64_t offset, std::span<std::byte> out) const = 0;
};

/// A regular file, read with pread: never mapped, since a mapped file that shrinks kills its reader. What is no regular
/// file ("-", standard input, or a pipe) is first copied to a temporary file without a name.
class FileSource final : public ByteSource {
 public:
  /// Throws `Error`: no such file, a folder, unreadable.
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

/// Bytes in memory, which must stay there.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::string name() const override { return "memory"; }
  std::uint64_t size() const override { return bytes_.size(); }
  void read_at(std::uint64_t offset, std::span<std::byte> out) const override;

 private:
  std::span<const std::byte> bytes_;
};

/// Reads small pieces of a source in an order that mostly goes forward, with few system calls and 4 KiB of memory.
class ReadWindow {
 public:
  explicit ReadWindow(const ByteSource& source) : source_(source) {}
  /// `count` bytes at `offset`, valid until the next call. Precondition: they are within the source.
  std::span<const std::byte> at(std::uint64_t offset, std::size_t count);

 private:
  const ByteSource& source_;
  std::vector<std::byte> window_;
  std::uint64_t start_ = 0;
};

}  // namespace vestige::mcap
