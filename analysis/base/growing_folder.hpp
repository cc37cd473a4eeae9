#pragma once

#include <filesystem>
#include <functional>

#include "traces/files/output_file.hpp"

namespace vestige::plot {

/// A folder that is complete or absent: files grow in a hidden folder beside it, and `commit` moves them. Destroyed
/// without `commit`, it leaves nothing behind. With `Overwrite::kAllow` an existing folder stays, and files in it are
/// replaced by those of the same name.
///
/// Every function throws `Error`: the folder has files (and `Overwrite::kRefuse`), no such folder, permission.
class GrowingFolder {
 public:
  GrowingFolder(std::filesystem::path folder, Overwrite overwrite);
  ~GrowingFolder();
  GrowingFolder(const GrowingFolder&) = delete;
  GrowingFolder& operator=(const GrowingFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& path() const { return growing_; }
  /// `is_stale`: which files of an existing folder are of an earlier run, and go.
  void commit(const std::function<bool(const std::filesystem::path&)>& is_stale);

 private:
  std::filesystem::path folder_;
  std::filesystem::path growing_;
};

}  // namespace vestige::plot
