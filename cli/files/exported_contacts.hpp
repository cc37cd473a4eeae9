#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "detector/output/recorded_contacts.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

/// Contacts that an export takes along. Every function throws `Error` with the file of the contacts, if they do not
/// belong to the trace.
class ExportedContacts {
 public:
  /// Reads the contacts of `file`. `collider_ids` are those of the trace, ascending; `limits` what it has.
  /// Precondition: no threads have been started.
  ExportedContacts(const std::string& file, std::span<const std::uint32_t> collider_ids, const ContactLimits& limits);

  /// Checks the contacts of the next frame of the trace.
  void check(const TraceFrame& frame);
  /// Checks that the trace had the frames of all contacts, and writes them into the group `contacts` of an HDF5 file.
  void write(hid_t file, const std::filesystem::path& path) const;

  std::size_t count() const { return contacts_.size(); }

 private:
  [[noreturn]] void refuse_frame(std::uint64_t frame) const;
  [[noreturn]] void refuse(const std::string& cause) const;

  std::string file_;
  std::vector<RecordedContact> contacts_;  ///< by frame
  std::size_t next_ = 0;                   ///< those before it are checked
};

}  // namespace vestige::cli
