#include "analysis/compare/measured_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "analysis/base/json_field.hpp"
#include "traces/base/csv.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/compression.hpp"

namespace vestige {

namespace {

constexpr std::string_view kSweepRemedy = "name a folder that 'vestige sweep -o' wrote, or measure again";
constexpr const char* kSweepName = "sweep.json";
constexpr const char* kTimesName = "frame_times.csv.zst";
constexpr std::size_t kMostTimesBytes = std::size_t{1} << 31;
constexpr double kMostCounted = 1e12;
constexpr double kLeastHz = 1e-6;
constexpr double kMostHz = 1e12;
constexpr double kMost_us = 1e12;

std::uint64_t whole(const JsonField& field, double least) {
  const double number = field.within(least, kMostCounted);
  if (number != std::floor(number)) field.refuse("is not a whole number");
  return static_cast<std::uint64_t>(number);
}

/// The durations of a sweep's frames, which have the order of the points in sweep.json.
class FrameTimes {
 public:
  FrameTimes(std::string_view csv, const std::string& file) : lines_(csv, file, kSweepRemedy), file_(file) {
    if (lines_.take_header().back() != "us") throw lines_.error("the last column is not 'us'");
  }

  std::vector<double> next(std::uint64_t frames, const std::string& point) {
    std::vector<double> durations_us;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
      if (!lines_.next()) throw Error(file_, fmt::format("ends before the last frame of '{}'", point), kSweepRemedy);
      std::string_view last;
      while (!lines_.at_end()) lines_.take_text(last);
      double us = 0;
      const auto [end, failure] = std::from_chars(last.data(), last.data() + last.size(), us);
      if (failure != std::errc() || end != last.data() + last.size() || !(us >= 0 && us <= kMost_us))
        throw lines_.error(fmt::format("'{}' is no duration", last));
      durations_us.push_back(us);
    }
    return durations_us;
  }

  void end() {
    if (lines_.next()) throw lines_.error(fmt::format("is of no point in the {} beside it", kSweepName));
  }

