#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "analysis/base/provenance.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/choices/scene.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/exported_contacts.hpp"
#include "cli/help/validators.hpp"
#include "cli/output_bytes.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/system_error.hpp"
#include "traces/exchange/frame_thinning.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/files/output_file.hpp"
#include "traces/scene/facing.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

struct ExportOptions {
  CommonOptions common;
  std::string file;
  std::string output;
  std::string format;
  std::string what = "all";
  std::string contacts;
  std::optional<double> rate_hz;
};

/// By --format, or by the name's end; a name without one is a folder of CSV files.
std::string format_of(const ExportOptions& options) {
  if (!options.format.empty()) return options.format;
  if (options.output == "-")
    throw UsageError("-o -", "the format is not given", "add --format ndjson, or --format csv --what poses");
  for (const ExportFormat& format : export_formats())
    for (const std::string_view end : format.ends)
      if (options.output.ends_with(end)) return std::string(format.name);
  if (!std::filesystem::path(options.output).has_extension() || std::filesystem::is_directory(options.output))
    return "csv";
  throw UsageError("-o", fmt::format("'{}' has no known extension", options.output),
                   "end the name in .csv, .ndjson, .h5, .glb or .pvd, name a folder (for CSV), or add --format");
}

constexpr const char* kPosesName = "poses.csv";

bool exists(const std::string& path) {
  return std::filesystem::exists(path);
}

struct Attachment {
  std::string path;
  std::span<const std::byte> bytes;  ///< empty: the trace has none
};

/// The frames' files beside the avatars, their maps, names and facing, so that `import` finds all of it.
class CsvFolder {
 public:
  CsvFolder(const std::string& folder, const TraceReader& trace) : folder_(folder) {
    using trace_format::attachment_name;
    using trace_format::AttachmentKind;
    colliders = inside("colliders.csv");
    session = inside("session.json");
    nlohmann::ordered_json json;
    for (std::size_t i = 0; i < trace.people().size(); ++i) {
      const RecordedPerson& person = trace.people()[i];
      poses.push_back(inside(trace_format::numbered(kPosesName, i)));
      attachments.push_back({inside(attachment_name(AttachmentKind::kAvatar, i)), person.avatar_glb});
      attachments.push_back({inside(attachment_name(AttachmentKind::kMapImage, i)), person.actuator_map_png});
      attachments.push_back({inside(attachment_name(AttachmentKind::kMapText, i)), person.actuator_map_json});
      if (facing_named(person.facing)) json[trace_format::numbered(trace_format::kFacingKey, i)] = person.facing;
      if (const std::string name = readable_name(person.name); !name.empty())
        json[trace_format::numbered(trace_format::kNameKey, i)] = name;
    }
    if (!json.empty()) session_json = json.dump(2) + "\n";
  }
  std::vector<std::string> written() const {
    std::vector<std::string> all = poses;
    all.push_back(colliders);
    for (const Attachment& attachment : attachments)
      if (!attachment.bytes.empty()) all.push_back(attachment.path);
    if (!session_json.empty()) all.push_back(session);
    return all;
  }
  /// What an earlier export may have left, which `import` would take.
  std::vector<std::string> removed() const {
    std::vector<std::string> all;
    for (const Attachment& attachment : attachments)
      if (attachment.bytes.empty()) all.push_back(attachment.path);
    if (session_json.empty()) all.push_back(session);
    for (std::size_t i = poses.size(); i < trace_format::kMostPeople; ++i) {
      std::vector<std::string> more = {inside(trace_format::numbered(kPosesName, i))};
      for (const trace_format::AttachmentKind kind : trace_format::kAttachmentKinds)
        more.push_back(inside(trace_format::attachment_name(kind, i)));
      std::ranges::copy_if(more, std::back_inserter(all), exists);
    }
    return all;
  }

