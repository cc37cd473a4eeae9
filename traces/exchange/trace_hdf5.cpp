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
#include "traces/scene/person_name.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/session_check.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr const char* kSession = "session";
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr hsize_t kMostColumns = 1000000;
constexpr const char* kFormat = "vestige trace";

}  // namespace

class TraceHdf5::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path) : path_(path), file_(open_hdf5(path, kHdf5Remedy)) {
    require_format();
    const std::size_t count = count_people();
    for (std::size_t person = 0; person < count; ++person) {
      people.push_back(read_person(person));
      poses_.emplace_back(file_.id(), path_, trace_format::numbered("pose", person));
    }
    const hsize_t frames = time_.dimensions()[0];
    if (frames == 0) throw Error(path.string(), "holds no frame", kHdf5Remedy);
    time_.expect({frames});
    index_.expect({frames});
    std::size_t nodes = 0;
    for (PoseTables& pose : poses_) nodes += pose.expect(frames);
    read_ids(frames);
    const std::size_t row_bytes =
        nodes * 10 * sizeof(float) + ids_.size() * (3 * sizeof(double) + sizeof(float) + 2) + 40;
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
    frame.poses.resize(poses_.size());
    for (std::size_t person = 0; person < poses_.size(); ++person) poses_[person].fill(place, frame.poses[person]);
    fill_colliders(place, frame);
    ++row_;
    return true;
  }

  double share() const { return static_cast<double>(row_) / static_cast<double>(frames_); }
  ColliderShape shape() const { return radius_ ? ColliderShape::kSpheres : ColliderShape::kPoints; }
  Owners owners() const { return owner_of_.empty() ? Owners::kNone : Owners::kPeople; }

  std::vector<Person> people;

 private:
  /// The poses of a person, and a block of their rows.
  class PoseTables {
   public:
    PoseTables(hid_t file, const std::filesystem::path& path, const std::string& group)
        : origin_(file, path, group + "/origin"),
          translation_(file, path, group + "/translation"),
          rotation_(file, path, group + "/rotation"),
          scale_(file, path, group + "/scale") {}

    /// Returns the number of nodes.
    std::size_t expect(hsize_t frames) {
      origin_.expect({frames, 3});
      if (translation_.dimensions().size() != 3) translation_.fail("is not frames x nodes x 3");
      const hsize_t nodes = translation_.dimensions()[1];
      translation_.expect({frames, nodes, 3});
      rotation_.expect({frames, nodes, 4});
      scale_.expect({frames, nodes, 3});
      if (nodes > kMostColumns) translation_.fail("has more than a million nodes");
      nodes_ = static_cast<std::size_t>(nodes);
      return nodes_;
    }

    void read(hsize_t first, hsize_t rows) {
      origin_.read(first, rows, origin_m_);
      translation_.read(first, rows, translations_);
      rotation_.read(first, rows, rotations_);
      scale_.read(first, rows, scales_);
    }

    /// `place` is that of the row in the block.
    void fill(std::size_t place, Pose& pose) const {
      pose.origin_m = vector(origin_m_, place);
      pose.nodes.resize(nodes_);
      for (std::size_t i = 0; i < nodes_; ++i) {
        const std::size_t k = place * nodes_ + i;
        const float* t = &translations_[3 * k];
        const float* r = &rotations_[4 * k];
        const float* s = &scales_[3 * k];
        pose.nodes[i] = {.translation = {t[0], t[1], t[2]},
                         .rotation = glm::quat(r[3], r[0], r[1], r[2]),
                         .scale = {s[0], s[1], s[2]}};
      }
    }

   private:
    Hdf5Table origin_;
    Hdf5Table translation_;
    Hdf5Table rotation_;
    Hdf5Table scale_;
    std::size_t nodes_ = 0;
    std::vector<double> origin_m_;
    std::vector<float> translations_;
    std::vector<float> rotations_;
    std::vector<float> scales_;
  };

  bool has(const std::string& link) const { return hdf5().link_exists(file_.id(), link.c_str(), H5P_DEFAULT) > 0; }

  std::size_t count_people() const {
    std::size_t count = 1;
    while (count < trace_format::kMostPeople && has(trace_format::numbered("pose", count))) ++count;
    return count;
  }

  Person read_person(std::size_t person) const {
    using trace_format::AttachmentKind;
    using trace_format::numbered;
    const std::string avatar = trace_format::attachment_name(AttachmentKind::kAvatar, person);
    Person read = {
        .avatar_glb = read_attachment(avatar),
        .actuator_map_png = read_attachment(trace_format::attachment_name(AttachmentKind::kMapImage, person)),
        .actuator_map_json = read_attachment(trace_format::attachment_name(AttachmentKind::kMapText, person)),
        .node_names = read_node_names(numbered("pose", person) + "/node_names"),
        .facing = read_text(kSession, numbered(trace_format::kFacingKey, person)).value_or(""),
        .name = read_text(kSession, numbered(trace_format::kNameKey, person)).value_or("")};
    if (const std::string fault = name_fault(read.name); !fault.empty())
      throw Error(path_.string(), fmt::format("the name of person {} {}", person + 1, fault),
                  fmt::format("change the attribute '{}' of the group {} to a short name in one line",
                              numbered(trace_format::kNameKey, person), kSession));
    if (read.avatar_glb.empty()) throw Error(path_.string(), fmt::format("holds no {}", avatar), kHdf5Remedy);
    return read;
  }

  /// A file that does not state its format is accepted.
  void require_format() const {
    const std::string format = read_text("/", "format").value_or(kFormat);
    if (format != kFormat) throw Error(path_.string(), fmt::format("its format is '{}'", format), kHdf5Remedy);
    for (const char* object : {"/", kSession}) {
      const std::string said = read_text(object, std::string(trace_format::kVersionKey)).value_or("1");
      const std::optional<int> version = trace_format::parse_version(said);
      if (!version)
        throw Error(path_.string(), fmt::format("its format version is '{}', which is no version", said), kHdf5Remedy);
      if (*version > trace_format::kNewestVersion)
        throw Error(path_.string(), unknown_version(said, trace_format::kNewestVersion),
                    "use the later version of vestige that wrote it");
    }
  }

  /// A trace without colliders may lack the tables of colliders.
  void read_ids(hsize_t frames) {
    if (!has("colliders")) return;
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
    if (has("colliders/radius")) radius_.emplace(file_.id(), path_, "colliders/radius").expect({frames, colliders});
    if (has("colliders/owner")) read_owners(colliders);
  }

  void read_owners(hsize_t colliders) {
    const Hdf5Table owners(file_.id(), path_, "colliders/owner");
    owners.expect({colliders});
    owners.read(0, colliders, owner_of_);
    for (std::size_t i = 0; i < owner_of_.size(); ++i)
      if (owner_of_[i] > people.size())
        owners.fail(
            fmt::format("says that collider {} belongs to person {}, of {}", ids_[i], owner_of_[i], people.size()));
  }

  /// Empty if there are none.
  std::vector<std::string> read_node_names(const std::string& table) const {
    const Hdf5Library& h5 = hdf5();
    if (!has(table)) return {};
    const std::string what = fmt::format("table {}", table);
    const Hdf5Handle dataset(h5.open_dataset(file_.id(), table.c_str(), H5P_DEFAULT), h5.close_dataset);
    if (dataset.id() < 0)
      throw Error(path_.string(), fmt::format("its {} cannot be opened as a table", what), kHdf5Remedy);
    const Hdf5Handle type(h5.type_of(dataset.id()), h5.close_type);
    const Hdf5Handle space(h5.space_of(dataset.id()), h5.close_space);
    return read_hdf5_texts(path_, what, {type.id(), space.id()}, [&](void* out) {
      return h5.read(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
    });
  }

  /// Empty if there is none.
  std::vector<std::byte> read_attachment(const std::string& name) const {
    std::vector<std::byte> bytes;
    if (!has(name)) return bytes;
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
    for (PoseTables& pose : poses_) pose.read(row_, rows);
    if (ids_.empty()) return;
    position_->read(row_, rows, block_.position);
    present_->read(row_, rows, block_.present);
    teleported_->read(row_, rows, block_.teleported);
    if (radius_) radius_->read(row_, rows, block_.radius);
  }

  void fill_colliders(std::size_t place, TraceFrame& frame) const {
    frame.colliders.clear();
    frame.teleported.clear();
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const std::size_t k = place * ids_.size() + i;
      if (block_.present[k] > 1) present_->fail(fmt::format("has {} in row {}, not 0 or 1", block_.present[k], row_));
      if (block_.teleported[k] > 1)
        teleported_->fail(fmt::format("has {} in row {}, not 0 or 1", block_.teleported[k], row_));
      const std::uint16_t owner = owner_of_.empty() ? kNobody : owner_of_[i];
      if (block_.present[k] != 0) frame.colliders.push_back({ids_[i], vector(block_.position, k), radius_at(k), owner});
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
    std::vector<double> position;
    std::vector<float> radius;
    std::vector<std::uint8_t> present;
    std::vector<std::uint8_t> teleported;
  };

  std::filesystem::path path_;
  Hdf5Handle file_;
  Hdf5Table time_{file_.id(), path_, "time_ns"};
  Hdf5Table index_{file_.id(), path_, "frame"};
  std::vector<PoseTables> poses_;
  std::optional<Hdf5Table> position_;
  std::optional<Hdf5Table> present_;
  std::optional<Hdf5Table> teleported_;
  std::optional<Hdf5Table> radius_;
  hsize_t frames_ = 0;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint16_t> owner_of_;  ///< by the place of the id; empty: all belong to nobody
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

const std::vector<TraceHdf5::Person>& TraceHdf5::people() const {
  return implementation_->people;
}
Owners TraceHdf5::owners() const {
  return implementation_->owners();
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
