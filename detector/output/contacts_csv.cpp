#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "detector/output/contact_rows.hpp"
#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z";

class ContactsCsv final : public ContactsFile {
 public:
  ContactsCsv(const std::filesystem::path& path, Overwrite overwrite);
  void write(const DetectorFrame& frame, const ContactRow& row,
             const std::vector<std::uint32_t>& collider_ids) override;
  void commit() override { file_.commit(); }

 private:
  OutputFile file_;
  std::string text_;
};

ContactsCsv::ContactsCsv(const std::filesystem::path& path, Overwrite overwrite) : file_(path, overwrite) {
  file_.write(fmt::format("{}\n", kHeader));
}

void ContactsCsv::write(const DetectorFrame& frame, const ContactRow& row,
                        const std::vector<std::uint32_t>& collider_ids) {
  text_.clear();
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit()) continue;
    const glm::dvec3 world_m = frame.origin_m + contact.position;
    fmt::format_to(std::back_inserter(text_), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", frame.index, frame.time_s,
                   collider_ids[column], contact.triangle, contact.t, contact.barycentric.x, contact.barycentric.y,
                   contact.texture_coordinate.x, contact.texture_coordinate.y, contact.actuator, contact.side,
                   world_m.x, world_m.y, world_m.z);
  }
  file_.write(text_);
}

}  // namespace

std::unique_ptr<ContactsFile> make_contacts_csv(const std::filesystem::path& path, Overwrite overwrite) {
  return std::make_unique<ContactsCsv>(path, overwrite);
}

std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits) {
  const std::string text = read_text_file(path);
  CsvLines lines(text, path.string(), kHeader, kContactsRemedy);
  std::vector<RecordedContact> contacts;
  while (lines.next()) {
    RecordedContact contact;
    glm::dvec2& weights = contact.barycentric;
    double ignored = 0;
    bool finite = true;
    const auto skip = [&](int columns) {
      while (columns > 0 && lines.take(ignored)) {
        finite = finite && std::isfinite(ignored);
        --columns;
      }
      return columns == 0;
    };
    if (!lines.take(contact.frame) || !skip(1) || !lines.take(contact.collider) || !lines.take(contact.triangle) ||
        !lines.take(contact.t) || !lines.take(weights.x) || !lines.take(weights.y) || !skip(2) ||
        !lines.take(contact.actuator) || !skip(4) || !lines.at_end())
      throw lines.error("is not a row of contacts");
    if (!finite) throw lines.error("time, texture coordinates and position must be finite");
    if (const auto fault = fault_of(contact, limits)) throw lines.error(fault->cause, fault->remedy);
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace vestige
