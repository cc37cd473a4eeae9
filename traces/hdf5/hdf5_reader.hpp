#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traces/hdf5/hdf5_library.hpp"

namespace vestige {

// For files that any program may have written. Every function throws `Error` with the name of the file.

/// Whether the name ends as those of HDF5 files do: .h5, .hdf5.
bool has_hdf5_name(const std::filesystem::path& path);

/// Whether `path` is a regular file that begins as HDF5 files do. Never throws, and reads nothing from pipes.
bool is_hdf5(const std::filesystem::path& path);

/// Opens a file to read it. `remedy` is for a file that does not exist as HDF5.
Hdf5Handle open_hdf5(const std::filesystem::path& path, const char* remedy);

/// Calls `read_all` in a child process, because HDF5 may crash on a damaged file. Throws if it crashes or does not
/// finish; ignores other errors. Precondition: no threads have been started.
void try_hdf5(const std::filesystem::path& path, const std::function<void()>& read_all);

/// Returns the paths of all tables and groups, ascending: "colliders", "colliders/id". Reads none of them.
/// Precondition: no threads have been started.
std::vector<std::string> hdf5_names(const std::filesystem::path& path);

/// What a text is stored as.
struct Hdf5TextShape {
  hid_t type;
  hid_t space;
};

/// Returns all texts of a table or an attribute, of fixed or variable length. `what` names it in errors. `read` fills
/// memory of the file's own type, and returns a negative number if it fails.
std::vector<std::string> read_hdf5_texts(const std::filesystem::path& path, const std::string& what,
                                         const Hdf5TextShape& shape, const std::function<herr_t(void*)>& read);

/// Returns the text of a group's attribute, if both exist.
std::optional<std::string> read_hdf5_attribute(hid_t file, const std::filesystem::path& path, const char* group,
                                               const std::string& key);

}  // namespace vestige
