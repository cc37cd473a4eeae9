#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detector/output/contact_rows.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/hdf5/hdf5_table.hpp"
#include "traces/hdf5/hdf5_writer.hpp"

namespace vestige {

namespace {

constexpr const char* kFormat = "vestige contacts";
constexpr const char* kVersion = "1";
constexpr hsize_t kBlockRows = 65536;

/// The columns of the CSV, in its order.
std::vector<Hdf5Column::Description> columns() {
  const Hdf5Library& h5 = hdf5();
  const auto column = [](const char* name, hid_t type, std::size_t bytes, const char* units, const char* description) {
    return Hdf5Column::Description{name, type, bytes, {}, units, {}, description};
  };
  return {column("frame", h5.uint64, 8, "", "number of the frame in the trace"),
          column("time_s", h5.float64, 8, "s", "time of the frame"),
          column("collider", h5.uint32, 4, "", "id of the collider in the trace"),
          column("triangle", h5.uint32, 4, "", "triangle of the avatar, from 0 on"),
          column("t", h5.float32, 4, "1", "when within the frame's step: 0 at its start, 1 at its end"),
          column("u", h5.float64, 8, "1", "weight of the triangle's second vertex"),
          column("v", h5.float64, 8, "1", "weight of the triangle's third vertex"),
          column("texture_u", h5.float64, 8, "1", "texture coordinate, not wrapped"),
          column("texture_v", h5.float64, 8, "1", "texture coordinate, not wrapped"),
          column("actuator", h5.uint16, 2, "", "from 1 on; 0 if no actuator covers the skin there"),
          column("side", h5.int8, 1, "", "+1 entering, -1 leaving, 0 coplanar"),
          column("x", h5.float64, 8, "m", "place in the world"),
          column("y", h5.float64, 8, "m", "place in the world; up"),
          column("z", h5.float64, 8, "m", "place in the world")};
}

class ContactsHdf5 final : public ContactsFile {
 public:
  ContactsHdf5(const std::filesystem::path& path, Overwrite overwrite,
               const std::map<std::string, std::string>& attributes)
      : file_(path, overwrite) {
    write_hdf5_attribute(file_.id(), "format", kFormat, path);
    write_hdf5_attribute(file_.id(), "format_version", kVersion, path);
    for (const auto& [key, value] : attributes) write_hdf5_attribute(file_.id(), key, value, path);
    for (Hdf5Column::Description& column : columns()) columns_.emplace_back(file_.id(), path, std::move(column));
  }

  void write(const DetectorFrame& frame, const ContactRow& row,
             const std::vector<std::uint32_t>& collider_ids) override {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Contact& contact = row[i];
      if (!contact.hit()) continue;
      const std::uint64_t index = frame.index;
      const double time_s = frame.time_s;
      const glm::dvec3 world_m = frame.origin_m + contact.position;
      const glm::dvec2& texture = contact.texture_coordinate;
      const void* values[] = {&index,
                              &time_s,
                              &collider_ids[i],
                              &contact.triangle,
                              &contact.t,
                              &contact.barycentric.x,
                              &contact.barycentric.y,
                              &texture.x,
                              &texture.y,
                              &contact.actuator,
                              &contact.side,
                              &world_m.x,
                              &world_m.y,
                              &world_m.z};
      for (std::size_t column = 0; column < columns_.size(); ++column) columns_[column].append(values[column]);
    }
  }

  void commit() override {
    for (Hdf5Column& column : columns_) column.close();
    file_.commit();
  }

 private:
  Hdf5Output file_;
  std::vector<Hdf5Column> columns_;
};

/// All columns of a file, of equal length.
class ContactTables {
 public:
  explicit ContactTables(const std::filesystem::path& path) : path_(path), file_(open_hdf5(path, kContactsRemedy)) {
    const std::string format = read_hdf5_attribute(file_.id(), path, "/", "format").value_or("");
    if (format != kFormat)
      throw Error(path.string(), fmt::format("its attribute format is '{}', not '{}'", format, kFormat),
                  kContactsRemedy);
    const std::string version = read_hdf5_attribute(file_.id(), path, "/", "format_version").value_or("");
    if (version != kVersion)
      throw Error(path.string(), fmt::format("its format version is '{}', not {}", version, kVersion),
                  "use the later version of vestige that wrote it");
    for (const Hdf5Column::Description& column : columns())
      tables_.emplace_back(file_.id(), path, column.name, kContactsRemedy);
    for (const Hdf5Table& table : tables_) table.expect({rows()});
    // Deflate packs at most 1032 bytes into one.
    if (rows() > 1032 * std::filesystem::file_size(path)) tables_[0].fail("has more rows than the file can hold");
  }

  hsize_t rows() const { return tables_[0].dimensions()[0]; }

  /// Appends the contacts from row `first` on, at most `kBlockRows`.
  void read(hsize_t first, const ContactLimits& limits, std::vector<RecordedContact>& contacts) {
    const hsize_t count = std::min(kBlockRows, rows() - first);
    tables_[0].read(first, count, frame_);
    tables_[2].read(first, count, collider_);
    tables_[3].read(first, count, triangle_);
    tables_[4].read(first, count, t_);
    tables_[5].read(first, count, u_);
    tables_[6].read(first, count, v_);
    tables_[9].read(first, count, actuator_);
    tables_[10].read(first, count, side_);
    for (const std::size_t column : {1U, 7U, 8U, 11U, 12U, 13U}) {
      tables_[column].read(first, count, ignored_);
      const auto odd = std::ranges::find_if_not(ignored_, [](double number) { return std::isfinite(number); });
      if (odd != ignored_.end())
        tables_[column].fail(fmt::format("has {} in row {}, and must be finite", *odd,
                                         first + static_cast<hsize_t>(odd - ignored_.begin())));
    }
    for (std::size_t i = 0; i < count; ++i) {
      contacts.push_back({frame_[i], collider_[i], triangle_[i], t_[i], {u_[i], v_[i]}, actuator_[i]});
      if (const auto fault = fault_of(contacts.back(), limits))
        throw Error(path_.string(), fmt::format("its table {}, row {}: {}", fault->column, first + i, fault->cause),
                    fault->remedy);
    }
  }

 private:
  std::filesystem::path path_;
  Hdf5Handle file_;
  std::vector<Hdf5Table> tables_;  ///< in the order of `columns`
  std::vector<std::uint64_t> frame_;
  std::vector<std::uint32_t> collider_;
  std::vector<std::uint32_t> triangle_;
  std::vector<float> t_;
  std::vector<double> u_;
  std::vector<double> v_;
  std::vector<std::uint16_t> actuator_;
  std::vector<std::int64_t> side_;
  std::vector<double> ignored_;
};

std::vector<RecordedContact> read_all(const std::filesystem::path& path, const ContactLimits& limits) {
  ContactTables tables(path);
  std::vector<RecordedContact> contacts;
  for (hsize_t first = 0; first < tables.rows(); first += kBlockRows) tables.read(first, limits, contacts);
  return contacts;
}

}  // namespace

std::unique_ptr<ContactsFile> make_contacts_hdf5(const std::filesystem::path& path, Overwrite overwrite,
                                                 const std::map<std::string, std::string>& attributes) {
  return std::make_unique<ContactsHdf5>(path, overwrite, attributes);
}

std::vector<RecordedContact> read_contacts_hdf5(const std::filesystem::path& path, const ContactLimits& limits) {
  static_cast<void>(hdf5());
  try_hdf5(path, [&] { read_all(path, limits); });
  return read_all(path, limits);
}

}  // namespace vestige
