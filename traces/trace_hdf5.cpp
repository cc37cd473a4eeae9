#include "traces/trace_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "traces/error.hpp"
#include "traces/hdf5_library.hpp"
#include "traces/sha256.hpp"
#include "traces/trace_format.hpp"

namespace vestige {

namespace {

constexpr const char* kSession = "session";
constexpr const char* kRemedy = "name a file that 'vestige export' wrote, or that has its tables (FORMAT.md)";
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr hsize_t kMostColumns = 1000000;

/// One table of the file.
class Table {
 public:
  Table(hid_t file, const std::filesystem::path& path, const char* name) : path_(path), name_(name) {
    const Hdf5Library& h5 = hdf5();
    dataset_ = Hdf5Handle(h5.open_dataset(file, name, H5P_DEFAULT), h5.close_dataset);
    if (dataset_.id() < 0) fail("is not there");
    const Hdf5Handle space(h5.space_of(dataset_.id()), h5.close_space);
    const int rank = h5.rank(space.id());
    if (rank < 1 || rank > 3) fail("is no table");
    dimensions_.resize(static_cast<std::size_t>(rank));
    if (h5.dimensions(space.id(), dimensions_.data(), nullptr) < 0) fail("is no table");
    const Hdf5Handle type(h5.type_of(dataset_.id()), h5.close_type);
    const H5T_class_t kind = h5.class_of(type.id());
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail("does not hold numbers");
  }

  const std::vector<hsize_t>& dimensions() const { return dimensions_; }

  [[noreturn]] void fail(std::string_view cause) const {
    throw Error(path_.string(), fmt::format("its table {} {}", name_, cause), kRemedy);
  }

  /// Throws unless it has this shape; 0 stands for any size.
  void expect(const std::vector<hsize_t>& shape) const {
    bool same = shape.size() == dimensions_.size();
    for (std::size_t i = 0; same && i < shape.size(); ++i)
      same = shape[i] == dimensions_[i] || (i == 0 && shape[0] == 0);
    if (!same) fail(fmt::format("has the shape ({}), not ({})", fmt::join(dimensions_, ", "), fmt::join(shape, ", ")));
  }

  /// Rows `first` … `first + rows`, converted to `type`.
  template <typename Number>
  void read(hsize_t first, hsize_t rows, hid_t type, std::vector<Number>& out) const {
    const Hdf5Library& h5 = hdf5();
    std::vector<hsize_t> count = dimensions_;
    count[0] = rows;
    std::size_t numbers = 1;
    for (const hsize_t size : count) numbers *= static_cast<std::size_t>(size);
    out.resize(numbers);
    if (numbers == 0) return;
    std::vector<hsize_t> start(count.size(), 0);
    start[0] = first;
    const Hdf5Handle place(h5.space_of(dataset_.id()), h5.close_space);
    const Hdf5Handle memory(h5.create_simple_space(static_cast<int>(count.size()), count.data(), nullptr),
                            h5.close_space);
    if (h5.select_hyperslab(place.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        h5.read(dataset_.id(), type, memory.id(), place.id(), H5P_DEFAULT, out.data()) < 0)
      fail(fmt::format("cannot be read from row {} on: the file is damaged", first));
  }

 private:
  std::filesystem::path path_;
  const char* name_;
  Hdf5Handle dataset_;
  std::vector<hsize_t> dimensions_;
};

}  // namespace

class TraceHdf5::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path) : path_(path), file_(open(path)) {
    avatar_glb = read_attachment("avatar.glb");
    if (avatar_glb.empty()) throw Error(path.string(), "holds no avatar.glb", kRemedy);
    actuator_map_png = read_attachment("actuator_map.png");
    actuator_map_json = read_attachment("actuator_map.json");
    const hsize_t frames = time_.dimensions()[0];
    if (frames == 0) throw Error(path.string(), "holds no frame", kRemedy);
    time_.expect({frames});
    index_.expect({frames});
    origin_.expect({frames, 3});
    if (translation_.dimensions().size() != 3) translation_.fail("is not frames x nodes x 3");
    nodes_ = translation_.dimensions()[1];
    translation_.expect({frames, nodes_, 3});
    rotation_.expect({frames, nodes_, 4});
    scale_.expect({frames, nodes_, 3});
    const Table ids(file_.id(), path, "colliders/id");
    const hsize_t colliders = ids.dimensions()[0];
    if (nodes_ > kMostColumns || colliders > kMostColumns) ids.fail("is one of more than a million columns");
    ids.expect({colliders});
    ids.read(0, colliders, hdf5().uint32, ids_);
    if (colliders > 0) {
      position_.expect({frames, colliders, 3});
      present_.expect({frames, colliders});
      teleported_.expect({frames, colliders});
      std::vector<std::uint32_t> sorted = ids_;
      std::ranges::sort(sorted);
      if (std::ranges::adjacent_find(sorted) != sorted.end()) ids.fail("has an id twice");
    }
    const std::size_t row_bytes =
        static_cast<std::size_t>(nodes_) * 10 * sizeof(float) + ids_.size() * (3 * sizeof(double) + 2) + 40;
    block_rows_ = std::max<std::size_t>(1, kBlockBytes / row_bytes);
    frames_ = frames;
  }

