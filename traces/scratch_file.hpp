#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "traces/output_file.hpp"

namespace vestige {

/// A file without a name, which goes when this object does: for what does not fit into memory before it is written in
/// order. It lies in the folder of `beside` (of "-": where temporary files are). Throws `Error`.
class ScratchFile {
 public:
  explicit ScratchFile(const std::filesystem::path& beside);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void append(std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> into) const;

  /// A name by which a library can open it while it is there.
  std::filesystem::path path() const;
  /// Writes all of it, whoever wrote it.
  void copy_to(OutputFile& file) const;

 private:
  std::filesystem::path beside_;
  int descriptor_ = -1;
};

}  // namespace vestige
