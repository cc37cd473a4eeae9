#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "traces/files/output_file.hpp"

namespace vestige {

/// Returns the folder for temporary files: $TMPDIR if set, otherwise /tmp. Throws `Error` if it is not a folder.
std::filesystem::path temporary_folder();

enum class ScratchName { kNone, kKept };

/// A temporary file that is deleted with this object, for data that do not fit into memory before they are written in
/// order. It lies in the folder of `beside`, or in the temporary folder if `beside` is "-", a device or a pipe. It has
/// a name only with `ScratchName::kKept`, so that a library can open it. Throws `Error`.
class ScratchFile {
 public:
  explicit ScratchFile(const std::filesystem::path& beside, ScratchName name = ScratchName::kNone);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void append(std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> into) const;

  /// Empty if the file has no name.
  const std::filesystem::path& path() const { return path_; }
  /// Copies the whole file to `file`, including bytes that a library wrote to it.
  void copy_to(OutputFile& file) const;

 private:
  std::filesystem::path beside_;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace vestige
