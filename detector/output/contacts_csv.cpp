#include "detector/output/contacts_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "traces/base/csv.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z";
constexpr std::string_view kRemedy = "write it with 'vestige replay --contacts'";

}  // namespace

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

std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits) {
  const std::string text = read_text_file(path);
  CsvLines lines(text, path.string(), kHeader, kRemedy);
  std::vector<RecordedContact> contacts;
  const auto check = [&](const char* what, std::uint64_t number, std::uint64_t count) {
    if (number < count) return;
    throw lines.error(fmt::format("refers to {} {}, but there are only {}", what, number, count),
                      "use the contacts of this trace, avatar and map");
  };
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
    if (!(contact.t >= 0 && contact.t <= 1)) throw lines.error("t must be from 0 to 1");
    if (!(weights.x >= 0 && weights.x <= 1 && weights.y >= 0 && weights.y <= 1))
      throw lines.error("u and v must be weights from 0 to 1");
    check("frame", contact.frame, limits.frames);
    check("triangle", contact.triangle, limits.triangles);
    if (contact.actuator > limits.actuators) check("actuator", contact.actuator, limits.actuators);
    contacts.push_back(contact);
  }
  const auto place = [](const RecordedContact& contact) { return std::pair(contact.frame, contact.collider); };
  std::ranges::sort(contacts, {}, place);
  const auto twice = std::ranges::adjacent_find(contacts, {}, place);
  if (twice != contacts.end())
    throw Error(path.string(), fmt::format("collider {} has two contacts in frame {}", twice->collider, twice->frame),
                kRemedy);
  return contacts;
}

}  // namespace vestige
