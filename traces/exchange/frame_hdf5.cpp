#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/hdf5/hdf5_writer.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostAttributeBytes = 60000;  // HDF5 holds 64 KiB in a header

class FrameHdf5 final : public TraceExport {
 public:
  FrameHdf5(const std::filesystem::path& path, Overwrite overwrite, TraceReader& trace,
            std::function<void(hid_t file)> write_more)
      : file_(path, overwrite),
        path_(path),
        write_more_(std::move(write_more)),
        shape_(trace.shape()),
        owners_(trace.owners()),
        ids_(trace.collider_ids()),
        owner_of_(ids_.size(), kNobody) {
    for (std::size_t i = 0; i < ids_.size(); ++i) place_of_[ids_[i]] = i;
    const Hdf5Library& h5 = hdf5();
    write_head(trace);
    add({"time_ns", h5.int64, 8, {}, "ns"});
    add({"frame", h5.uint64, 8, {}, ""});
    for (std::size_t person = 0; person < trace.people().size(); ++person) {
      const std::string pose = pose_group(person);
      const hsize_t nodes = trace.people()[person].node_names.size();
      add({pose + "/origin", h5.float64, 8, {3}, "m", "x, y, z; right-handed, +Y up, +Z forward"});
      add({pose + "/translation", h5.float32, 4, {nodes, 3}, "m", "x, y, z"});
      add({pose + "/rotation", h5.float32, 4, {nodes, 4}, "1", "x, y, z, w"});
      add({pose + "/scale", h5.float32, 4, {nodes, 3}, "1", "x, y, z"});
      poses_.push_back({.nodes = nodes});
    }
    const hsize_t colliders = ids_.size();
    add({"colliders/position", h5.float64, 8, {colliders, 3}, "m", "x, y, z; NaN where absent"});
    add({"colliders/present", h5.uint8, 1, {colliders}, ""});
    add({"colliders/teleported", h5.uint8, 1, {colliders}, ""});
    if (shape_ == ColliderShape::kSpheres)
      add({"colliders/radius", h5.float32, 4, {colliders}, "m", "0 is a point; NaN where absent"});
  }

  void write(const TraceFrame& frame) override {
    ++frames_;
    for (std::size_t person = 0; person < poses_.size(); ++person) take_pose(frame.poses[person], poses_[person]);
    position_.assign(3 * ids_.size(), std::numeric_limits<double>::quiet_NaN());
    radius_.assign(ids_.size(), std::numeric_limits<float>::quiet_NaN());
    present_.assign(ids_.size(), 0);
    teleported_.assign(ids_.size(), 0);
    for (const ColliderSample& collider : frame.colliders) {
      const std::size_t place = place_of_.at(collider.id);
      present_[place] = 1;
      owner_of_[place] = collider.owner;
      radius_[place] = collider.radius_m;
      for (int axis = 0; axis < 3; ++axis)
        position_[3 * place + static_cast<std::size_t>(axis)] = collider.position_m[axis];
    }
    for (const std::uint32_t id : frame.teleported)
      if (const auto place = place_of_.find(id); place != place_of_.end()) teleported_[place->second] = 1;
    std::vector<const void*> rows = {&frame.time_ns, &frame.index};
    for (const PoseRow& pose : poses_)
      rows.insert(rows.end(), {pose.origin.data(), pose.translation.data(), pose.rotation.data(), pose.scale.data()});
    rows.insert(rows.end(), {position_.data(), present_.data(), teleported_.data(), radius_.data()});
    for (std::size_t i = 0; i < datasets_.size(); ++i) datasets_[i].append(rows[i]);
  }

  void commit() override {
    if (frames_ == 0) throw Error(path_.string(), "there is no frame to export", "");
    for (Hdf5Column& dataset : datasets_) dataset.close();
    if (owners_ == Owners::kPeople)
      write_whole("colliders/owner", hdf5().uint16, owner_of_.size(), owner_of_.data(), Checksum::kYes);
    if (write_more_) write_more_(file_.id());
    file_.commit();
  }

  std::vector<std::string> losses() const override {
    if (poses_missing_ == 0) return {};
    return {fmt::format("{} missing, of which all numbers became NaN", counted(poses_missing_, "pose"))};
  }

 private:
  void add(Hdf5Column::Description description) { datasets_.emplace_back(file_.id(), path_, std::move(description)); }

  /// A row of a person's tables.
  struct PoseRow {
    std::size_t nodes = 0;
    std::vector<double> origin = {};
    std::vector<float> translation = {};
    std::vector<float> rotation = {};
    std::vector<float> scale = {};
  };

  static std::string pose_group(std::size_t person) { return trace_format::numbered("pose", person); }

  /// A missing pose is one that is not finite.
  void take_pose(const Pose& pose, PoseRow& row) {
    row.origin = {pose.origin_m.x, pose.origin_m.y, pose.origin_m.z};
    row.translation.clear();
    row.rotation.clear();
    row.scale.clear();
    for (const NodeLocal& node : pose.nodes) {
      row.translation.insert(row.translation.end(), {node.translation.x, node.translation.y, node.translation.z});
      row.rotation.insert(row.rotation.end(), {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w});
      row.scale.insert(row.scale.end(), {node.scale.x, node.scale.y, node.scale.z});
    }
    if (pose.nodes.size() == row.nodes) return;
    ++poses_missing_;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    row.translation.assign(3 * row.nodes, kNan);
    row.rotation.assign(4 * row.nodes, kNan);
    row.scale.assign(3 * row.nodes, kNan);
  }

