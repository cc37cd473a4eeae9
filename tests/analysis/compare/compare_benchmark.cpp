// How often `compare` is right: sweeps of one program, among them some in which every frame takes a tenth more time,
// are written as folders and compared with each other. Prints what share of the equal points is called slower or
// faster, and what share of the slower points is found. No test, since it depends on the machine. Takes about five
// minutes.

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/base/statistics.hpp"
#include "analysis/compare/compare.hpp"
#include "analysis/frequency/sweep_report.hpp"
#include "cli/measure/contestants.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "traces/files/output_file.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {
namespace {

using Clock = std::chrono::steady_clock;
using Microseconds = std::chrono::duration<double, std::micro>;

constexpr double kMoreTime = 0.1;
constexpr double kThreshold = 0.06;  // as by default
/// Slower runs lie between the others, so that what changes slowly in the machine concerns all alike.
constexpr std::string_view kOrder = "esesee";
const SweepSettings kSettings = {.counts = {1, 4, 8, 16, 32}, .runs = 5, .run_frames = 3, .min_time_s = 1.2};

/// Microseconds that the pose takes, by the number of colliders: it belongs to a frame, but no detector sees it.
using PoseTimes = std::map<std::size_t, double>;

/// A detector that needs a tenth more time for a frame than the one inside.
class Slowed final : public Detector {
 public:
  Slowed(std::unique_ptr<Detector> inner, const PoseTimes& pose_us) : inner_(std::move(inner)), pose_us_(pose_us) {}
  const char* name() const override { return inner_->name(); }
  Method method() const override { return inner_->method(); }
  bool is_approximate() const override { return inner_->is_approximate(); }
  GlInfo gl_info() const override { return inner_->gl_info(); }
  bool skins_in_shader() const override { return inner_->skins_in_shader(); }
  std::size_t triangles_left_out() const override { return inner_->triangles_left_out(); }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    const auto start = Clock::now();
    const DetectorWork work = inner_->detect(frame, row);
    const auto pose = pose_us_.find(frame.columns);
    const Microseconds pose_time(pose == pose_us_.end() ? 0 : pose->second);
    const Microseconds until = (Clock::now() - start) * (1 + kMoreTime) + pose_time * kMoreTime;
    while (Clock::now() - start < until) continue;
    return work;
  }
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    inner_->skinned_vertices(frame, out);
  }

 private:
  std::unique_ptr<Detector> inner_;
  const PoseTimes& pose_us_;
};

void record_swarm(const std::filesystem::path& file) {
  const Avatar& avatar = test::builtin_avatar();
  const Animation* animation = find_animation(avatar, "walk");
  const auto swarm = find_scenario("swarm")->make(avatar, animation, {kSettings.counts.back(), 1});
  TraceWriter writer(file, {}, {{avatar, {.avatar_glb = builtin_avatar_glb()}}}, {.overwrite = Overwrite::kAllow});
  const auto write = [&](const TraceFrame& frame) {
    writer.write(frame);
    return true;
  };
  record(write, {{avatar, animation}}, *swarm, {}, [](double) { return true; });
  writer.finish();
}

PoseTimes measure_poses(TraceReader& trace) {
  PoseTimes times;
  for (const std::uint32_t count : kSettings.counts) {
    FrameBuilder builder(test::builtin_avatar(), std::span(trace.collider_ids()).first(count));
    std::vector<double> us;
    trace.rewind();
    for (TraceFrame frame; trace.next(frame);) {
      const auto start = Clock::now();
      builder.next(frame);
      us.push_back(Microseconds(Clock::now() - start).count());
    }
    times[count] = quantile(us, 0.25);
  }
  return times;
}

void write(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  OutputFile output(file, Overwrite::kAllow);
  output.write(bytes);
  output.commit();
}

/// Writes the sweep as `vestige sweep -o` does, as far as `compare` reads it.
void write_sweep(const std::filesystem::path& folder, const Sweep& sweep) {
  std::filesystem::create_directories(folder);
  nlohmann::ordered_json json = provenance({});
  json["avatar"] = to_json(test::builtin_avatar());
  json["runs"] = sweep.places;
  json["run_frames"] = kSettings.run_frames;
  json["min_time_s"] = kSettings.min_time_s;
  json["complete"] = true;
  json["series"] = to_json(sweep.series, kSettings.seed);
  const std::string text = json.dump(2);
  write(folder / "sweep.json", std::as_bytes(std::span(text)));
  std::vector<std::byte> compressed;
  const std::string times = frame_times_csv(sweep.series);
  mcap::compress(mcap::Compression::kZstd, std::as_bytes(std::span(times)), compressed);
  write(folder / "frame_times.csv.zst", compressed);
}

struct Counts {
  std::size_t points = 0;
  std::map<SpeedVerdict, std::size_t> verdicts;

