#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "traces/files/output_file.hpp"

namespace vestige {

/// What becomes of a file whose program died, or could not write on.
enum class Unfinished : std::uint8_t { kKept, kRemoved };

/// A file that grows under its own name, for recordings that must survive the death of their program; `OutputFile` is
/// for everything that should be complete or absent, as this is with `Unfinished::kRemoved`.
///
/// A new file appears at once under its name; an existing one that may be overwritten is replaced only by `keep` or
/// `close`, by what is then safely on disk. Destroyed before either, it leaves nothing behind, and what was there
/// untouched. "-", devices and pipes are just written to.
class AppendFile {
 public:
  /// Throws `Error`: it exists (and `Overwrite::kRefuse`), no such folder, permission.
  AppendFile(std::filesystem::path path, Overwrite overwrite, Unfinished unfinished = Unfinished::kKept);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// Appends. When that fails, the bytes of this call are taken away again; a file worth keeping is renamed to
  /// NAME.partial, any other removed, and the `Error` thrown says which, and why.
  void write(std::span<const std::byte> bytes);
  /// From now on there is something worth keeping in it, under its name; not so with `Unfinished::kRemoved`. Throws
  /// `Error`.
  void keep();
  /// Brings what was written to disk. Throws `Error`.
  void sync();
  /// Syncs, gives the file its name and closes it. Throws `Error`.
  void close();

 private:
  void take_name();
  [[noreturn]] void fail(std::string_view doing, int error_number);
  std::filesystem::path set_aside();
  bool is_file() const { return !current_path_.empty(); }

  std::filesystem::path path_;
  std::filesystem::path current_path_;  ///< where the bytes are; empty when that is no regular file
  Overwrite overwrite_;
  Unfinished unfinished_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
  bool worth_keeping_ = false;
};

}  // namespace vestige
