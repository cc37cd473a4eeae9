#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vestige {

/// HDF5's functions, with the types of its own header, and the number types of files.
struct Hdf5Library {
  decltype(&::H5open) open;
  decltype(&::H5free_memory) free_memory;
  decltype(&::H5Eset_auto2) set_error_printing;
  decltype(&::H5Fcreate) create_file;
  decltype(&::H5Fopen) open_file;
  decltype(&::H5Fclose) close_file;
  decltype(&::H5Gcreate2) create_group;
  decltype(&::H5Gclose) close_group;
  decltype(&::H5Screate) create_space;
  decltype(&::H5Screate_simple) create_simple_space;
  decltype(&::H5Sselect_hyperslab) select_hyperslab;
  decltype(&::H5Sget_simple_extent_ndims) rank;
  decltype(&::H5Sget_simple_extent_dims) dimensions;
  decltype(&::H5Sget_simple_extent_npoints) element_count;
  decltype(&::H5Sclose) close_space;
  decltype(&::H5Pcreate) create_properties;
  decltype(&::H5Pset_chunk) set_chunk;
  decltype(&::H5Pset_shuffle) set_shuffle;
  decltype(&::H5Pset_deflate) set_deflate;
  decltype(&::H5Pset_fletcher32) set_fletcher32;
  decltype(&::H5Pset_libver_bounds) set_versions;
  decltype(&::H5Pclose) close_properties;
  decltype(&::H5Dcreate2) create_dataset;
  decltype(&::H5Dopen2) open_dataset;
  decltype(&::H5Dget_space) space_of;
  decltype(&::H5Dget_type) type_of;
  decltype(&::H5Dset_extent) set_extent;
  decltype(&::H5Dwrite) write;
  decltype(&::H5Dread) read;
  decltype(&::H5Dclose) close_dataset;
  decltype(&::H5Lexists) link_exists;
  decltype(&::H5Lvisit) visit_links;
  decltype(&::H5Acreate2) create_attribute;
  decltype(&::H5Awrite) write_attribute;
  decltype(&::H5Aexists_by_name) attribute_exists;
  decltype(&::H5Aopen_by_name) open_attribute;
  decltype(&::H5Aget_type) attribute_type;
  decltype(&::H5Aget_space) attribute_space;
  decltype(&::H5Aread) read_attribute;
  decltype(&::H5Aclose) close_attribute;
  decltype(&::H5Tcopy) copy_type;
  decltype(&::H5Tget_class) class_of;
  decltype(&::H5Tget_size) size_of;
  decltype(&::H5Tget_sign) sign_of;
  decltype(&::H5Tis_variable_str) is_variable_text;
  decltype(&::H5Tset_size) set_size;
  decltype(&::H5Tset_strpad) set_padding;
  decltype(&::H5Tset_cset) set_character_set;
  decltype(&::H5Tclose) close_type;
  // Plain values, because the library's own macros name variables that are only found at run time.
  hid_t float32;
  hid_t float64;
  hid_t int64;
  hid_t uint64;
  hid_t uint32;
  hid_t uint16;
  hid_t uint8;
  hid_t int8;
  hid_t text;
  hid_t dataset_creation;
  hid_t file_access;
};

// The header's macros for these would call the library as if it were linked.
inline constexpr unsigned kHdf5ReadOnly = 0;  ///< H5F_ACC_RDONLY
inline constexpr unsigned kHdf5Truncate = 2;  ///< H5F_ACC_TRUNC

/// Returns the library. It is opened by the first call and never closed; at exit it does not close objects that are
/// still open. Throws `Error` if libhdf5 is not installed.
const Hdf5Library& hdf5();

/// Owns an HDF5 identifier, which HDF5 counts references of. A negative identifier means failure.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  /// Does not check `id`; the caller does.
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  /// Throws `Error` at `path`, saying what failed, if the identifier is negative.
  Hdf5Handle(hid_t id, Close close, const std::filesystem::path& path, std::string_view doing);
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    reset();
    id_ = std::exchange(other.id_, -1);
    close_ = std::exchange(other.close_, nullptr);
    return *this;
  }
  hid_t id() const { return id_; }
  /// Closes the identifier and returns HDF5's result, which is negative for a failure.
  herr_t reset() {
    const herr_t result = id_ >= 0 && close_ != nullptr ? close_(id_) : 0;
    id_ = -1;
    return result;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Throws `Error` at `path` if `result` is negative.
void hdf5_check(herr_t result, const std::filesystem::path& path, std::string_view doing);

}  // namespace vestige
