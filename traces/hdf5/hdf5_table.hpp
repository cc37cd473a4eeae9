#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "traces/hdf5/hdf5_library.hpp"

namespace vestige {

/// Remedies for files that are not as they should be.
inline constexpr const char* kHdf5DamagedRemedy = "write it again, or take an undamaged copy";
inline constexpr const char* kHdf5TypeRemedy = "convert it to the documented type, for example with numpy's astype";
inline constexpr const char* kHdf5Remedy =
    "name a file that 'vestige export' wrote, or a file with the same tables (FORMAT.md)";

/// A table of numbers in an HDF5 file that any program may have written. Every function throws `Error` with file and
/// table.
class Hdf5Table {
 public:
  /// Throws if the table does not exist, has no rank from 1 to 3, or holds no numbers.
  /// `remedy` is that of `fail`.
  Hdf5Table(hid_t file, const std::filesystem::path& path, std::string name, const char* remedy = kHdf5Remedy);

  const std::vector<hsize_t>& dimensions() const { return dimensions_; }

  [[noreturn]] void fail(std::string_view cause) const { fail(cause, remedy_); }
  [[noreturn]] void fail(std::string_view cause, const char* remedy) const;

  /// Throws unless the table has this shape. A first size of 0 stands for any size.
  void expect(const std::vector<hsize_t>& shape) const;

  /// Reads the rows from `first` to `first + rows - 1`. Throws if a number of the table's type may not fit a `Number`.
  template <typename Number>
  void read(hsize_t first, hsize_t rows, std::vector<Number>& out) const {
    static_assert(!std::is_integral_v<Number> || std::is_unsigned_v<Number> || sizeof(Number) == 8);
    out.resize(numbers_in(rows));
    if (!out.empty())
      read({.kind = std::is_floating_point_v<Number> ? H5T_FLOAT : H5T_INTEGER,
            .bytes = sizeof(Number),
            .is_signed = std::is_signed_v<Number>},
           first, rows, out.data());
  }

 private:
  /// A kind of number.
  struct Type {
    H5T_class_t kind = H5T_NO_CLASS;
    std::size_t bytes = 0;
    bool is_signed = false;
    bool fits_into(const Type& other) const;
  };

  std::size_t numbers_in(hsize_t rows) const;
  void read(const Type& type, hsize_t first, hsize_t rows, void* out) const;

  /// Whether the file has no such table. Otherwise one that cannot be opened is damaged.
  bool is_missing(hid_t file) const;

  std::filesystem::path path_;
  std::string name_;
  const char* remedy_;
  Hdf5Handle dataset_;
  Type type_;
  std::vector<hsize_t> dimensions_;
};

}  // namespace vestige