  std::vector<std::string> poses;  ///< by person
  std::string colliders;
  std::vector<Attachment> attachments;
  std::string session;
  std::string session_json;  ///< empty: the trace says neither names nor where its avatars face

 private:
  std::string inside(const std::string& name) const { return (std::filesystem::path(folder_) / name).string(); }

  std::string folder_;
};

void check_flags(const ExportOptions& options, const std::string& format) {
  if (!options.contacts.empty() && format != "hdf5")
    throw UsageError("--contacts", fmt::format("{} has no place for contacts", format),
                     "end the name in .h5, or leave --contacts out");
  if (!options.contacts.empty() && options.rate_hz)
    throw UsageError("--contacts", "with --rate, frames get other numbers than those of the contacts",
                     "leave one of the two out");
  if (options.what != "all" && format != "csv")
    throw UsageError("--what", fmt::format("{} holds poses and colliders together", format), "leave --what out");
  const bool is_file = options.output == "-" || options.output.ends_with(".csv");
  if (format == "csv" && options.what == "all" && is_file)
    throw UsageError("-o", "poses and colliders are two tables",
                     "add --what poses or --what colliders, or name a folder");
  if (options.output == "-" && (format == "hdf5" || format == "gltf")) refuse_terminal("-o -");
  if (format == "paraview" && options.output == "-")
    throw UsageError("-o -", "ParaView reads a folder of files", "name a .pvd");
  if (format == "paraview" && !options.common.json.empty())
    throw UsageError("--json", "'vestige plot paraview' writes no JSON", "leave --json out");
}

void write_beside_frames(const CsvFolder& folder, const CommonOptions& options) {
  for (const Attachment& attachment : folder.attachments)
    if (!attachment.bytes.empty()) write_bytes(attachment.path, attachment.bytes, options);
  if (!folder.session_json.empty()) write_bytes(folder.session, std::as_bytes(std::span(folder.session_json)), options);
}

void remove_files(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    std::error_code failure;
    std::filesystem::remove(path, failure);
    if (failure) throw system_error(path, "could not remove the file", failure.value());
  }
}

/// Returns the exit code of vestige-plot.
int export_for_paraview(const ExportOptions& options) {
  check_outputs({options.output}, {options.file}, options.common);
  if (options.file != "-" && TraceReader(options.file, People::kSeveral).people().size() > 1)
    throw UsageError(
        "-o", fmt::format("ParaView gets one person, and {} holds several", options.file),
        fmt::format("choose one: vestige plot paraview {} --person 1 -o {}", options.file, options.output));
  std::vector<std::string> arguments = {"paraview", options.file, "-o", options.output};
  if (options.rate_hz) arguments.insert(arguments.end(), {"--rate", fmt::format("{}", *options.rate_hz)});
  if (options.common.force) arguments.emplace_back("--force");
  if (options.common.quiet) arguments.emplace_back("-q");
  return run_plot(arguments);
}

/// The files that are not in a folder: one, but of --what poses one for each person, OUT.csv, OUT.2.csv, ….
std::vector<std::string> output_paths(const ExportOptions& options, const OpenTrace& trace) {
  std::vector<std::string> paths = {options.output};
  if (options.what != "poses") return paths;
  for (std::size_t i = 1; i < trace.people.size(); ++i) paths.push_back(numbered_path(options.output, i));
  if (paths.size() > 1 && is_pipe(options.output))
    throw UsageError(
        "-o", fmt::format("each of {} people has a table of poses, and '{}' takes one", paths.size(), options.output),
        "name a file: OUT.csv is the first person's, OUT.2.csv the second's");
  if (const std::string more = numbered_path(options.output, trace.people.size()); exists(more))
    warn(fmt::format("{}: is not of this trace, which holds {}", more, count_of_people(trace.people.size())),
         options.common.verbosity());
  return paths;
}