  void add(SpeedVerdict verdict) {
    ++points;
    ++verdicts[verdict];
  }
  double percent(SpeedVerdict verdict) const {
    const auto found = verdicts.find(verdict);
    return found == verdicts.end() ? 0 : 100 * static_cast<double>(found->second) / static_cast<double>(points);
  }
};

/// The words of a point's name before its number of colliders.
std::string series_of(const std::string& point) {
  return point.substr(0, point.rfind(", "));
}

void print(const std::string& name, const Counts& equal, const Counts& slower) {
  const auto words = [](const Counts& counts) {
    return fmt::format("{:8.1f} {:8.1f} {:8.1f} {:8.1f}", counts.percent(SpeedVerdict::kSlower),
                       counts.percent(SpeedVerdict::kFaster), counts.percent(SpeedVerdict::kSame),
                       counts.percent(SpeedVerdict::kUnclear));
  };
  fmt::print("{:34}  {} {}\n", name, words(equal), words(slower));
}

void report(const std::vector<std::vector<MeasuredSweep>>& sweeps) {
  std::map<std::string, Counts> equal;
  std::map<std::string, Counts> slower;
  const std::string all = "all";
  for (std::size_t a = 0; a < sweeps.size(); ++a)
    for (std::size_t b = 0; b < sweeps.size(); ++b) {
      if (a == b || kOrder[a] == 's') continue;
      auto& counts = kOrder[b] == 's' ? slower : equal;
      for (const ComparedPoint& point : compare_sweeps(sweeps[a], sweeps[b], kThreshold, Machines::kSame).points) {
        counts[series_of(point.name)].add(point.verdict);
        counts[all].add(point.verdict);
      }
    }
  fmt::print("{:34}  {:>35} {:>35}\n", "% of the points", "equal runs", "runs of a tenth more time");
  constexpr std::string_view kHeads = "  slower   faster     same  unclear";
  fmt::print("{:34}  {:>35} {:>35}\n", "series", kHeads, kHeads);
  for (const auto& [name, counts] : equal)
    if (name != all) print(name, counts, slower[name]);
  print(all, equal[all], slower[all]);
  const double called = equal[all].percent(SpeedVerdict::kSlower) + equal[all].percent(SpeedVerdict::kFaster);
  fmt::print("\n{:.1f} % of {} equal points are called slower or faster (asked for: at most 5 %).\n", called,
             equal[all].points);
  fmt::print("{:.1f} % of {} slower points are found (asked for: at least 90 %).\n",
             slower[all].percent(SpeedVerdict::kSlower), slower[all].points);
}

/// Returns the load average of the last minute: other programs make verdicts unclear.
std::string running_processes() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? fmt::format("{:.1f}", load) : "unknown";
}

int run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  record_swarm(folder / "trace.mcap");
  TraceReader trace(folder / "trace.mcap");
  const PoseTimes pose_us = measure_poses(trace);
  cli::ContestantChoice choice;
  choice.detectors = "paper,geometry,cpu,embree";
  choice.contexts = "egl";
  choice.skips = "off,on";
  const std::vector<SweptPerson> people = {{test::builtin_avatar(), test::builtin_map()}};
  const auto contestants = cli::make_contestants(choice, cli::Verbosity::kNormal);
  std::vector<Contestant> slowed = contestants;
  for (Contestant& contestant : slowed)
    contestant.make = [make = contestant.make, &pose_us](const Avatar& avatar, const ActuatorMap& map,
                                                         PlaneSet planes) {
      return std::make_unique<Slowed>(make(avatar, map, planes), pose_us);
    };
  const Machine machine = this_machine();
  fmt::print("{}, {} cores; commit {}; {}\n", machine.processor, machine.cores, commit(), utc_now());
  fmt::print("Processes that ran or waited to run, at the beginning: {}\n", running_processes());
  fmt::print("{} sweeps, in this order (s: every frame takes a tenth more time): {}\n", kOrder.size(), kOrder);
  std::vector<std::vector<MeasuredSweep>> sweeps;
  for (std::size_t i = 0; i < kOrder.size(); ++i) {
    const auto& raced = kOrder[i] == 's' ? slowed : contestants;
    const auto place = folder / fmt::format("{}-{}", i + 1, kOrder[i] == 's' ? "slower" : "equal");
    write_sweep(place,
                run_sweep(trace, people, cli::survey_maker(choice), raced, kSettings, [](double) { return true; }));
    sweeps.push_back(read_measured_sweeps(place));
  }
  fmt::print("Processes that ran or waited to run, at the end: {} (one of them is this one)\n\n", running_processes());
  report(sweeps);
  return 0;
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  // llvmpipe draws in the calling thread: threads of its own wait for a core as often as other programs run.
  ::setenv("LP_NUM_THREADS", "0", 0);
  return vestige::run(argc > 1 ? argv[1] : "out/compare_benchmark");
}