 private:
  CsvLines lines_;
  std::string file_;
};

std::string text_or_empty(const JsonField& field, const char* key) {
  return field.has(key) ? field.at(key).text() : "";
}

/// Returns what tells a series from others of its sweep, in the words of a sweep's table: "paper, egl-surfaceless, 4
/// planes", "cpu, skip on, ccd".
std::string series_name(const JsonField& series) {
  std::string name = series.at("detector").text();
  if (name.empty()) series.at("detector").refuse("is empty");
  const auto add = [&name](const std::string& words) {
    if (!words.empty()) name += ", " + words;
  };
  if (series.has("triangles_kept")) name += fmt::format(" ({} triangles)", whole(series.at("triangles_kept"), 0));
  add(text_or_empty(series, "context"));
  // Version 0.2 did not know planes, and measured one.
  const std::uint64_t planes = series.has("planes") ? whole(series.at("planes"), 0) : 1;
  if (planes > 1) add(counted(planes, "plane"));
  if (text_or_empty(series, "skip") == "on") add("skip on");
  if (text_or_empty(series, "method") != "static") add(text_or_empty(series, "method"));
  if (text_or_empty(series, "renderer") == "on") add("rendering");
  // Version 0.4 did not know several people.
  if (const std::uint64_t people = series.has("avatars") ? whole(series.at("avatars"), 1) : 1; people > 1)
    add(fmt::format("{} people", people));
  if (text_or_empty(series, "colliders_around") == "first") add("colliders around the first");
  return name;
}

MeasuredPoint read_point(const JsonField& field, const std::string& series, FrameTimes& times) {
  MeasuredPoint point;
  point.name = fmt::format("{}, {}", series, counted(whole(field.at("colliders"), 1), "collider"));
  point.hz = field.at("hz").within(kLeastHz, kMostHz);
  // Before stored_frames, all durations were stored.
  const std::uint64_t frames = whole(field.at(field.has("stored_frames") ? "stored_frames" : "frames"), 1);
  point.pass_frames = whole(field.at("pass_frames"), 1);
  if (point.pass_frames > frames) field.at("pass_frames").refuse("is more than frames");
  point.contacts = whole(field.at("contacts"), 0);
  point.texture_hash = field.at("texture_hash").text();
  point.time = pass_time(times.next(frames, point.name), point.pass_frames);
  if (!(point.time.us > 0)) field.at("frames").refuse("took no time");
  return point;
}

void read_series(const JsonField& series, FrameTimes& times, std::vector<MeasuredPoint>& points) {
  const std::string name = series_name(series);
  if (series.at("points").value().is_array() && series.at("points").value().empty()) return;
  for (std::size_t i = 0; i < series.at("points").count(); ++i) {
    MeasuredPoint point = read_point(series.at("points").at(i), name, times);
    if (series.has("gl")) {
      point.renderer = text_or_empty(series.at("gl"), "renderer");
      point.driver = text_or_empty(series.at("gl"), "version");
    }
    if (std::ranges::find(points, point.name, &MeasuredPoint::name) != points.end())
      series.refuse(fmt::format("has '{}' a second time", point.name));
    points.push_back(std::move(point));
  }
}

void read_question(const JsonField& document, MeasuredSweep& sweep) {
  for (const char* key : {"vertices", "triangles", "joints"})
    sweep.question.emplace_back(fmt::format("avatar.{}", key), document.at("avatar").at(key).value().dump());
  for (const char* key : {"surface", "runs", "run_frames", "seed"})
    if (document.has(key)) sweep.question.emplace_back(key, document.at(key).value().dump());
  if (document.has("sample") && document.at("sample").has("sha256"))
    sweep.question.emplace_back("poses and colliders of SHA-256", document.at("sample").at("sha256").text());
}

MeasuredSweep read_sweep(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const nlohmann::json json = read_json(file, kSweepRemedy);
  const JsonField document(json, file, kSweepRemedy);
  if (!json.is_object()) document.refuse("is not a JSON object");
  MeasuredSweep sweep;
  sweep.file = file;
  sweep.place = file.parent_path().lexically_relative(folder).generic_string();
  if (sweep.place == ".") sweep.place.clear();
  sweep.schema_version = whole(document.at("schema_version"), 1);
  if (!document.at("complete").flag())
    throw Error(file.string(), "is of a sweep that was stopped early", "measure again, to the end");
  sweep.commit = commit_of(document);
  sweep.time = document.at("time").text();
  sweep.processor = document.at("machine").at("processor").text();
  sweep.cores = whole(document.at("machine").at("cores"), 0);
  sweep.system = document.at("machine").at("system").text();
  read_question(document, sweep);

  sweep.times_file = file.parent_path() / kTimesName;
  const std::filesystem::path& times_file = sweep.times_file;
  if (!std::filesystem::exists(times_file))
    throw Error(times_file.string(), "is missing; a comparison needs the duration of every frame", kSweepRemedy);
  mcap::RawBuffer buffer;
  const auto csv = mcap::decompress_beginning(mcap::name_of(mcap::Compression::kZstd), read_file(times_file),
                                              kMostTimesBytes, buffer);
  if (csv.empty()) throw Error(times_file.string(), "holds nothing that zstd can expand", kSweepRemedy);
  FrameTimes times(text_of(csv), times_file.string());
  for (std::size_t i = 0; i < document.at("series").count(); ++i)
    read_series(document.at("series").at(i), times, sweep.points);
  times.end();
  return sweep;
}

}  // namespace

std::vector<MeasuredSweep> read_measured_sweeps(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder))
    throw Error(folder.string(), std::filesystem::exists(folder) ? "is not a folder" : "does not exist", kSweepRemedy);
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (std::filesystem::recursive_directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure))
    if (entry->path().filename() == kSweepName) files.push_back(entry->path());
  if (failure) throw Error(folder.string(), fmt::format("cannot be searched: {}", failure.message()), kSweepRemedy);
  if (files.empty()) throw Error(folder.string(), fmt::format("holds no {}", kSweepName), kSweepRemedy);
  std::ranges::sort(files);
  std::vector<MeasuredSweep> sweeps;
  sweeps.reserve(files.size());
  for (const auto& file : files) sweeps.push_back(read_sweep(file, folder));
  return sweeps;
}

}  // namespace vestige
