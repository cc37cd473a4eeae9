#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "traces/files/output_file.hpp"

namespace vestige {

/// What happens to the file if the program dies, or cannot continue writing.
enum class Unfinished : std::uint8_t { kKept, kRemoved };

/// A file that grows under its own name, for recordings that must survive the death of the program. With
/// `Unfinished::kRemoved` the file is complete or absent. `OutputFile` is for all other files that should be complete
/// or absent.
///
/// A new file appears under its name at once. An existing file that may be overwritten is replaced only by `keep` or
/// `close`, after the new bytes are safely on disk. If this object is destroyed before either, it leaves no new file
/// and does not touch the existing one. "-", devices and pipes are written to directly.
class AppendFile {
 public:
  /// Throws `Error` if the file exists (with `Overwrite::kRefuse`), its folder does not exist, or permission is
  /// missing.
  AppendFile(std::filesystem::path path, Overwrite overwrite, Unfinished unfinished = Unfinished::kKept);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// Appends bytes. If that fails, removes the bytes of this call from the file. A file worth keeping is then renamed
  /// to NAME.partial, any other is deleted. The `Error` thrown gives the cause and the name of a kept file.
  void write(std::span<const std::byte> bytes);
  /// Marks the file as worth keeping, and gives it its name. Does nothing with `Unfinished::kRemoved`. Throws `Error`.
  void keep();
  /// Syncs the written bytes to disk. Throws `Error`.
  void sync();
  /// Syncs, gives the file its name and closes it. Throws `Error`.
  void close();

 private:
  void take_name();
  [[noreturn]] void fail(std::string_view doing, int error_number);
  std::filesystem::path set_aside();
  bool is_file() const { return !current_path_.empty(); }

  std::filesystem::path path_;
  std::filesystem::path current_path_;  ///< the file that holds the bytes; empty for "-", devices and pipes
  Overwrite overwrite_;
  Unfinished unfinished_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
  bool worth_keeping_ = false;
};

}  // namespace vestige
