#include "traces/exchange/trace_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/hdf5/hdf5_table.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/session_check.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr const char* kSession = "session";
constexpr const char* kNodeNames = "pose/node_names";
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr hsize_t kMostColumns = 1000000;
constexpr const char* kFormat = "vestige trace";

}  // namespace

class TraceHdf5::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path) : path_(path), file_(open_hdf5(path, kHdf5Remedy)) {
    require_format();
    node_names = read_node_names();
    facing = read_text(kSession, std::string(trace_format::kFacingKey)).value_or("");
    avatar_glb = read_attachment("avatar.glb");
    if (avatar_glb.empty()) throw Error(path.string(), "holds no avatar.glb", kHdf5Remedy);
    actuator_map_png = read_attachment("actuator_map.png");
    actuator_map_json = read_attachment("actuator_map.json");
    const hsize_t frames = time_.dimensions()[0];
    if (frames == 0) throw Error(path.string(), "holds no frame", kHdf5Remedy);
    time_.expect({frames});
    index_.expect({frames});
    origin_.expect({frames, 3});
    if (translation_.dimensions().size() != 3) translation_.fail("is not frames x nodes x 3");
    nodes_ = translation_.dimensions()[1];
    translation_.expect({frames, nodes_, 3});
    rotation_.expect({frames, nodes_, 4});
    scale_.expect({frames, nodes_, 3});
    if (nodes_ > kMostColumns) translation_.fail("has more than a million nodes");
    read_ids(frames);
    const std::size_t row_bytes = static_cast<std::size_t>(nodes_) * 10 * sizeof(float) +
                                  ids_.size() * (3 * sizeof(double) + sizeof(float) + 2) + 40;
    block_rows_ = std::max<std::size_t>(1, kBlockBytes / row_bytes);
    frames_ = frames;
  }

  bool next(TraceFrame& frame) {
    if (row_ == frames_) return false;
    const auto place = static_cast<std::size_t>(row_ % block_rows_);
    if (place == 0) read_block();
    frame.index = block_.index[place];
    frame.time_ns = block_.time_ns[place];
    if (frame.index > std::numeric_limits<std::uint32_t>::max())
      index_.fail(fmt::format("has {} in row {}, but frame numbers have 32 bits", frame.index, row_));
    if (row_ > 0 && frame.index <= last_index_)
      index_.fail(fmt::format("has {} in row {}, after {}", frame.index, row_, last_index_));
    if (frame.time_ns < last_time_ns_)
      time_.fail(fmt::format("has {} in row {}, after {}", frame.time_ns, row_, last_time_ns_));
    last_index_ = frame.index;
    last_time_ns_ = frame.time_ns;
    frame.poses.front().origin_m = vector(block_.origin, place);
    fill_pose(place, frame.poses.front());
    fill_colliders(place, frame);
    ++row_;
    return true;
  }

  double share() const { return static_cast<double>(row_) / static_cast<double>(frames_); }
  ColliderShape shape() const { return radius_ ? ColliderShape::kSpheres : ColliderShape::kPoints; }

  std::vector<std::string> node_names;
  std::string facing;
  std::vector<std::byte> avatar_glb;
  std::vector<std::byte> actuator_map_png;
  std::vector<std::byte> actuator_map_json;

 private:
  /// A file that does not state its format is accepted.
  void require_format() const {
    const std::string format = read_text("/", "format").value_or(kFormat);
    if (format != kFormat) throw Error(path_.string(), fmt::format("its format is '{}'", format), kHdf5Remedy);
    for (const char* object : {"/", kSession}) {
      const std::string said = read_text(object, std::string(trace_format::kVersionKey)).value_or("1");
      const std::optional<int> version = trace_format::parse_version(said);
      if (!version)
        throw Error(path_.string(), fmt::format("its format version is '{}', which is no version", said), kHdf5Remedy);
      constexpr int kNewest = trace_format::kSpheresVersion;  // HDF5 holds one person
      if (*version > kNewest)
        throw Error(path_.string(), unknown_version(said, kNewest), "use the later version of vestige that wrote it");
    }
  }

  /// A trace without colliders may lack the tables of colliders.
  void read_ids(hsize_t frames) {
    if (hdf5().link_exists(file_.id(), "colliders", H5P_DEFAULT) <= 0) return;
    const Hdf5Table ids(file_.id(), path_, "colliders/id");
    const hsize_t colliders = ids.dimensions()[0];
    ids.expect({colliders});
    if (colliders > kMostColumns) ids.fail("has more than a million colliders");
    ids.read(0, colliders, ids_);
    if (colliders == 0) return;
    std::vector<std::uint32_t> sorted = ids_;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) ids.fail("has an id twice");
    position_.emplace(file_.id(), path_, "colliders/position").expect({frames, colliders, 3});
    present_.emplace(file_.id(), path_, "colliders/present").expect({frames, colliders});
    teleported_.emplace(file_.id(), path_, "colliders/teleported").expect({frames, colliders});
    if (hdf5().link_exists(file_.id(), "colliders/radius", H5P_DEFAULT) > 0)
      radius_.emplace(file_.id(), path_, "colliders/radius").expect({frames, colliders});
  }

  /// Empty if there are none.
  std::vector<std::string> read_node_names() const {
    const Hdf5Library& h5 = hdf5();
    if (h5.link_exists(file_.id(), kNodeNames, H5P_DEFAULT) <= 0) return {};
    const std::string what = fmt::format("table {}", kNodeNames);
    const Hdf5Handle dataset(h5.open_dataset(file_.id(), kNodeNames, H5P_DEFAULT), h5.close_dataset);
    if (dataset.id() < 0)
      throw Error(path_.string(), fmt::format("its {} cannot be opened as a table", what), kHdf5Remedy);
    const Hdf5Handle type(h5.type_of(dataset.id()), h5.close_type);
    const Hdf5Handle space(h5.space_of(dataset.id()), h5.close_space);
    return read_hdf5_texts(path_, what, {type.id(), space.id()}, [&](void* out) {
      return h5.read(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
    });
  }

  /// Empty if there is none.
  std::vector<std::byte> read_attachment(const char* name) const {
    std::vector<std::byte> bytes;
    if (hdf5().link_exists(file_.id(), name, H5P_DEFAULT) <= 0) return bytes;
    const Hdf5Table table(file_.id(), path_, name);
    table.expect({0});
    if (table.dimensions()[0] > std::filesystem::file_size(path_)) table.fail("is larger than the file");
    table.read(0, table.dimensions()[0], bytes);
    const std::string key = trace_format::sha256_key(name);
    const auto recorded = read_text(kSession, key);
    if (recorded && !bytes.empty() && *recorded != sha256_hex(bytes))
      throw Error(
          path_.string(),
          fmt::format("its {} is not the recorded one: its SHA-256 differs from that in the group session", name),
          fmt::format("export the trace again, or remove the attribute '{}' if you changed the table", key));
    return bytes;
  }

  std::optional<std::string> read_text(const char* group, const std::string& key) const {
    return read_hdf5_attribute(file_.id(), path_, group, key);
  }

  static glm::dvec3 vector(const std::vector<double>& numbers, std::size_t place) {
    return {numbers[3 * place], numbers[3 * place + 1], numbers[3 * place + 2]};
  }

  void read_block() {
    const hsize_t rows = std::min<hsize_t>(block_rows_, frames_ - row_);
    index_.read(row_, rows, block_.index);
    time_.read(row_, rows, block_.time_ns);
    origin_.read(row_, rows, block_.origin);
    translation_.read(row_, rows, block_.translation);
    rotation_.read(row_, rows, block_.rotation);
    scale_.read(row_, rows, block_.scale);
    if (ids_.empty()) return;
    position_->read(row_, rows, block_.position);
    present_->read(row_, rows, block_.present);
    teleported_->read(row_, rows, block_.teleported);
    if (radius_) radius_->read(row_, rows, block_.radius);
  }

  void fill_pose(std::size_t place, Pose& pose) const {
    pose.nodes.resize(static_cast<std::size_t>(nodes_));
    for (std::size_t i = 0; i < pose.nodes.size(); ++i) {
      const std::size_t k = place * pose.nodes.size() + i;
      const float* t = &block_.translation[3 * k];
      const float* r = &block_.rotation[4 * k];
      const float* s = &block_.scale[3 * k];
      pose.nodes[i] = {.translation = {t[0], t[1], t[2]},
                       .rotation = glm::quat(r[3], r[0], r[1], r[2]),
                       .scale = {s[0], s[1], s[2]}};
    }
  }

  void fill_colliders(std::size_t place, TraceFrame& frame) const {
    frame.colliders.clear();
    frame.teleported.clear();
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const std::size_t k = place * ids_.size() + i;
      if (block_.present[k] > 1) present_->fail(fmt::format("has {} in row {}, not 0 or 1", block_.present[k], row_));
      if (block_.teleported[k] > 1)
        teleported_->fail(fmt::format("has {} in row {}, not 0 or 1", block_.teleported[k], row_));
      if (block_.present[k] != 0) frame.colliders.push_back({ids_[i], vector(block_.position, k), radius_at(k)});
      if (block_.teleported[k] != 0) frame.teleported.push_back(ids_[i]);
    }
  }

  float radius_at(std::size_t k) const {
    if (!radius_) return 0;
    const float radius_m = block_.radius[k];
    if (const std::string_view fault = radius_fault(double{radius_m}); !fault.empty())
      radius_->fail(fmt::format("has {} in row {}, which {}", radius_m, row_, fault));
    return radius_m;
  }

  struct Block {
    std::vector<std::uint64_t> index;
    std::vector<std::int64_t> time_ns;
    std::vector<double> origin;
    std::vector<float> translation;
    std::vector<float> rotation;
    std::vector<float> scale;
    std::vector<double> position;
    std::vector<float> radius;
    std::vector<std::uint8_t> present;
    std::vector<std::uint8_t> teleported;
  };

  std::filesystem::path path_;
  Hdf5Handle file_;
  Hdf5Table time_{file_.id(), path_, "time_ns"};
  Hdf5Table index_{file_.id(), path_, "frame"};
  Hdf5Table origin_{file_.id(), path_, "pose/origin"};
  Hdf5Table translation_{file_.id(), path_, "pose/translation"};
  Hdf5Table rotation_{file_.id(), path_, "pose/rotation"};
  Hdf5Table scale_{file_.id(), path_, "pose/scale"};
  std::optional<Hdf5Table> position_;
  std::optional<Hdf5Table> present_;
  std::optional<Hdf5Table> teleported_;
  std::optional<Hdf5Table> radius_;
  hsize_t nodes_ = 0;
  hsize_t frames_ = 0;
  std::vector<std::uint32_t> ids_;
  std::size_t block_rows_ = 1;
  Block block_;
  hsize_t row_ = 0;
  std::uint64_t last_index_ = 0;
  std::int64_t last_time_ns_ = 0;
};

TraceHdf5::TraceHdf5(const std::filesystem::path& path) {
  static_cast<void>(hdf5());
  const auto read_all = [&] {
    Implementation trial(path);
    for (TraceFrame frame; trial.next(frame);) continue;
  };
  try_hdf5(path, read_all);
  implementation_ = std::make_unique<Implementation>(path);
}
TraceHdf5::~TraceHdf5() = default;

const std::vector<std::byte>& TraceHdf5::avatar_glb() const {
  return implementation_->avatar_glb;
}
const std::vector<std::byte>& TraceHdf5::actuator_map_png() const {
  return implementation_->actuator_map_png;
}
const std::vector<std::byte>& TraceHdf5::actuator_map_json() const {
  return implementation_->actuator_map_json;
}
const std::vector<std::string>& TraceHdf5::node_names() const {
  return implementation_->node_names;
}
std::string TraceHdf5::facing() const {
  return implementation_->facing;
}
ColliderShape TraceHdf5::shape() const {
  return implementation_->shape();
}
bool TraceHdf5::next(TraceFrame& frame) {
  return implementation_->next(frame);
}
double TraceHdf5::share() const {
  return implementation_->share();
}

}  // namespace vestige
