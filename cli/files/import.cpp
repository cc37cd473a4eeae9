#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>

#include "analysis/base/provenance.hpp"
#include "cli/choices/motion.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/import_frames.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/strict_json.hpp"
#include "traces/files/input_file.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/questions/placement_question.hpp"
#include "traces/questions/pose_question.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige::cli {

namespace {

/// What `export` wrote stands for all of its parts: none may be named beside it.
void refuse_parts(const ImportOptions& options) {
  const std::pair<const char*, bool> parts[] = {{"--motion", !options.motion.empty()},
                                                {"--poses", !options.poses.empty()},
                                                {"--colliders", !options.colliders.empty()},
                                                {"--avatar", !options.avatar.empty()},
                                                {"--map", !options.map.empty()},
                                                {"--nodes", !options.nodes.empty()},
                                                {"--radius", !options.radius.text.empty()},
                                                {"--rate", options.rate_hz.has_value()}};
  std::optional<std::string> named = options.motion_choice.given();
  if (!named) named = options.convention.given_for_colliders();
  if (!named) named = options.convention.given_for_poses();
  if (!named && options.convention.has_time_unit()) named = "--time-unit";
  for (const auto& [flag, is_named] : parts)
    if (is_named) named = flag;
  if (named)
    throw UsageError(*named, fmt::format("'{}' has poses, colliders, avatar and map", options.from),
                     fmt::format("leave {} out, or name every part by its flag", *named));
}

/// The files in a folder that `export` wrote.
void expand_folder(ImportOptions& options) {
  if (options.from == "-")
    throw UsageError("-", "a folder or an .h5 file cannot be read from standard input",
                     "name the folder or file; --poses, --motion and --colliders accept '-'");
  const std::filesystem::path folder(options.from);
  if (!std::filesystem::is_directory(folder))
    throw Error(options.from,
                std::filesystem::exists(folder) ? "is neither a folder nor an .h5 file" : "there is no such folder",
                "name a folder or an .h5 file that 'vestige export' wrote, or give --poses or --motion");
  const auto take = [&](const std::string& name, std::string& option) {
    if (std::filesystem::exists(folder / name)) option = (folder / name).string();
  };
  take("poses.csv", options.poses);
  take("colliders.csv", options.colliders);
  take("avatar.glb", options.avatar);
  take("actuator_map.png", options.map);
  take("session.json", options.session);
  if (options.poses.empty())
    throw Error(options.from, "holds no poses.csv", "name a folder that 'vestige export' wrote");
  if (options.avatar.empty())
    throw Error(options.from, "holds no avatar.glb",
                "put avatar.glb back, or give --poses, --colliders and --avatar one by one");
  if (options.map.empty()) options.map = "none";
  for (std::size_t k = 1; k < trace_format::kMostPeople; ++k) {
    PersonFiles other;
    const std::string poses = trace_format::numbered("poses.csv", k);
    const std::string avatar = trace_format::numbered("avatar.glb", k);
    take(poses, other.poses);
    take(avatar, other.avatar);
    if (other.poses.empty() && other.avatar.empty()) continue;
    const std::size_t before = options.others.size() + 1;
    const std::string missing = before < k             ? trace_format::numbered("poses.csv", before)
                                : other.poses.empty()  ? poses
                                : other.avatar.empty() ? avatar
                                                       : "";
    if (!missing.empty())
      throw Error(options.from, fmt::format("holds files of person {}, but no {}", k + 1, missing),
                  fmt::format("put {} back, or remove that person's files", missing));
    take(trace_format::numbered("actuator_map.png", k), other.map);
    if (other.map.empty()) other.map = "none";
    options.others.push_back(std::move(other));
  }
}

/// The session.json of a folder.
class RecordedSession {
 public:
  /// Without a file, nothing is recorded.
  explicit RecordedSession(const std::string& file) : file_(file) {
    if (!file.empty()) json_ = parse_strict_json(read_text_file(file), file, kRemedy);
  }

  /// Returns a text that it records of a person, such as the facing; empty if it records none.
  std::string text(std::string_view key, std::size_t person) const {
    const std::string numbered = trace_format::numbered(key, person);
    const bool is_object = json_.is_object();
    if (is_object && !json_.contains(numbered)) return {};
    if (!is_object || !json_[numbered].is_string())
      throw Error(file_, fmt::format("is not a JSON object with a text '{}'", numbered), kRemedy);
    return json_[numbered].get<std::string>();
  }

