#include "cli/files/exported_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detector/output/contact_columns.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_library.hpp"

namespace vestige::cli {

namespace {

ContactLimits limits_of(const OpenTrace& trace) {
  ContactLimits limits;
  limits.people.clear();
  for (const TracedPerson& person : trace.people)
    limits.people.push_back({person.avatar.triangles.size(), person.map.actuator_count});
  return limits;
}

}  // namespace

ExportedContacts::ExportedContacts(const std::string& file, OpenTrace& trace)
    : file_(file),
      has_spheres_(trace.reader.has_spheres()),
      has_avatars_(trace.people.size() > 1),
      contacts_(read_contacts(file, limits_of(trace))) {
  const std::vector<std::uint32_t>& collider_ids = trace.reader.collider_ids();
  for (const RecordedContact& contact : contacts_)
    if (!std::ranges::binary_search(collider_ids, contact.collider))
      refuse(fmt::format("has a contact of collider {}, which the trace does not have", contact.collider));
}

void ExportedContacts::check(const TraceFrame& frame) {
  constexpr double kRounding_s = 1e-9;  // of files that other programs wrote
  for (; next_ < contacts_.size() && contacts_[next_].frame <= frame.index; ++next_) {
    const RecordedContact& contact = contacts_[next_];
    if (contact.frame < frame.index) refuse_frame(contact.frame);
    if (std::abs(contact.time_s - frame.time_s()) > kRounding_s)
      refuse(fmt::format("has frame {} at {} s, and the trace has it at {} s", contact.frame, contact.time_s,
                         frame.time_s()));
  }
}

void ExportedContacts::write(hid_t file, const std::filesystem::path& path) const {
  if (next_ < contacts_.size()) refuse_frame(contacts_[next_].frame);
  const Hdf5Handle group(hdf5().create_group(file, "contacts", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         hdf5().close_group, path, "make a group");
  const bool has_depths = contacts_.empty() ? has_spheres_ : contacts_.front().depth_m.has_value();
  ContactColumns columns(group.id(), path,
                         {has_depths ? ColliderShape::kSpheres : ColliderShape::kPoints, has_avatars_});
  for (const RecordedContact& contact : contacts_) columns.append(contact);
  columns.close();
}

void ExportedContacts::refuse_frame(std::uint64_t frame) const {
  refuse(fmt::format("has a contact in frame {}, which the trace does not have", frame));
}

void ExportedContacts::refuse(const std::string& cause) const {
  throw Error(file_, cause, "name the contacts of this trace: vestige replay TRACE --contacts FILE");
}

}  // namespace vestige::cli