  bool next(TraceFrame& frame) {
    if (row_ == frames_) return false;
    const auto place = static_cast<std::size_t>(row_ % block_rows_);
    if (place == 0) read_block();
    frame.index = block_.index[place];
    frame.time_ns = block_.time_ns[place];
    if (frame.index > std::numeric_limits<std::uint32_t>::max() || (row_ > 0 && frame.index <= last_index_))
      index_.fail(fmt::format("says {} in row {}, after {}", frame.index, row_, last_index_));
    if (frame.time_ns < last_time_ns_)
      time_.fail(fmt::format("says {} in row {}, after {}", frame.time_ns, row_, last_time_ns_));
    last_index_ = frame.index;
    last_time_ns_ = frame.time_ns;
    frame.pose.origin_m = vector(block_.origin, place);
    fill_pose(place, frame.pose);
    fill_colliders(place, frame);
    ++row_;
    return true;
  }

  double share() const { return static_cast<double>(row_) / static_cast<double>(frames_); }

  std::vector<std::byte> avatar_glb;
  std::vector<std::byte> actuator_map_png;
  std::vector<std::byte> actuator_map_json;

 private:
  static Hdf5Handle open(const std::filesystem::path& path) {
    std::error_code failed;
    if (!std::filesystem::exists(path, failed)) throw Error(path.string(), "there is no such file", "check the name");
    Hdf5Handle file(hdf5().open_file(path.c_str(), kHdf5ReadOnly, H5P_DEFAULT), hdf5().close_file);
    if (file.id() < 0) throw Error(path.string(), "is no HDF5 file, or one that is damaged", kRemedy);
    return file;
  }

  /// Empty where there is none.
  std::vector<std::byte> read_attachment(const char* name) const {
    std::vector<std::byte> bytes;
    if (hdf5().link_exists(file_.id(), name, H5P_DEFAULT) <= 0) return bytes;
    const Table table(file_.id(), path_, name);
    table.expect({0});
    if (table.dimensions()[0] > std::filesystem::file_size(path_)) table.fail("is larger than the file");
    table.read(0, table.dimensions()[0], hdf5().uint8, bytes);
    const std::string key = fmt::format("{}{}", trace_format::kSha256Prefix, name);
    const auto recorded = read_session(key);
    if (recorded && !bytes.empty() && *recorded != sha256_hex(bytes))
      throw Error(path_.string(),
                  fmt::format("its {} is not the one that was recorded: its SHA-256 is another than the group session "
                              "says",
                              name),
                  fmt::format("export the trace again, or, if you changed it, remove the attribute '{}'", key));
    return bytes;
  }

