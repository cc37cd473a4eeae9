#pragma once

#include <filesystem>
#include <functional>

#include "traces/files/output_file.hpp"

namespace vestige {

/// A folder that is either complete or absent. Files are written into a hidden folder beside it, and `commit` moves
/// them into place. Without `commit`, the destructor removes the hidden folder. With `Overwrite::kAllow`, an existing
/// folder stays, and new files replace old files of the same name.
///
/// Throws `Error` if the folder has files (with `Overwrite::kRefuse`), is not a folder, or cannot be made or written.
class GrowingFolder {
 public:
  GrowingFolder(std::filesystem::path folder, Overwrite overwrite);
  ~GrowingFolder();
  GrowingFolder(const GrowingFolder&) = delete;
  GrowingFolder& operator=(const GrowingFolder&) = delete;

  /// Returns the hidden folder, into which files are written.
  const std::filesystem::path& path() const { return growing_; }
  /// Moves the files into place. `is_stale` says which files of an existing folder come from an earlier run and are
  /// removed.
  void commit(const std::function<bool(const std::filesystem::path&)>& is_stale);

 private:
  std::filesystem::path folder_;
  std::filesystem::path growing_;
};

}  // namespace vestige
