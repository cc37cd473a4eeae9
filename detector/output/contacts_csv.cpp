#include <fmt/format.h>

#include <iterator>

#include "detector/output/contact_rows.hpp"
#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z";
constexpr std::string_view kHeaderOfSpheres =
    "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z,depth";

std::string_view header_of(ColliderShape shape) {
  return shape == ColliderShape::kSpheres ? kHeaderOfSpheres : kHeader;
}

class ContactsCsv final : public ContactsFile {
 public:
  ContactsCsv(const std::filesystem::path& path, Overwrite overwrite, ColliderShape shape);
  void write(const DetectorFrame& frame, const ContactRow& row,
             const std::vector<std::uint32_t>& collider_ids) override;
  void commit() override { file_.commit(); }

 private:
  ColliderShape shape_;
  OutputFile file_;
  std::string text_;
};

ContactsCsv::ContactsCsv(const std::filesystem::path& path, Overwrite overwrite, ColliderShape shape)
    : shape_(shape), file_(path, overwrite) {
  file_.write(fmt::format("{}\n", header_of(shape)));
}

void ContactsCsv::write(const DetectorFrame& frame, const ContactRow& row,
                        const std::vector<std::uint32_t>& collider_ids) {
  text_.clear();
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit()) continue;
    const RecordedContact one = recorded(frame, contact, collider_ids[column]);
    fmt::format_to(std::back_inserter(text_), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}", one.frame, one.time_s,
                   one.collider, one.triangle, one.t, one.barycentric.x, one.barycentric.y, one.texture_coordinate.x,
                   one.texture_coordinate.y, one.actuator, one.side, one.position_m.x, one.position_m.y,
                   one.position_m.z);
    if (shape_ == ColliderShape::kSpheres) fmt::format_to(std::back_inserter(text_), ",{}", contact.depth_m);
    text_ += '\n';
  }
  file_.write(text_);
}

}  // namespace

std::unique_ptr<ContactsFile> make_contacts_csv(const std::filesystem::path& path, Overwrite overwrite,
                                                ColliderShape shape) {
  return std::make_unique<ContactsCsv>(path, overwrite, shape);
}

std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits) {
  const std::string text = read_text_file(path);
  const bool has_depths = CsvLines::has_header(text, kHeaderOfSpheres);
  CsvLines lines(text, path.string(), has_depths ? kHeaderOfSpheres : kHeader, kContactsRemedy);
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
        (has_depths && !lines.take(contact.depth_m.emplace())) || !lines.at_end())
      throw lines.error("is not a row of contacts");
    if (const auto fault = fault_of(contact, limits)) throw lines.error(fault->cause, fault->remedy);
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace vestige
