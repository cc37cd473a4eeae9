#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "detector/output/contact_columns.hpp"
#include "detector/output/contact_rows.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/hdf5/hdf5_table.hpp"
#include "traces/hdf5/hdf5_writer.hpp"

namespace vestige {

namespace {

constexpr const char* kFormat = "vestige contacts";
constexpr const char* kVersion = "1";
constexpr const char* kDepth = "depth";    // only where colliders are spheres
constexpr const char* kAvatar = "avatar";  // only of several people
constexpr hsize_t kBlockRows = 65536;

class ContactsHdf5 final : public ContactsFile {
 public:
  ContactsHdf5(const std::filesystem::path& path, Overwrite overwrite,
               const std::map<std::string, std::string>& attributes, OptionalColumns columns)
      : file_(path, overwrite) {
    write_hdf5_attribute(file_.id(), "format", kFormat, path);
    write_hdf5_attribute(file_.id(), "format_version", kVersion, path);
    for (const auto& [key, value] : attributes) write_hdf5_attribute(file_.id(), key, value, path);
    columns_.emplace(file_.id(), path, columns);
  }

  void write(std::uint16_t avatar, const DetectorFrame& frame, const ContactRow& row,
             const std::vector<std::uint32_t>& collider_ids) override {
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i].hit()) columns_->append(recorded(avatar, frame, row[i], collider_ids[i]));
  }

  void commit() override {
    columns_->close();
    file_.commit();
  }

 private:
  Hdf5Output file_;
  std::optional<ContactColumns> columns_;
};

/// All columns of a file, of equal length.
class ContactTables {
 public:
  ContactTables(const std::filesystem::path& path, const ContactLimits& limits)
      : path_(path), limits_(limits), file_(open_hdf5(path, kContactsRemedy)) {
    const std::string format = read_hdf5_attribute(file_.id(), path, "/", "format").value_or("");
    if (format != kFormat)
      throw Error(path.string(), fmt::format("its attribute format is '{}', not '{}'", format, kFormat),
                  kContactsRemedy);
    const std::string version = read_hdf5_attribute(file_.id(), path, "/", "format_version").value_or("");
    if (version != kVersion)
      throw Error(path.string(), fmt::format("its format version is '{}', not {}", version, kVersion),
                  "use the later version of vestige that wrote it");
    if (hdf5().link_exists(file_.id(), kDepth, H5P_DEFAULT) > 0) optional_.shape = ColliderShape::kSpheres;
    optional_.has_avatars = hdf5().link_exists(file_.id(), kAvatar, H5P_DEFAULT) > 0;
    require_avatars(path, optional_, limits);
    for (const Hdf5Column::Description& column : contact_columns(optional_))
      tables_.emplace_back(file_.id(), path, column.name, kContactsRemedy);
    for (const Hdf5Table& table : tables_) table.expect({rows()});
    // Deflate packs at most 1032 bytes into one.
    if (rows() > 1032 * std::filesystem::file_size(path)) tables_[0].fail("has more rows than the file can hold");
  }

  hsize_t rows() const { return tables_[0].dimensions()[0]; }

  /// Appends the contacts from row `first` on, at most `kBlockRows`.
  void read(hsize_t first, std::vector<RecordedContact>& contacts) {
    const hsize_t count = std::min(kBlockRows, rows() - first);
    tables_[0].read(first, count, frame_);
    tables_[1].read(first, count, time_s_);
    tables_[2].read(first, count, collider_);
    tables_[3].read(first, count, triangle_);
    tables_[4].read(first, count, t_);
    tables_[5].read(first, count, u_);
    tables_[6].read(first, count, v_);
    tables_[7].read(first, count, texture_u_);
    tables_[8].read(first, count, texture_v_);
    tables_[9].read(first, count, actuator_);
    tables_[10].read(first, count, side_);
    tables_[11].read(first, count, x_m_);
    tables_[12].read(first, count, y_m_);
    tables_[13].read(first, count, z_m_);
    const bool has_depths = optional_.shape == ColliderShape::kSpheres;
    if (has_depths) tables_[14].read(first, count, depth_m_);
    if (optional_.has_avatars) tables_.back().read(first, count, avatar_);
    for (std::size_t i = 0; i < count; ++i) {
      constexpr std::int64_t kNoSide = 2;  // is refused
      contacts.push_back({.frame = frame_[i],
                          .time_s = time_s_[i],
                          .collider = collider_[i],
                          .triangle = triangle_[i],
                          .t = t_[i],
                          .barycentric = {u_[i], v_[i]},
                          .texture_coordinate = {texture_u_[i], texture_v_[i]},
                          .actuator = actuator_[i],
                          .side = static_cast<std::int8_t>(std::clamp(side_[i], -kNoSide, kNoSide)),
                          .position_m = {x_m_[i], y_m_[i], z_m_[i]}});
      if (has_depths) contacts.back().depth_m = depth_m_[i];
      if (optional_.has_avatars) contacts.back().avatar = avatar_[i];
      if (const auto fault = fault_of(contacts.back(), limits_))
        throw Error(path_.string(), fmt::format("its table {}, row {}: {}", fault->column, first + i, fault->cause),
                    fault->remedy);
    }
  }

 private:
  std::filesystem::path path_;
  ContactLimits limits_;
  Hdf5Handle file_;
  OptionalColumns optional_;
  std::vector<Hdf5Table> tables_;  ///< in the order of `contact_columns`
  std::vector<std::uint64_t> frame_;
  std::vector<double> time_s_;
  std::vector<std::uint32_t> collider_;
  std::vector<std::uint32_t> triangle_;
  std::vector<float> t_;
  std::vector<double> u_;
  std::vector<double> v_;
  std::vector<double> texture_u_;
  std::vector<double> texture_v_;
  std::vector<std::uint16_t> actuator_;
  std::vector<std::int64_t> side_;  // of any type of whole numbers, as other programs may write it
  std::vector<double> x_m_;
  std::vector<double> y_m_;
  std::vector<double> z_m_;
  std::vector<double> depth_m_;        ///< only of spheres
  std::vector<std::uint16_t> avatar_;  ///< only of several people
};

std::vector<RecordedContact> read_all(const std::filesystem::path& path, const ContactLimits& limits) {
  ContactTables tables(path, limits);
  std::vector<RecordedContact> contacts;
  for (hsize_t first = 0; first < tables.rows(); first += kBlockRows) tables.read(first, contacts);
  return contacts;
}

}  // namespace

std::unique_ptr<ContactsFile> make_contacts_hdf5(const std::filesystem::path& path, Overwrite overwrite,
                                                 const std::map<std::string, std::string>& attributes,
                                                 OptionalColumns columns) {
  return std::make_unique<ContactsHdf5>(path, overwrite, attributes, columns);
}

std::vector<RecordedContact> read_contacts_hdf5(const std::filesystem::path& path, const ContactLimits& limits) {
  static_cast<void>(hdf5());
  try_hdf5(path, [&] { read_all(path, limits); });
  return read_all(path, limits);
}

}  // namespace vestige
