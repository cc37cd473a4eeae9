#include <fmt/format.h>

#include <iterator>

#include "detector/output/contact_rows.hpp"
#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

std::string header_of(OptionalColumns columns) {
  return fmt::format("frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z{}{}",
                     columns.shape == ColliderShape::kSpheres ? ",depth" : "", columns.has_avatars ? ",avatar" : "");
}

/// Returns the columns that a text has, by its header; no optional ones if the header is unknown.
OptionalColumns columns_of(std::string_view text) {
  for (const ColliderShape shape : {ColliderShape::kPoints, ColliderShape::kSpheres})
    for (const bool has_avatars : {false, true})
      if (CsvLines::has_header(text, header_of({shape, has_avatars}))) return {shape, has_avatars};
  return {};
}

class ContactsCsv final : public ContactsFile {
 public:
  ContactsCsv(const std::filesystem::path& path, Overwrite overwrite, OptionalColumns columns);
  void write(std::uint16_t avatar, const DetectorFrame& frame, const ContactRow& row,
             const std::vector<std::uint32_t>& collider_ids) override;
  void commit() override { file_.commit(); }

 private:
  OptionalColumns columns_;
  OutputFile file_;
  std::string text_;
};

ContactsCsv::ContactsCsv(const std::filesystem::path& path, Overwrite overwrite, OptionalColumns columns)
    : columns_(columns), file_(path, overwrite) {
  file_.write(fmt::format("{}\n", header_of(columns)));
}

void ContactsCsv::write(std::uint16_t avatar, const DetectorFrame& frame, const ContactRow& row,
                        const std::vector<std::uint32_t>& collider_ids) {
  text_.clear();
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit()) continue;
    const RecordedContact one = recorded(avatar, frame, contact, collider_ids[column]);
    fmt::format_to(std::back_inserter(text_), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}", one.frame, one.time_s,
                   one.collider, one.triangle, one.t, one.barycentric.x, one.barycentric.y, one.texture_coordinate.x,
                   one.texture_coordinate.y, one.actuator, one.side, one.position_m.x, one.position_m.y,
                   one.position_m.z);
    if (columns_.shape == ColliderShape::kSpheres) fmt::format_to(std::back_inserter(text_), ",{}", contact.depth_m);
    if (columns_.has_avatars) fmt::format_to(std::back_inserter(text_), ",{}", avatar);
    text_ += '\n';
  }
  file_.write(text_);
}

}  // namespace

std::unique_ptr<ContactsFile> make_contacts_csv(const std::filesystem::path& path, Overwrite overwrite,
                                                OptionalColumns columns) {
  return std::make_unique<ContactsCsv>(path, overwrite, columns);
}

std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits) {
  const std::string text = read_text_file(path);
  const OptionalColumns columns = columns_of(text);
  const bool has_depths = columns.shape == ColliderShape::kSpheres;
  const std::string header = header_of(columns);
  CsvLines lines(text, path.string(), header, kContactsRemedy);
  require_avatars(path, columns, limits);
  std::vector<RecordedContact> contacts;
  while (lines.next()) {
    RecordedContact contact;
    glm::dvec2& weights = contact.barycentric;
    glm::dvec2& texture = contact.texture_coordinate;
    glm::dvec3& position = contact.position_m;
    if (!lines.take(contact.frame) || !lines.take(contact.time_s) || !lines.take(contact.collider) ||
        !lines.take(contact.triangle) || !lines.take(contact.t) || !lines.take(weights.x) || !lines.take(weights.y) ||
        !lines.take(texture.x) || !lines.take(texture.y) || !lines.take(contact.actuator) ||
        !lines.take(contact.side) || !lines.take(position.x) || !lines.take(position.y) || !lines.take(position.z) ||
        (has_depths && !lines.take(contact.depth_m.emplace())) ||
        (columns.has_avatars && !lines.take(contact.avatar)) || !lines.at_end())
      throw lines.error("is not a row of contacts");
    if (const auto fault = fault_of(contact, limits)) throw lines.error(fault->cause, fault->remedy);
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace vestige
