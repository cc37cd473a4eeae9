#include "cli/files/import_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/utf8.hpp"
#include "traces/exchange/collider_files.hpp"
#include "traces/exchange/collider_rows.hpp"
#include "traces/exchange/pose_csv.hpp"
#include "traces/exchange/trace_hdf5.hpp"
#include "traces/files/input_file.hpp"
#include "traces/scene/facing.hpp"
#include "traces/scene/people.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

/// Throws where a file names a person's nodes, and not those of the avatar in their order.
void require_names(const std::string& file, std::size_t person, const std::vector<std::string>& names,
                   const Avatar& avatar) {
  const auto is_same = [](const std::string& name, const Node& node) { return name == node.name.c_str(); };
  if (names.empty() || std::ranges::equal(names, avatar.nodes, is_same)) return;
  throw Error(
      file,
      fmt::format("its table {}/node_names does not name its avatar's nodes", trace_format::numbered("pose", person)),
      fmt::format("give the poses the nodes of {}, in the same order",
                  trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, person)));
}

void warn_of_resting(const std::string& file, const PoseCsvReader& reader, Verbosity verbosity) {
  warn_of_names(file, "these nodes of the avatar keep their rest pose", reader.resting(), verbosity);
}

/// Another person's poses beside those of the first.
class OtherPoses {
 public:
  OtherPoses(const std::string& file, const Avatar& avatar, Verbosity verbosity) : file_(file), reader_(file, avatar) {
    warn_of_resting(file, reader_, verbosity);
  }

  /// Reads the pose of a frame of the first person. Throws `Error` unless it is next in the file.
  void read(const TraceFrame& frame, Pose& pose) {
    if (!reader_.next(frame_)) refuse(fmt::format("has no pose in frame {}", frame.index));
    if (frame_.index != frame.index || frame_.time_ns != frame.time_ns)
      refuse(fmt::format("has frame {} at {} s, and the first person has frame {} at {} s", frame_.index,
                         frame_.time_s(), frame.index, frame.time_s()));
    std::swap(pose, frame_.poses.front());
  }

  void expect_end() {
    if (reader_.next(frame_)) refuse(fmt::format("has frame {}, which the first person does not have", frame_.index));
  }

 private:
  [[noreturn]] void refuse(const std::string& cause) const {
    throw Error(file_, cause, "export the trace again, or give everybody the same frames");
  }

  std::string file_;
  PoseCsvReader reader_;
  TraceFrame frame_;
};

/// The people of a folder that `export` wrote, beside the first.
void read_other_poses(const ImportOptions& options, const std::vector<Scene>& scenes, ImportedFrames& frames) {
  if (options.others.empty()) return;
  const auto others = std::make_shared<std::deque<OtherPoses>>();
  for (std::size_t i = 0; i < options.others.size(); ++i)
    others->emplace_back(options.others[i].poses, scenes[i + 1].avatar, options.common.verbosity());
  frames.next_pose = [others, first = frames.next_pose](TraceFrame& frame) {
    frame.poses.resize(others->size() + 1);
    if (!first(frame)) {
      for (OtherPoses& other : *others) other.expect_end();
      return false;
    }
    for (std::size_t i = 0; i < others->size(); ++i) (*others)[i].read(frame, frame.poses[i + 1]);
    return true;
  };
}

}  // namespace

void read_colliders(const ImportOptions& options, ImportedFrames& frames) {
  const std::string& path = options.colliders;
  const std::size_t people = options.others.size() + 1;
  if (path.empty()) return;
  const auto sample_from = [&](std::unique_ptr<ColliderSource> of_file) {
    const std::shared_ptr<ColliderSource> source = options.radius.apply(std::move(of_file));
    for (const std::string& warning : source->warnings())
      warn(fmt::format("--colliders {}: {}", path, warning), options.common.verbosity());
    frames.sampled = source;
    frames.shape = source->shape();
    frames.owners = source->owners();
    frames.add_colliders = [source](TraceFrame& frame) {
      source->sample(frame.time_s(), frame.colliders);
      frame.teleported = source->teleported();
    };
  };
  if (path.ends_with(".glb") || path.ends_with(".gltf")) {
    sample_from(read_collider_gltf(path, options.nodes, options.convention.of_colliders(), options.radius.of_gltf()));
    return;
  }
  if (!options.poses.empty()) {
    // Rows that say their frame go to it, and nothing is made up between them.
    auto rows = std::make_shared<ColliderFrames>(path, options.convention.of_colliders(), people);
    if (rows->columns() == ColliderColumns::kFrames) {
      const std::optional<float> radius_m = options.radius.radius_m();
      frames.shape = radius_m.value_or(0) > 0 ? ColliderShape::kSpheres : rows->shape();
      frames.owners = rows->owners();
      frames.add_colliders = [rows, radius_m](TraceFrame& frame) {
        rows->fill(frame);
        for (ColliderSample& collider : frame.colliders) collider.radius_m = radius_m.value_or(collider.radius_m);
      };
      frames.finish = [rows] { rows->expect_end(); };
      return;
    }
    if (path == "-")
      throw UsageError("--colliders -", "these rows have no frame numbers",
                       "put the rows into a file, which can be read twice");
  }
  sample_from(read_collider_csv(path, options.convention.of_colliders(), people));
}