  /// Makes names valid, so that `import` accepts them.
  static std::string text_of(std::string_view key, const std::string& value) {
    const bool is_name = key == trace_format::kNameKey || key.starts_with(std::string(trace_format::kNameKey) + ".");
    return is_name ? readable_name(value) : value;
  }

  void write_head(TraceReader& trace) {
    const Hdf5Library& h5 = hdf5();
    write_hdf5_attribute(file_.id(), "format", "vestige trace", path_);
    const int version = owners_ == Owners::kPeople ? trace_format::kPeopleVersion : trace_format::version_with(shape_);
    write_hdf5_attribute(file_.id(), "format_version", fmt::format("{}", version), path_);
    std::vector<std::string> groups;
    for (std::size_t person = 0; person < trace.people().size(); ++person) groups.push_back(pose_group(person));
    groups.insert(groups.end(), {"colliders", "session"});
    for (const std::string& group : groups) {
      Hdf5Handle made(h5.create_group(file_.id(), group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), h5.close_group,
                      path_, "make a group");
      if (group != "session") continue;
      for (const auto& [key, value] : trace.session())
        if (value.size() < kMostAttributeBytes) write_hdf5_attribute(made.id(), key, text_of(key, value), path_);
    }
    for (std::size_t i = 0; i < trace.people().size(); ++i) {
      using trace_format::AttachmentKind;
      const RecordedPerson& person = trace.people()[i];
      write_bytes(trace_format::attachment_name(AttachmentKind::kAvatar, i), person.avatar_glb);
      write_bytes(trace_format::attachment_name(AttachmentKind::kMapImage, i), person.actuator_map_png);
      write_bytes(trace_format::attachment_name(AttachmentKind::kMapText, i), person.actuator_map_json);
      write_node_names(pose_group(i) + "/node_names", person.node_names);
    }
    write_whole("colliders/id", h5.uint32, ids_.size(), ids_.data(), Checksum::kYes);
  }

  enum class Checksum { kNo, kYes };  ///< attachments have their own SHA-256

  void write_whole(const std::string& name, hid_t type, std::size_t count, const void* data,
                   Checksum checksum = Checksum::kNo) {
    const Hdf5Library& h5 = hdf5();
    const hsize_t size = count;
    const Hdf5Handle how(h5.create_properties(h5.dataset_creation), h5.close_properties, path_, "make properties");
    if (checksum == Checksum::kYes && count > 0) {
      hdf5_check(h5.set_chunk(how.id(), 1, &size), path_, "choose chunks");
      hdf5_check(h5.set_fletcher32(how.id()), path_, "choose checksums");
    }
    const Hdf5Handle space(h5.create_simple_space(1, &size, nullptr), h5.close_space, path_, "make a space");
    Hdf5Handle dataset(
        h5.create_dataset(file_.id(), name.c_str(), type, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
        h5.close_dataset, path_, fmt::format("make {}", name));
    const std::string doing = fmt::format("write {}", name);
    if (count > 0) hdf5_check(h5.write(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), path_, doing);
    hdf5_check(dataset.reset(), path_, doing);
  }

  void write_bytes(const std::string& name, std::span<const std::byte> bytes) {
    if (!bytes.empty()) write_whole(name, hdf5().uint8, bytes.size(), bytes.data());
  }

  /// Writes texts of fixed length, because texts of variable length are stored apart, without a checksum.
  void write_node_names(const std::string& table, const std::vector<std::string>& names) {
    const Hdf5Library& h5 = hdf5();
    std::size_t longest = 1;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    std::string texts(names.size() * longest, '\0');
    for (std::size_t i = 0; i < names.size(); ++i) texts.replace(i * longest, names[i].size(), names[i]);
    const Hdf5Handle type(h5.copy_type(h5.text), h5.close_type, path_, "make a type");
    hdf5_check(h5.set_size(type.id(), longest), path_, "make a type");
    hdf5_check(h5.set_padding(type.id(), H5T_STR_NULLPAD), path_, "make a type");
    hdf5_check(h5.set_character_set(type.id(), H5T_CSET_UTF8), path_, "make a type");
    write_whole(table, type.id(), names.size(), texts.data(), Checksum::kYes);
  }

  Hdf5Output file_;
  std::filesystem::path path_;
  std::function<void(hid_t file)> write_more_;
  ColliderShape shape_;
  Owners owners_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint16_t> owner_of_;  ///< by the place of the id
  std::map<std::uint32_t, std::size_t> place_of_;
  std::vector<Hdf5Column> datasets_;
  std::uint64_t frames_ = 0;
  std::vector<PoseRow> poses_;
  std::uint64_t poses_missing_ = 0;
  std::vector<double> position_;
  std::vector<float> radius_;
  std::vector<std::uint8_t> present_;
  std::vector<std::uint8_t> teleported_;
};

}  // namespace

std::unique_ptr<TraceExport> make_frame_hdf5(const std::filesystem::path& path, Overwrite overwrite, TraceReader& trace,
                                             std::function<void(hid_t file)> write_more) {
  return std::make_unique<FrameHdf5>(path, overwrite, trace, std::move(write_more));
}

}  // namespace vestige