  std::string name(std::size_t person) const {
    std::string name = text(trace_format::kNameKey, person);
    if (const std::string fault = name_fault(name); !fault.empty())
      throw Error(file_, fmt::format("its '{}' {}", trace_format::numbered(trace_format::kNameKey, person), fault),
                  "write a short name in one line");
    return name;
  }

 private:
  static constexpr const char* kRemedy = "export the trace again, or remove the file";
  std::string file_;
  nlohmann::json json_ = nlohmann::json::object();
};

void check_flags(const ImportOptions& options) {
  if (options.motion.empty() && options.poses.empty() && !options.colliders.empty())
    throw UsageError("import", "no motion and no poses are given",
                     "give --motion FILE.bvh or --poses FILE.csv; of colliders around a body that stands still, "
                     "'vestige record --animation none' with the same flags makes a trace");
  if (options.motion.empty() == options.poses.empty())
    throw UsageError(
        "import",
        options.motion.empty() ? "no motion and no poses are given" : "--motion and --poses cannot be combined",
        "give one of these: --motion FILE.bvh, --poses FILE.csv, or a folder that 'vestige export' wrote");
  if (options.motion.empty() && options.rate_hz)
    throw UsageError("--rate", "the file of poses sets the frame times", "leave --rate out, or give a --motion");
  if (const auto flag = options.motion_choice.given(); flag && options.motion.empty())
    throw UsageError(*flag, "it is about motion capture, and there is none",
                     *flag == "--unit" ? "leave --unit out: --pose-unit and --collider-unit are about CSV files"
                                       : "leave --up out: --pose-axes and --collider-axes are about CSV files");
  if (const auto flag = options.convention.given_for_poses(); flag && options.poses.empty())
    throw UsageError(*flag, "there is no file of poses",
                     fmt::format("leave {} out: --unit and --up are about motion capture", *flag));
  check_collider_convention(options.convention, options.colliders, !options.poses.empty());
  check_radius(options.radius, options.colliders);
  const bool from_gltf = options.colliders.ends_with(".glb") || options.colliders.ends_with(".gltf");
  if (!options.nodes.empty() && !from_gltf)
    throw UsageError("--nodes", "the colliders do not come from a glTF file",
                     "leave --nodes out, or name a .glb as --colliders");
  if (options.poses == "-" && options.colliders == "-")
    throw UsageError("-", "two inputs cannot share standard input", "give a file name for one of them");
}

/// The people of the files: the first, and those after it in a folder.
std::vector<Scene> load_scenes(const ImportOptions& options) {
  std::vector<PersonFiles> files = {{options.poses, options.avatar, options.map}};
  files.insert(files.end(), options.others.begin(), options.others.end());
  const RecordedSession session(options.session);
  std::vector<Scene> scenes;
  scenes.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string facing = session.text(trace_format::kFacingKey, i);
    if (files.size() > 1) require_axis(options.session, i, facing);
    const std::string name = session.name(i);
    scenes.push_back(load_scene(files[i].avatar, files[i].map, options.facing, options.common.verbosity(), facing));
    scenes.back().name = name;
  }
  require_different_names(options.session, scenes);
  return scenes;
}

TraceWriterOptions writing_of(const ImportOptions& options, const ImportedFrames& frames) {
  TraceWriterOptions writing;
  writing.overwrite = options.common.overwrite();
  writing.unfinished = Unfinished::kRemoved;
  writing.shape = frames.shape;
  writing.owners = frames.owners;
  if (options.compression == "lz4") writing.compression = Compression::kLz4;
  if (options.compression == "none") writing.compression = Compression::kNone;
  return writing;
}

/// Asks whether colliders have the axes of the poses, which a person nearly alike on both sides does not tell.
/// Empty if there is nothing to ask.
std::string doubt_of_axes(const ImportOptions& options) {
  const ConventionChoice& choice = options.convention;
  const bool is_told = options.are_collider_axes_given || choice.pose_axes == choice.collider_axes;
  if (options.poses.empty() || is_told || !options.colliders.ends_with(".csv")) return {};
  return fmt::format(
      "its axes are taken to be those of {}, and those of the poses are of {}; if both come from there: "
      "--collider-axes {}",
      choice.collider_axes, choice.pose_axes, choice.pose_axes);
}

