#include "traces/exchange/pose_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "traces/base/number_text.hpp"
#include "traces/exchange/trace_export.hpp"

namespace vestige {

namespace {

constexpr std::string_view kRemedy =
    "a row is frame,time_s,origin_x,origin_y,origin_z, then NODE.tx … NODE.sz for nodes of the avatar";
constexpr std::string_view kAvatarRemedy =
    "take the avatar that the poses were exported with, or leave out the column; write the file again if it was cut";

constexpr double kLongest_s = 9e9;  // limit of int64 nanoseconds

float& part_of(NodeLocal& node, std::size_t part) {
  switch (part) {
    case 0:
    case 1:
    case 2:
      return node.translation[static_cast<int>(part)];
    case 3:
      return node.rotation.x;
    case 4:
      return node.rotation.y;
    case 5:
      return node.rotation.z;
    case 6:
      return node.rotation.w;
    default:
      return node.scale[static_cast<int>(part) - 7];
  }
}

class PoseCsv final : public TraceExport {
 public:
  PoseCsv(const std::filesystem::path& path, Overwrite overwrite, const std::vector<std::string>& node_names,
          std::size_t person)
      : file_(path, overwrite), person_(person), nodes_(node_names.size()) {
    row_ = "frame,time_s,origin_x,origin_y,origin_z";
    for (const std::string& node : pose_csv_nodes(node_names))
      for (const char* part : kPoseCsvParts) {
        row_ += ',';
        row_ += csv_field(fmt::format("{}.{}", node, part));
      }
    row_ += '\n';
    file_.write(row_);
  }

  void write(const TraceFrame& frame) override {
    const Pose& pose = frame.poses[person_];
    if (pose.nodes.size() != nodes_) {
      ++missing_;
      return;
    }
    row_ = fmt::format("{},", frame.index);
    append_seconds(row_, frame.time_ns);
    const auto out = std::back_inserter(row_);
    const glm::dvec3& origin = pose.origin_m;
    fmt::format_to(out, ",{},{},{}", origin.x, origin.y, origin.z);
    for (const NodeLocal& node : pose.nodes) {
      fmt::format_to(out, ",{},{},{}", node.translation.x, node.translation.y, node.translation.z);
      fmt::format_to(out, ",{},{},{},{}", node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w);
      fmt::format_to(out, ",{},{},{}", node.scale.x, node.scale.y, node.scale.z);
    }
    row_ += '\n';
    file_.write(row_);
  }

  void commit() override { file_.commit(); }

  std::vector<std::string> losses() const override {
    if (missing_ == 0) return {};
    return {fmt::format("person {} has no pose in {}", person_ + 1, counted(missing_, "frame"))};
  }

 private:
  OutputFile file_;
  std::size_t person_;
  std::size_t nodes_;
  std::uint64_t missing_ = 0;
  std::string row_;
};

}  // namespace

std::vector<std::string> pose_csv_nodes(const std::vector<std::string>& node_names) {
  std::vector<std::string> nodes = node_names;
  std::map<std::string, int> count;
  for (std::string& node : nodes) {
    // A line end in a name would end the row.
    std::ranges::replace(node, '\n', ' ');
    std::ranges::replace(node, '\r', ' ');
    ++count[node];
  }
  std::map<std::string, std::size_t> plain;
  std::vector<std::size_t> numbered;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].empty() || count[nodes[i]] > 1)
      numbered.push_back(i);
    else
      plain.emplace(nodes[i], i);
  for (std::size_t k = 0; k < numbered.size(); ++k) {
    std::string& node = nodes[numbered[k]];
    node += fmt::format("#{}", numbered[k]);
    // If another node has this as its plain name, that node gets its own number, which is unique.
    if (const auto same = plain.find(node); same != plain.end()) {
      numbered.push_back(same->second);
      plain.erase(same);
    }
  }
  return nodes;
}

std::unique_ptr<TraceExport> make_pose_csv(const std::filesystem::path& path, Overwrite overwrite,
                                           const std::vector<std::string>& node_names, std::size_t person) {
  return std::make_unique<PoseCsv>(path, overwrite, node_names, person);
}

PoseCsvReader::PoseCsvReader(const std::filesystem::path& path, const Avatar& avatar, const Convention& convention)
    : reader_(path), lines_(reader_, kRemedy), avatar_(avatar), convention_(convention), rest_(rest_pose(avatar)) {
  read_header();
  if (convention_.is_of_trace()) return;
  for (std::size_t node = 0; node < moves_.size(); ++node)
    if (moves_[node]) rest_.nodes[node] = convention_.given_node(rest_.nodes[node]);
}

