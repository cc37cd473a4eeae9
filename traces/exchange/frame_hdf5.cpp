#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/hdf5/hdf5_writer.hpp"
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
        ids_(trace.collider_ids()) {
    for (std::size_t i = 0; i < ids_.size(); ++i) place_of_[ids_[i]] = i;
    const Hdf5Library& h5 = hdf5();
    write_head(trace);
    add({"time_ns", h5.int64, 8, {}, "ns"});
    add({"frame", h5.uint64, 8, {}, ""});
    add({"pose/origin", h5.float64, 8, {3}, "m", "x, y, z; right-handed, +Y up, +Z forward"});
    const hsize_t nodes = trace.people().front().node_names.size();
    add({"pose/translation", h5.float32, 4, {nodes, 3}, "m", "x, y, z"});
    add({"pose/rotation", h5.float32, 4, {nodes, 4}, "1", "x, y, z, w"});
    add({"pose/scale", h5.float32, 4, {nodes, 3}, "1", "x, y, z"});
    const hsize_t colliders = ids_.size();
    add({"colliders/position", h5.float64, 8, {colliders, 3}, "m", "x, y, z; NaN where absent"});
    add({"colliders/present", h5.uint8, 1, {colliders}, ""});
    add({"colliders/teleported", h5.uint8, 1, {colliders}, ""});
    if (shape_ == ColliderShape::kSpheres)
      add({"colliders/radius", h5.float32, 4, {colliders}, "m", "0 is a point; NaN where absent"});
  }

  void write(const TraceFrame& frame) override {
    ++frames_;
    translation_.clear();
    rotation_.clear();
    scale_.clear();
    for (const NodeLocal& node : frame.poses.front().nodes) {
      translation_.insert(translation_.end(), {node.translation.x, node.translation.y, node.translation.z});
      rotation_.insert(rotation_.end(), {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w});
      scale_.insert(scale_.end(), {node.scale.x, node.scale.y, node.scale.z});
    }
    position_.assign(3 * ids_.size(), std::numeric_limits<double>::quiet_NaN());
    radius_.assign(ids_.size(), std::numeric_limits<float>::quiet_NaN());
    present_.assign(ids_.size(), 0);
    teleported_.assign(ids_.size(), 0);
    for (const ColliderSample& collider : frame.colliders) {
      const std::size_t place = place_of_.at(collider.id);
      present_[place] = 1;
      radius_[place] = collider.radius_m;
      for (int axis = 0; axis < 3; ++axis)
        position_[3 * place + static_cast<std::size_t>(axis)] = collider.position_m[axis];
    }
    for (const std::uint32_t id : frame.teleported)
      if (const auto place = place_of_.find(id); place != place_of_.end()) teleported_[place->second] = 1;
    const double origin[] = {frame.poses.front().origin_m.x, frame.poses.front().origin_m.y,
                             frame.poses.front().origin_m.z};
    const void* rows[] = {&frame.time_ns, &frame.index,     origin,          translation_.data(), rotation_.data(),
                          scale_.data(),  position_.data(), present_.data(), teleported_.data(),  radius_.data()};
    for (std::size_t i = 0; i < datasets_.size(); ++i) datasets_[i].append(rows[i]);
  }

  void commit() override {
    if (frames_ == 0) throw Error(path_.string(), "there is no frame to export", "");
    for (Hdf5Column& dataset : datasets_) dataset.close();
    if (write_more_) write_more_(file_.id());
    file_.commit();
  }

 private:
  void add(Hdf5Column::Description description) { datasets_.emplace_back(file_.id(), path_, std::move(description)); }

  void write_head(TraceReader& trace) {
    const Hdf5Library& h5 = hdf5();
    write_hdf5_attribute(file_.id(), "format", "vestige trace", path_);
    write_hdf5_attribute(file_.id(), "format_version", fmt::format("{}", trace_format::version_with(shape_)), path_);
    for (const char* group : {"pose", "colliders", "session"}) {
      Hdf5Handle made(h5.create_group(file_.id(), group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), h5.close_group, path_,
                      "make a group");
      if (std::string_view(group) != "session") continue;
      for (const auto& [key, value] : trace.session())
        if (value.size() < kMostAttributeBytes) write_hdf5_attribute(made.id(), key, value, path_);
    }
    const RecordedPerson& person = trace.people().front();
    write_bytes("avatar.glb", person.avatar_glb);
    write_bytes("actuator_map.png", person.actuator_map_png);
    write_bytes("actuator_map.json", person.actuator_map_json);
    write_node_names(person.node_names);
    write_whole("colliders/id", h5.uint32, ids_.size(), ids_.data(), Checksum::kYes);
  }

  enum class Checksum { kNo, kYes };  ///< attachments have their own SHA-256

  void write_whole(const char* name, hid_t type, std::size_t count, const void* data,
                   Checksum checksum = Checksum::kNo) {
    const Hdf5Library& h5 = hdf5();
    const hsize_t size = count;
    const Hdf5Handle how(h5.create_properties(h5.dataset_creation), h5.close_properties, path_, "make properties");
    if (checksum == Checksum::kYes && count > 0) {
      hdf5_check(h5.set_chunk(how.id(), 1, &size), path_, "choose chunks");
      hdf5_check(h5.set_fletcher32(how.id()), path_, "choose checksums");
    }
    const Hdf5Handle space(h5.create_simple_space(1, &size, nullptr), h5.close_space, path_, "make a space");
    Hdf5Handle dataset(h5.create_dataset(file_.id(), name, type, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
                       h5.close_dataset, path_, fmt::format("make {}", name));
    const std::string doing = fmt::format("write {}", name);
    if (count > 0) hdf5_check(h5.write(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), path_, doing);
    hdf5_check(dataset.reset(), path_, doing);
  }

  void write_bytes(const char* name, std::span<const std::byte> bytes) {
    if (!bytes.empty()) write_whole(name, hdf5().uint8, bytes.size(), bytes.data());
  }

  /// Writes texts of fixed length, because texts of variable length are stored apart, without a checksum.
  void write_node_names(const std::vector<std::string>& names) {
    const Hdf5Library& h5 = hdf5();
    std::size_t longest = 1;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    std::string texts(names.size() * longest, '\0');
    for (std::size_t i = 0; i < names.size(); ++i) texts.replace(i * longest, names[i].size(), names[i]);
    const Hdf5Handle type(h5.copy_type(h5.text), h5.close_type, path_, "make a type");
    hdf5_check(h5.set_size(type.id(), longest), path_, "make a type");
    hdf5_check(h5.set_padding(type.id(), H5T_STR_NULLPAD), path_, "make a type");
    hdf5_check(h5.set_character_set(type.id(), H5T_CSET_UTF8), path_, "make a type");
    write_whole("pose/node_names", type.id(), names.size(), texts.data(), Checksum::kYes);
  }

  Hdf5Output file_;
  std::filesystem::path path_;
  std::function<void(hid_t file)> write_more_;
  ColliderShape shape_;
  std::vector<std::uint32_t> ids_;
  std::map<std::uint32_t, std::size_t> place_of_;
  std::vector<Hdf5Column> datasets_;
  std::uint64_t frames_ = 0;
  std::vector<float> translation_;
  std::vector<float> rotation_;
  std::vector<float> scale_;
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
