#include "traces/hdf5/hdf5_library.hpp"

#include <fmt/format.h>

#include "traces/base/error.hpp"
#include "traces/base/shared_library.hpp"

namespace vestige {

namespace {

SharedLibrary open_library() {
  // HDF5 1.10 is Debian 12's version; other systems use the plain name.
  constexpr const char* kNames[] = {"libhdf5_serial.so.103", "libhdf5.so.103"};
  for (const char* name : kNames) {
    try {
      return SharedLibrary(name);
    } catch (const Error&) {
      if (name == kNames[1]) throw;
    }
  }
  return SharedLibrary(kNames[0]);
}

Hdf5Library load() {
  Hdf5Library all = {};
  try {
    const SharedLibrary library = open_library();
    library.find("H5open", all.open);
    library.find("H5free_memory", all.free_memory);
    library.find("H5Eset_auto2", all.set_error_printing);
    library.find("H5Fcreate", all.create_file);
    library.find("H5Fopen", all.open_file);
    library.find("H5Fclose", all.close_file);
    library.find("H5Gcreate2", all.create_group);
    library.find("H5Gclose", all.close_group);
    library.find("H5Screate", all.create_space);
    library.find("H5Screate_simple", all.create_simple_space);
    library.find("H5Sselect_hyperslab", all.select_hyperslab);
    library.find("H5Sget_simple_extent_ndims", all.rank);
    library.find("H5Sget_simple_extent_dims", all.dimensions);
    library.find("H5Sget_simple_extent_npoints", all.element_count);
    library.find("H5Sclose", all.close_space);
    library.find("H5Pcreate", all.create_properties);
    library.find("H5Pset_chunk", all.set_chunk);
    library.find("H5Pset_shuffle", all.set_shuffle);
    library.find("H5Pset_deflate", all.set_deflate);
    library.find("H5Pset_fletcher32", all.set_fletcher32);
    library.find("H5Pset_libver_bounds", all.set_versions);
    library.find("H5Pclose", all.close_properties);
    library.find("H5Dcreate2", all.create_dataset);
    library.find("H5Dopen2", all.open_dataset);
    library.find("H5Dget_space", all.space_of);
    library.find("H5Dget_type", all.type_of);
    library.find("H5Dset_extent", all.set_extent);
    library.find("H5Dwrite", all.write);
    library.find("H5Dread", all.read);
    library.find("H5Dclose", all.close_dataset);
    library.find("H5Lexists", all.link_exists);
    library.find("H5Lvisit", all.visit_links);
    library.find("H5Acreate2", all.create_attribute);
    library.find("H5Awrite", all.write_attribute);
    library.find("H5Aexists_by_name", all.attribute_exists);
    library.find("H5Aopen_by_name", all.open_attribute);
    library.find("H5Aget_type", all.attribute_type);
    library.find("H5Aget_space", all.attribute_space);
    library.find("H5Aread", all.read_attribute);
    library.find("H5Aclose", all.close_attribute);
    library.find("H5Tcopy", all.copy_type);
    library.find("H5Tget_class", all.class_of);
    library.find("H5Tget_size", all.size_of);
    library.find("H5Tget_sign", all.sign_of);
    library.find("H5Tis_variable_str", all.is_variable_text);
    library.find("H5Tset_size", all.set_size);
    library.find("H5Tset_strpad", all.set_padding);
    library.find("H5Tset_cset", all.set_character_set);
    library.find("H5Tclose", all.close_type);
    // HDF5's exit handler would crash on a file that could not be flushed. Users of the library close their objects.
    decltype(&::H5dont_atexit) leave_exit_alone = nullptr;
    library.find("H5dont_atexit", leave_exit_alone);
    static_cast<void>(leave_exit_alone());
    if (all.open() < 0) throw Error("libhdf5", "cannot be started", "");
    // Our own errors report failures, so HDF5 must not print them.
    all.set_error_printing(H5E_DEFAULT, nullptr, nullptr);
    const auto value = [&](const char* name) {
      hid_t* variable = nullptr;
      library.find(name, variable);
      return *variable;
    };
    all.float32 = value("H5T_IEEE_F32LE_g");
    all.float64 = value("H5T_IEEE_F64LE_g");
    all.int64 = value("H5T_STD_I64LE_g");
    all.uint64 = value("H5T_STD_U64LE_g");
    all.uint32 = value("H5T_STD_U32LE_g");
    all.uint16 = value("H5T_STD_U16LE_g");
    all.uint8 = value("H5T_STD_U8LE_g");
    all.int8 = value("H5T_STD_I8LE_g");
    all.text = value("H5T_C_S1_g");
    all.dataset_creation = value("H5P_CLS_DATASET_CREATE_ID_g");
    all.file_access = value("H5P_CLS_FILE_ACCESS_ID_g");
  } catch (const Error& error) {
    throw Error("HDF5", fmt::format("cannot be opened: {}", error.what()), "install the package libhdf5-103-1");
  }
  return all;
}

}  // namespace

const Hdf5Library& hdf5() {
  static const Hdf5Library library = load();
  return library;
}

Hdf5Handle::Hdf5Handle(hid_t id, Close close, const std::filesystem::path& path, std::string_view doing)
    : id_(id), close_(close) {
  if (id < 0) throw Error(path.string(), fmt::format("HDF5 could not {}", doing), "check that the disk is not full");
}

void hdf5_check(herr_t result, const std::filesystem::path& path, std::string_view doing) {
  if (result < 0)
    throw Error(path.string(), fmt::format("HDF5 could not {}", doing), "check that the disk is not full");
}

}  // namespace vestige