std::vector<std::unique_ptr<TraceExport>> make_files(const ExportOptions& options, const std::string& format,
                                                     const std::optional<CsvFolder>& folder,
                                                     const std::vector<std::string>& outputs, OpenTrace& trace,
                                                     const std::optional<ExportedContacts>& contacts) {
  TraceReader& reader = trace.reader;
  const Overwrite overwrite = options.common.overwrite();
  std::vector<std::unique_ptr<TraceExport>> files;
  const auto add_poses = [&](const std::vector<std::string>& paths) {
    for (std::size_t i = 0; i < paths.size(); ++i)
      files.push_back(make_pose_csv(paths[i], overwrite, reader.people()[i].node_names, i));
  };
  if (folder) {
    add_poses(folder->poses);
    files.push_back(make_collider_csv(folder->colliders, overwrite, reader.shape(), reader.owners()));
  } else if (format == "csv") {
    if (options.what == "poses")
      add_poses(outputs);
    else
      files.push_back(make_collider_csv(options.output, overwrite, reader.shape(), reader.owners()));
  } else if (format == "ndjson") {
    files.push_back(make_frame_ndjson(options.output, overwrite));
  } else if (format == "hdf5") {
    std::function<void(hid_t)> write_contacts;
    if (contacts) write_contacts = [&contacts, &options](hid_t file) { contacts->write(file, options.output); };
    files.push_back(make_frame_hdf5(options.output, overwrite, reader, std::move(write_contacts)));
  } else {
    std::vector<GltfPerson> people;
    for (std::size_t i = 0; i < trace.people.size(); ++i)
      people.push_back({trace.people[i].name, trace.people[i].avatar, reader.people()[i].avatar_glb});
    files.push_back(make_frame_gltf(options.output, overwrite, people,
                                    {.all = reader.collider_ids(), .spheres = reader.sphere_ids()}));
  }
  return files;
}

/// Returns how many frames each file has.
std::uint64_t write_frames(TraceReader& reader, const std::vector<std::unique_ptr<TraceExport>>& files,
                           std::optional<ExportedContacts>& contacts, const ExportOptions& options) {
  std::optional<FrameThinning> thinning;
  if (options.rate_hz) thinning.emplace(*options.rate_hz);
  const auto total = static_cast<double>(reader.frame_count());
  std::uint64_t read = 0;
  std::uint64_t written = 0;
  Progress progress("Exporting", options.common.verbosity());
  TraceFrame frame;
  while (reader.next(frame)) {
    ++read;
    if (contacts) contacts->check(frame);
    if (!thinning || thinning->keep(frame)) {
      for (const auto& file : files) file->write(frame);
      ++written;
    }
    if (!progress.update(static_cast<double>(read) / total)) throw Error(options.output, "exporting was stopped", "");
  }
  return written;
}

