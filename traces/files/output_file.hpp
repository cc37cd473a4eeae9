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

/// A file that is complete or absent. Bytes go to a temporary file in the same folder; `commit` syncs it and gives it
/// its name. If this object is destroyed without `commit`, it leaves nothing behind. The name "-" is standard output,
/// which is written to directly, like a device or a pipe.
///
/// Every function throws `Error` with the name of the file: it exists (with `Overwrite::kRefuse`), no such folder, no
/// permission, disk full.
class OutputFile {
 public:
  OutputFile(std::filesystem::path path, Overwrite overwrite);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Passes the bytes written so far to the system, for readers of standard output, a device or a pipe.
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

/// Gives a finished, synced file its name, in the same folder. Throws `Error` if it cannot, or if `path` exists by now
/// and must not be overwritten. The file then keeps its temporary name.
void give_name(const std::filesystem::path& temporary_path, const std::filesystem::path& path, Overwrite overwrite);

/// Returns the target of a symbolic link, which need not exist. Returns any other path, and a link to a device,
/// unchanged. Writing to the target keeps the link a link. Throws `Error` if links form a circle, or the target is an
/// open file without a name.
std::filesystem::path where_it_leads(std::filesystem::path path);

/// Returns the permissions of a new file: 0666 without the bits of the process's umask.
mode_t new_file_mode();

/// Throws `Error` if `path` exists and may not be overwritten, or lies where no file may be made. Call this before long
/// work, not after it.
void refuse_overwrite(const std::filesystem::path& path, Overwrite overwrite);

/// Creates `folder` and its parents if they do not exist. Throws `Error`.
void make_folder(const std::filesystem::path& folder);

/// Throws `UsageError` if standard output is a terminal, because binary data would garble it.
void refuse_terminal(std::string_view flag);

/// Writes all of `bytes` to `descriptor`. Throws `Error` with the name of `path`, or `PipeClosed` if the pipe has no
/// reader.
void write_all(int descriptor, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace vestige
