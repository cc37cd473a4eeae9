#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

/// Contacts that an export takes along. Every function throws `Error` with the file of the contacts, if they do not
/// belong to the trace.
class ExportedContacts {
 public:
  /// Reads the contacts of `file`, which must be of people and colliders of `trace`. Precondition: no threads have been
  /// started.
  ExportedContacts(const std::string& file, OpenTrace& trace);

  /// Checks the contacts of the next frame of the trace.
  void check(const TraceFrame& frame);
  /// Checks that the trace had the frames of all contacts, and writes them into the group `contacts` of an HDF5 file.
  void write(hid_t file, const std::filesystem::path& path) const;

  std::size_t count() const { return contacts_.size(); }

 private:
  [[noreturn]] void refuse_frame(std::uint64_t frame) const;
  [[noreturn]] void refuse(const std::string& cause) const;

  std::string file_;
  bool has_spheres_;
  bool has_avatars_;
  std::vector<RecordedContact> contacts_;  ///< by frame
  std::size_t next_ = 0;                   ///< those before it are checked
};

}  // namespace vestige::cli