void run_export(const ExportOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::string format = format_of(options);
  check_flags(options, format);
  check_inputs({options.file, options.contacts});
  if (format == "paraview") {
    invocation.exit_code = export_for_paraview(options);
    return;
  }
  const bool is_folder = format == "csv" && options.what == "all";
  if (!is_folder)
    check_outputs({options.output, options.common.json}, {options.file, options.contacts}, options.common);
  OpenTrace trace(options.file, verbosity, People::kSeveral);
  TraceReader& reader = trace.reader;
  std::optional<CsvFolder> folder;
  std::vector<std::string> all;
  if (is_folder) {
    folder.emplace(options.output, reader);
    all = folder->removed();
    make_output_folder(options.output);
  }
  const std::vector<std::string> outputs = folder ? folder->written() : output_paths(options, trace);
  all.insert(all.end(), outputs.begin(), outputs.end());
  all.push_back(options.common.json);
  if (is_folder || outputs.size() > 1) check_outputs(all, {options.file}, options.common);
  catch_interrupts();
  require_frames(reader, options.file);
  const std::uint64_t total = reader.frame_count();
  std::optional<ExportedContacts> contacts;
  if (!options.contacts.empty()) contacts.emplace(options.contacts, trace);
  const std::vector<std::unique_ptr<TraceExport>> files = make_files(options, format, folder, outputs, trace, contacts);
  const std::uint64_t written = write_frames(reader, files, contacts, options);
  std::vector<std::string> losses;
  for (const auto& file : files) {
    const auto some = file->losses();
    losses.insert(losses.end(), some.begin(), some.end());
  }
  if (folder) write_beside_frames(*folder, options.common);
  for (const auto& file : files) file->commit();
  if (folder) remove_files(folder->removed());
  for (const std::string& loss : losses) warn(fmt::format("{}: {}", options.output, loss), verbosity);
  invocation.exit_code = report_damage(reader, options.file, verbosity);
  if (!losses.empty()) invocation.exit_code = kDataLost;

  nlohmann::ordered_json json = with_provenance(invocation.argv, {{"trace", options.file},
                                                                  {"format", format},
                                                                  {"outputs", outputs},
                                                                  {"frames", written},
                                                                  {"frames_in_trace", total},
                                                                  {"colliders", reader.collider_ids().size()}});
  if (contacts) json["contacts"] = contacts->count();
  json.update({{"losses", losses}, {"complete", reader.complete()}});
  write_json(options.common.json, json, options.common);
  print_summary(fmt::format("{}: {} of {} and {}{}\n", options.output, counted(written, "frame"),
                            counted(reader.collider_ids().size(), "collider"),
                            trace.people.size() == 1 ? counted(reader.people().front().node_names.size(), "node")
                                                     : count_of_people(trace.people.size()),
                            contacts ? ", " + counted(contacts->count(), "contact") : ""),
                {options.output, options.common.json}, options.common);
}

}  // namespace

void add_export(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* verb = add_verb(program, "export", "Write a trace for other programs: CSV, NDJSON, HDF5, glTF, ParaView",
                            "  vestige export man.mcap -o man_animated.glb\n"
                            "  vestige export man.mcap -o - --format csv --what colliders --rate 10\n");
  verb->add_option("FILE", options->file, "The trace, or '-' for standard input")->required();
  verb->add_option("-o,--output", options->output,
                   "The file to write; its extension sets the format. A name without an extension is a folder with "
                   "poses.csv, colliders.csv, the avatar, its map and its facing; of several people, the second's are "
                   "poses.2.csv and so on. '-' is standard output")
      ->required()
      ->type_name("OUT|-");
  verb->add_option(
          "--format", options->format,
          "The format:\n"
          "  csv       poses: a row for each frame; colliders: a row for each collider and frame; lossless\n"
          "  ndjson    a line of JSON for each frame, which 'record --live' can read if there is one person; lossless\n"
          "  hdf5      (.h5) for Python, MATLAB and others; lossless\n"
          "  gltf      (.glb) the avatars' animation and a sphere for each collider; fp32\n"
          "  paraview  (.pvd) posed surfaces, which vestige-plot writes [default: by the extension]")
      ->check(CLI::IsMember({"csv", "ndjson", "hdf5", "gltf", "paraview"}));
  verb->add_option("--what", options->what, "Which of the two tables to write; CSV only")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "poses", "colliders"}));
  verb->add_option("--contacts", options->contacts,
                   "Take the contacts along that 'vestige replay --contacts FILE' wrote (.csv, .h5); HDF5 only")
      ->type_name("FILE");
  verb->add_option(
          "--rate", options->rate_hz,
          "Write at most this many frames per second, and renumber them [default: all frames; for paraview, that of "
          "'vestige plot paraview']")
      ->type_name("HZ")
      ->check(help::between(help::kLeastRate_hz, help::kMostRate_hz));
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] {
    try {
      run_export(*options, invocation);
    } catch (const PipeClosed&) {
      // Of text, `| head` has seen enough.
      const std::string format = format_of(*options);
      if (format != "csv" && format != "ndjson") throw;
    }
  });
}

}  // namespace vestige::cli