/// What is asked about files of other programs once they are read.
class Questions {
 public:
  Questions(const Avatar& avatar, const ImportOptions& options, const ImportedFrames& frames)
      : pose_(avatar, options.convention.of_poses(), frames.placed) {
    if (!options.colliders.empty()) placement_.emplace(avatar, options.convention.of_colliders());
  }

  void see(const TraceFrame& frame) {
    if (placement_) placement_->see(frame);
    pose_.see(frame);
    any_collider_ = any_collider_ || !frame.colliders.empty();
  }

  void ask(const ImportOptions& options, const ImportedFrames& frames, std::uint64_t frame_count, double last_s) const {
    const auto doubt_of = [&](const std::string& file, const std::string& doubt) {
      if (!doubt.empty() && !file.empty()) warn(fmt::format("{}: {}", file, doubt), options.common.verbosity());
    };
    const std::vector<std::string> doubts = options.poses.empty() ? std::vector<std::string>() : pose_.ask();
    for (const std::string& doubt : doubts) doubt_of(options.poses, doubt);
    // Around a body that is wrong, colliders that are right look wrong.
    // With axes in doubt, an offset would be guessed in wrong ones.
    const std::string axes = doubt_of_axes(options);
    if (placement_ && doubts.empty()) doubt_of(options.colliders, axes.empty() ? placement_->ask().value_or("") : axes);
    if (!any_collider_)
      doubt_of(options.colliders,
               fmt::format("no frame has a collider; check that the file's times are those of the motion, 0 to {} s",
                           last_s));
    if (!frames.sampled || last_s <= 0) return;
    if (any_collider_) doubt_of(options.colliders, describe_small_overlap(frames.sampled->span_s(), last_s));
    const double rate_hz = static_cast<double>(frame_count - 1) / last_s;
    doubt_of(options.colliders, describe_resampling(frames.sampled->median_step_s(), rate_hz));
  }

 private:
  std::optional<PlacementQuestion> placement_;  ///< none without colliders
  PoseQuestion pose_;
  bool any_collider_ = false;
};

void run_import(ImportOptions options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_trace_name(options.output);
  if (!options.from.empty()) refuse_parts(options);
  const bool from_hdf5 = has_hdf5_name(options.from);
  if (!options.from.empty() && !from_hdf5) expand_folder(options);
  if (!from_hdf5) check_flags(options);
  if (options.avatar.empty() && !from_hdf5) options.avatar = "builtin";
  const std::vector<std::string> outputs = {options.output, options.common.json};
  std::vector<std::string> inputs = {options.from,   options.motion, options.poses,  options.colliders,
                                     options.avatar, options.map,    options.session};
  for (const PersonFiles& other : options.others) inputs.insert(inputs.end(), {other.poses, other.avatar, other.map});
  check_outputs(outputs, inputs, options.common);
  if (options.output == "-") refuse_terminal("-o -");

  ImportedFrames frames;
  std::vector<Scene> scenes =
      from_hdf5 ? read_hdf5(options.from, options.facing, frames, verbosity) : load_scenes(options);
  if (scenes.size() > 1 && options.facing.axis != FacingChoice().axis)
    throw UsageError("--facing", fmt::format("'{}' holds {}", options.from, count_of_people(scenes.size())),
                     "leave it out, or change who looks where in the session of the export");
  Scene& scene = scenes.front();
  std::optional<LoadedMotion> motion;
  Session session = provenance_texts(invocation.argv);
  session["colliders"] = options.colliders;
  if (!options.motion.empty()) {
    motion = add_motion(scene.avatar, options.motion, options.motion_choice, outputs, options.common);
    play_motion(scene.avatar, *motion, options.rate_hz, frames);
    session["animation"] = options.motion;
    session["rate_hz"] = fmt::format("{}", options.rate_hz.value_or(1 / motion->frame_time_s));
  } else if (!from_hdf5) {
    read_poses(options, scenes, frames);
    session["animation"] = options.poses;
    note_pose_convention(options.convention, session);
  }
  frames.placed.resize(scene.avatar.nodes.size());
  read_colliders(options, frames);
  if (!options.colliders.empty()) note_collider_convention(options.convention, session);
  if (!options.radius.text.empty()) session["radius"] = options.radius.text;

  catch_interrupts();
  TraceFrame frame;
  // The first frame is read before a file is begun: most mistakes show there.
  bool more = frames.next(frame);
  std::optional<Questions> questions;  // what 'vestige export' wrote is not in doubt
  if (options.from.empty()) questions.emplace(scene.avatar, options, frames);
  std::vector<TracePerson> people;
  people.reserve(scenes.size());
  for (const Scene& one : scenes) people.push_back(one.person());
  TraceWriter trace(options.output, session, people, writing_of(options, frames));
  {
    Progress progress("Importing", verbosity);
    for (; more; more = frames.next(frame)) {
      trace.write(frame);
      if (questions) questions->see(frame);
      if (!progress.update(frames.share())) throw Error(options.output, "importing was stopped", "");
    }
  }
  frames.finish();
  trace.finish();
  if (questions) questions->ask(options, frames, trace.frame_count(), frame.time_s());

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.output;
  json["frames"] = trace.frame_count();
  json["bytes"] = trace.bytes_written();
  if (motion) json["motion"] = to_json(*motion);
  json["avatar"] = to_json(scene.avatar);
  if (scenes.size() > 1)
    for (const Scene& one : scenes) {
      json["avatars"].push_back(to_json(one.avatar));
      json["avatars"].back()["name"] = one.name;
    }
  write_json(options.common.json, json, options.common);
  std::string text = fmt::format("{}: {} of {} s, {:.1f} MB\n", options.output, counted(trace.frame_count(), "frame"),
                                 frame.time_s(), static_cast<double>(trace.bytes_written()) / 1e6);
  if (motion) text += describe(*motion);
  print_summary(text, {options.output, options.common.json}, options.common);
}

}  // namespace