void PoseCsvReader::read_header() {
  std::vector<std::string> names;
  for (const Node& node : avatar_.nodes) names.push_back(node.name);
  const std::vector<std::string> nodes = pose_csv_nodes(names);
  std::map<std::string, Target> known = {{"frame", {Column::kFrame, 0, 0}},
                                         {"time_s", {Column::kTime, 0, 0}},
                                         {"origin_x", {Column::kOrigin, 0, 0}},
                                         {"origin_y", {Column::kOrigin, 0, 1}},
                                         {"origin_z", {Column::kOrigin, 0, 2}}};
  for (std::size_t node = 0; node < nodes.size(); ++node)
    for (std::size_t part = 0; part < std::size(kPoseCsvParts); ++part)
      known.try_emplace(fmt::format("{}.{}", nodes[node], kPoseCsvParts[part]), Target{Column::kNode, node, part});
  columns_ = lines_.take_header();
  std::set<std::string> seen;
  moves_.resize(nodes.size());
  for (const std::string& column : columns_) {
    const auto target = known.find(column);
    if (target == known.end())
      throw lines_.error(fmt::format("the avatar has no node for the column '{}'", column), kAvatarRemedy);
    if (!seen.insert(column).second) throw lines_.error(fmt::format("the column '{}' appears twice", column));
    targets_.push_back(target->second);
    if (target->second.column == Column::kNode) moves_[target->second.node] = true;
  }
  if (!seen.contains("time_s")) throw lines_.error("there is no column time_s");
  has_frames_ = seen.contains("frame");
  for (std::size_t node = 0; node < nodes.size(); ++node)
    if (!moves_[node]) resting_.push_back(nodes[node]);
}

std::vector<bool> PoseCsvReader::placed() const {
  constexpr std::size_t kPlaceParts = 3;  // tx, ty, tz
  std::vector<bool> placed(moves_.size());
  for (const Target& target : targets_)
    if (target.column == Column::kNode && target.part < kPlaceParts) placed[target.node] = true;
  return placed;
}

void PoseCsvReader::take(const Target& target, TraceFrame& frame) {
  const auto number = [&](auto& value) {
    if (lines_.at_end()) throw lines_.error(fmt::format("has fewer than the header's {} fields", targets_.size()));
    if (!lines_.take(value) || !std::isfinite(value))
      throw lines_.error(
          fmt::format("{} is not a finite number", columns_[static_cast<std::size_t>(&target - targets_.data())]));
  };
  switch (target.column) {
    case Column::kFrame:
      if (!lines_.take(frame.index)) throw lines_.error("frame is not a whole number");
      break;
    case Column::kTime:
      number(time_s_);
      time_s_ *= convention_.seconds_per_unit;
      if (time_s_ < 0 || time_s_ > kLongest_s)
        throw lines_.error(fmt::format("the time {} s is not from 0 to 9e9 s", time_s_));
      frame.time_ns = nanoseconds_of(time_s_);
      break;
    case Column::kOrigin:
      number(frame.poses.front().origin_m[static_cast<int>(target.part)]);
      break;
    case Column::kNode:
      number(part_of(frame.poses.front().nodes[target.node], target.part));
      break;
  }
}

void PoseCsvReader::check(const TraceFrame& frame) {
  if (rows_ > 0 && frame.index <= last_index_)
    throw lines_.error(fmt::format("frame {} comes after frame {}", frame.index, last_index_), "sort the rows");
  if (frame.index > std::numeric_limits<std::uint32_t>::max())
    throw lines_.error(fmt::format("frame {} is beyond 4294967295", frame.index));
  if (frame.time_ns < last_time_ns_)
    throw lines_.error(fmt::format("time runs backwards, to {} s", time_s_), "sort the rows by time");
  for (std::size_t i = 0; i < frame.poses.front().nodes.size(); ++i) {
    const glm::quat& q = frame.poses.front().nodes[i].rotation;
    if (q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0)
      throw lines_.error(fmt::format("the rotation of node {} is zero, which is not a rotation", i));
  }
}

void PoseCsvReader::change_convention(TraceFrame& frame) const {
  frame.poses.front().origin_m = convention_.position_m(frame.poses.front().origin_m);
  for (std::size_t node = 0; node < moves_.size(); ++node)
    if (moves_[node]) frame.poses.front().nodes[node] = convention_.node(frame.poses.front().nodes[node]);
}

bool PoseCsvReader::next(TraceFrame& frame) {
  if (!lines_.next()) {
    if (rows_ == 0) throw Error(reader_.name(), "holds no frame", kRemedy);
    return false;
  }
  frame.poses.front() = rest_;
  frame.index = rows_;
  for (const Target& target : targets_) take(target, frame);
  if (!lines_.at_end()) throw lines_.error(fmt::format("has more than the header's {} fields", targets_.size()));
  check(frame);
  if (!convention_.is_of_trace()) change_convention(frame);
  ++rows_;
  last_index_ = frame.index;
  last_time_ns_ = frame.time_ns;
  return true;
}

}  // namespace vestige
