#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "traces/base/error.hpp"

namespace vestige {

enum class Overwrite { kRefuse, kAllow };

/// A file that is complete or absent: bytes go to a temporary file in the same folder, `commit` syncs it and gives it
/// its name. Destroyed without `commit`, it leaves nothing behind. The name "-" is standard output, written as it
/// comes.
///
/// Every function throws `Error` naming the file: it exists (and `Overwrite::kRefuse`), no such folder, permission,
/// disk full.
class OutputFile {
 public:
  OutputFile(std::filesystem::path path, Overwrite overwrite);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Hands what was written so far to the system: for readers of standard output, a device or a pipe.
  void flush();
  void commit();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_path_;
  Overwrite overwrite_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// Gives a finished, synced file its name, in the same folder. Throws `Error`, also where `path` exists by now and may
/// not be overwritten; then the file keeps its temporary name.
void give_name(const std::filesystem::path& temporary_path, const std::filesystem::path& path, Overwrite overwrite);

/// The file that a link leads to, which need not be there; any other path, and links to devices, as they are. A link
/// stays a link when that is written instead. Throws `Error`: links in a circle, an open file without a name.
std::filesystem::path where_it_leads(std::filesystem::path path);

/// Permissions of a new file, under the process's umask.
mode_t new_file_mode();

/// Throws `Error` when `path` exists and may not be overwritten: to be called before long work, not after it.
void refuse_overwrite(const std::filesystem::path& path, Overwrite overwrite);

/// With those that it lies in; one that is there stays. Throws `Error`.
void make_folder(const std::filesystem::path& folder);

/// Throws `UsageError` when standard output is a terminal: binary data would garble it.
void refuse_terminal(std::string_view flag);

/// Writes all of `bytes` to `descriptor`; throws `Error` naming `path`, `ReaderGone` for a pipe that nobody reads.
void write_all(int descriptor, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace vestige