void play_motion(const Avatar& avatar, const LoadedMotion& motion, std::optional<double> rate_hz,
                 ImportedFrames& frames) {
  const double duration_s = static_cast<double>(motion.frame_count - 1) * motion.frame_time_s;
  const double step_s = rate_hz ? 1 / *rate_hz : motion.frame_time_s;
  if (rate_hz) refuse_too_many_frames(duration_s * *rate_hz + 1, "--rate", "import at a lower --rate");
  // The last frame is there even where division has left a little too much.
  const std::uint64_t count =
      rate_hz ? static_cast<std::uint64_t>(std::floor(duration_s * *rate_hz + 1e-6)) + 1 : motion.frame_count;
  const auto next = std::make_shared<std::uint64_t>(0);
  frames.next_pose = [&avatar, step_s, count, next](TraceFrame& frame) {
    if (*next == count) return false;
    frame.index = *next;
    const double time_s = static_cast<double>((*next)++) * step_s;
    frame.time_ns = std::llround(time_s * 1e9);
    // Keys are at times of fp32: on them, nothing is interpolated.
    frame.poses.front() = sample_animation(avatar, avatar.animations.back(), double{static_cast<float>(time_s)});
    return true;
  };
  frames.share = [count, next] { return static_cast<double>(*next) / static_cast<double>(count); };
}

void require_axis(const std::string& file, std::size_t person, const std::string& facing) {
  if (facing.empty() || facing_named(facing)) return;
  throw Error(file,
              fmt::format("its '{}' is '{}', which is no axis",
                          trace_format::numbered(trace_format::kFacingKey, person), in_one_line(facing)),
              "write +x, -x, +z or -z, or take it out");
}

void require_different_names(const std::string& file, const std::vector<Scene>& scenes) {
  std::set<std::string> names;
  for (const Scene& scene : scenes)
    if (!scene.name.empty() && !names.insert(scene.name).second)
      throw Error(file, fmt::format("two people are called '{}'", scene.name), "give each another name");
}

std::vector<Scene> read_hdf5(const std::string& path, const FacingChoice& facing, ImportedFrames& frames,
                             Verbosity verbosity) {
  using trace_format::attachment_name;
  using trace_format::AttachmentKind;
  const auto file = std::make_shared<TraceHdf5>(path);
  std::vector<Scene> scenes;
  for (std::size_t i = 0; i < file->people().size(); ++i) {
    const TraceHdf5::Person& person = file->people()[i];
    if (file->people().size() > 1) require_axis(path, i, person.facing);
    const SceneNames names = {fmt::format("{}, {}", path, attachment_name(AttachmentKind::kAvatar, i)),
                              fmt::format("{}, {}", path, attachment_name(AttachmentKind::kMapImage, i))};
    Scene& scene = scenes.emplace_back(
        make_scene({.avatar_glb = person.avatar_glb,
                    .map = {person.actuator_map_png, std::string(text_of(person.actuator_map_json))},
                    .facing = person.facing},
                   names, facing, verbosity));
    scene.name = person.name;
    require_names(path, i, person.node_names, scene.avatar);
  }
  require_different_names(path, scenes);
  frames.next_pose = [file](TraceFrame& frame) { return file->next(frame); };
  frames.share = [file] { return file->share(); };
  frames.shape = file->shape();
  frames.owners = file->owners();
  return scenes;
}

void read_poses(const ImportOptions& options, const std::vector<Scene>& scenes, ImportedFrames& frames) {
  const Avatar& avatar = scenes.front().avatar;
  const auto reader = std::make_shared<PoseCsvReader>(options.poses, avatar, options.convention.of_poses());
  warn_of_resting(options.poses, *reader, options.common.verbosity());
  frames.next_pose = [reader](TraceFrame& frame) { return reader->next(frame); };
  frames.share = [reader] { return reader->share(); };
  frames.placed = reader->placed();
  read_other_poses(options, scenes, frames);
}

}  // namespace vestige::cli