void add_import(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* verb = add_verb(program, "import", "Make a trace from motion capture, or from files of other programs",
                            "  vestige import --motion walk.bvh -o walk.mcap\n"
                            "  vestige import man_csv -o man_again.mcap\n");
  verb->add_option(
          "FROM", options->from,
          "A folder of CSV files, or an .h5 file, that 'vestige export' wrote: poses, colliders, avatar and map")
      ->type_name("DIR|FILE.h5");
  verb->add_option("--motion", options->motion,
                   std::string("Motion capture (BVH), frame by frame. Its joints are matched to the avatar's by their "
                               "names. ") +
                       kLeanHelp)
      ->type_name("FILE.bvh");
  verb->add_option("--poses", options->poses,
                   std::string("Poses of the avatar's own nodes, in rows time_s, NODE.tx ... NODE.sz; '-' is standard "
                               "input. Its convention: ") +
                       kConvention)
      ->type_name("FILE.csv|-");
  add_pose_convention(*verb, options->convention);
  verb->add_option(
          "--colliders", options->colliders,
          std::string("Colliders: rows time_s,id,x,y,z[,radius_m][,owner], a file that 'vestige export' wrote, or the "
                      "animated nodes of a "
                      "glTF file. Its convention: ") +
              kConvention + " [default: none]")
      ->type_name("FILE.csv|FILE.glb");
  add_collider_convention(*verb, options->convention);
  verb->add_option("--nodes", options->nodes, kNodesHelp)->type_name("PATTERN");
  add_radius_option(*verb, options->radius);
  verb->add_option("--avatar", options->avatar,
                   "The avatar that moves: the built-in one, or a glTF file (.glb, .gltf, .vrm) [default: builtin]")
      ->type_name("builtin|FILE");
  add_facing_option(*verb, options->facing);
  verb->add_option(
          "--map", options->map,
          "The actuator map: a layout, or a greyscale PNG in UV space or by triangle; FILE.json, if it exists, "
          "names the actuators [default: builtin for the built-in avatar, otherwise none]")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  add_motion_options(*verb, options->motion_choice);
  verb->add_option("--rate", options->rate_hz, "Frames per second of --motion [default: those of the motion]")
      ->type_name("HZ")
      ->check(help::kPositive);
  verb->add_option("--compression", options->compression, "How the trace's chunks are compressed")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "lz4", "none"}));
  verb->add_option("-o,--output", options->output, "The trace to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] {
    options->are_collider_axes_given = verb->count("--collider-axes") > 0;
    run_import(*options, invocation);
  });
}

}  // namespace vestige::cli
