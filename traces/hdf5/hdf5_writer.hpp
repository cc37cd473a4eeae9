#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"
#include "traces/files/scratch_file.hpp"
#include "traces/hdf5/hdf5_library.hpp"

namespace vestige {

// Every function here throws `Error` with the file's name, if HDF5 fails or is not installed.

/// Writes a text in UTF-8 as an attribute of `object`, which is a file, a group or a table. It must be shorter than
/// 64 KiB.
void write_hdf5_attribute(hid_t object, const std::string& name, const std::string& text,
                          const std::filesystem::path& path);

/// An HDF5 file that is complete or absent: without `commit` it leaves nothing behind. The metadata of its tables have
/// checksums.
class Hdf5Output {
 public:
  Hdf5Output(const std::filesystem::path& path, Overwrite overwrite);
  hid_t id() const { return h5_file_.id(); }
  /// Precondition: everything in the file is closed.
  void commit();

 private:
  OutputFile file_;
  std::filesystem::path path_;
  ScratchFile scratch_;
  Hdf5Handle h5_file_;
};

/// A table that grows row by row: chunked, deflated, with checksums, written one chunk at a time.
class Hdf5Column {
 public:
  struct Description {
    std::string name;
    hid_t type;
    std::size_t element_bytes;
    std::vector<hsize_t> row;  ///< dimensions of one row; empty for a number
    std::string units;         ///< an attribute, left out if empty, as those below
    std::string axes = {};
    std::string description = {};
  };

  Hdf5Column(hid_t file, const std::filesystem::path& path, Description description);
  /// Appends a row, which is as large as its type and dimensions say.
  void append(const void* row);
  /// Writes what is left, and closes the table.
  void close();

 private:
  void flush();
  std::vector<hsize_t> dimensions(hsize_t rows) const;

  std::filesystem::path path_;
  Description description_;
  Hdf5Handle dataset_;
  std::size_t row_bytes_ = 0;
  std::size_t chunk_rows_ = 1;
  std::vector<std::byte> waiting_;
  std::size_t waiting_rows_ = 0;
  hsize_t rows_ = 0;
};

}  // namespace vestige