  /// What an attribute of the group `session` says, if it is there and is a text.
  std::optional<std::string> read_session(const std::string& key) const {
    const Hdf5Library& h5 = hdf5();
    if (h5.attribute_exists(file_.id(), kSession, key.c_str(), H5P_DEFAULT) <= 0) return {};
    const Hdf5Handle attribute(h5.open_attribute(file_.id(), kSession, key.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                               h5.close_attribute);
    const Hdf5Handle type(h5.attribute_type(attribute.id()), h5.close_type);
    if (h5.class_of(type.id()) != H5T_STRING) return {};
    const Hdf5Handle space(h5.attribute_space(attribute.id()), h5.close_space);
    constexpr std::size_t kMostBytes = 1 << 20;
    if (h5.element_count(space.id()) != 1 || h5.size_of(type.id()) > kMostBytes)
      throw Error(path_.string(), fmt::format("its attribute '{}' is not one text", key), kRemedy);
    std::string text;
    bool is_read = false;
    if (h5.is_variable_text(type.id()) > 0) {
      char* found = nullptr;
      is_read = h5.read_attribute(attribute.id(), type.id(), static_cast<void*>(&found)) >= 0;
      if (found != nullptr) text = found;
      h5.free_memory(found);
    } else {
      text.resize(h5.size_of(type.id()));
      is_read = h5.read_attribute(attribute.id(), type.id(), text.data()) >= 0;
      text.resize(std::min(text.find('\0'), text.size()));  // which fills what the text leaves
    }
    if (!is_read) throw Error(path_.string(), fmt::format("its attribute '{}' cannot be read", key), kRemedy);
    return text;
  }

  static glm::dvec3 vector(const std::vector<double>& numbers, std::size_t place) {
    return {numbers[3 * place], numbers[3 * place + 1], numbers[3 * place + 2]};
  }

  void read_block() {
    const Hdf5Library& h5 = hdf5();
    const hsize_t rows = std::min<hsize_t>(block_rows_, frames_ - row_);
    index_.read(row_, rows, h5.uint64, block_.index);
    time_.read(row_, rows, h5.int64, block_.time_ns);
    origin_.read(row_, rows, h5.float64, block_.origin);
    translation_.read(row_, rows, h5.float32, block_.translation);
    rotation_.read(row_, rows, h5.float32, block_.rotation);
    scale_.read(row_, rows, h5.float32, block_.scale);
    if (ids_.empty()) return;
    position_.read(row_, rows, h5.float64, block_.position);
    present_.read(row_, rows, h5.uint8, block_.present);
    teleported_.read(row_, rows, h5.uint8, block_.teleported);
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
      if (block_.present[k] != 0) frame.colliders.push_back({ids_[i], vector(block_.position, k)});
      if (block_.teleported[k] != 0) frame.teleported.push_back(ids_[i]);
    }
  }

  struct Block {
    std::vector<std::uint64_t> index;
    std::vector<std::int64_t> time_ns;
    std::vector<double> origin;
    std::vector<float> translation;
    std::vector<float> rotation;
    std::vector<float> scale;
    std::vector<double> position;
    std::vector<std::uint8_t> present;
    std::vector<std::uint8_t> teleported;
  };

  std::filesystem::path path_;
  Hdf5Handle file_;
  Table time_{file_.id(), path_, "time_ns"};
  Table index_{file_.id(), path_, "frame"};
  Table origin_{file_.id(), path_, "pose/origin"};
  Table translation_{file_.id(), path_, "pose/translation"};
  Table rotation_{file_.id(), path_, "pose/rotation"};
  Table scale_{file_.id(), path_, "pose/scale"};
  Table position_{file_.id(), path_, "colliders/position"};
  Table present_{file_.id(), path_, "colliders/present"};
  Table teleported_{file_.id(), path_, "colliders/teleported"};
  hsize_t nodes_ = 0;
  hsize_t frames_ = 0;
  std::vector<std::uint32_t> ids_;
  std::size_t block_rows_ = 1;
  Block block_;
  hsize_t row_ = 0;
  std::uint64_t last_index_ = 0;
  std::int64_t last_time_ns_ = 0;
};

TraceHdf5::TraceHdf5(const std::filesystem::path& path) : implementation_(std::make_unique<Implementation>(path)) {}
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
bool TraceHdf5::next(TraceFrame& frame) {
  return implementation_->next(frame);
}
double TraceHdf5::share() const {
  return implementation_->share();
}

}  // namespace vestige
