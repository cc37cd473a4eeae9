#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "traces/files/output_file.hpp"

namespace vestige {

/// The folder for temporary files: $TMPDIR, else /tmp. Throws `Error` where it is none.
std::filesystem::path temporary_folder();

enum class ScratchName { kNone, kKept };

/// A file that goes when this object does: for what does not fit into memory before it is written in order. It lies in
/// the folder of `beside` (of "-": where temporary files are), without a name unless a library is to open it. Throws
/// `Error`.
class ScratchFile {
 public:
  explicit ScratchFile(const std::filesystem::path& beside, ScratchName name = ScratchName::kNone);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void append(std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> into) const;

  /// Empty without a name.
  const std::filesystem::path& path() const { return path_; }
  /// Writes all of it, whoever wrote it.
  void copy_to(OutputFile& file) const;

 private:
  std::filesystem::path beside_;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace vestige
