#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/base/statistics.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr double kNormal = 1.959963984540054;

/// Student's t at 97.5 %, for batches - 1 degrees of freedom, from `kFewestPasses` batches on.
constexpr std::array<double, kMostBatches - kFewestPasses + 1> kStudent = {2.365, 2.306, 2.262};

/// Two runs of one program differ by more than their passes tell: memory lies elsewhere (Embree alone varies by up to 6
/// % from one start to the next), and other programs run. These are standard deviations of the logarithm of the ratio:
/// one that is always there, and one for each unit by which the runs' scatter differs. If it differs, then the ratio of
/// the medians is another one than that of the lower quartiles. Both were chosen by 26 sweeps of one program (24 to 30
/// points: `paper`, `geometry`, `cpu` and Embree on llvmpipe) on two virtual cores beside 2 to 6 other processes, and
/// two committed sweeps on a machine at rest, so that fewer than 5 % of the equal points are called in most of them.
/// compare_benchmark measures the same anew.
constexpr double kBetweenRuns = 0.02;
constexpr double kPerScatter = 0.6;

struct Pair {
  const MeasuredSweep& a;
  const MeasuredSweep& b;
};

std::string point_name(const MeasuredSweep& sweep, const MeasuredPoint& point) {
  return sweep.place.empty() ? point.name : sweep.place + ": " + point.name;
}

void refuse_other_question(const Pair& pair) {
  const std::string where = pair.b.file.string();
  if (pair.a.schema_version != pair.b.schema_version)
    throw Error(where,
                fmt::format("has schema_version {}, but {} has {}: the same fields may mean something else",
                            pair.b.schema_version, pair.a.file.string(), pair.a.schema_version),
                "measure again with the older one's commit and the newer program");
  const auto value_in = [](const MeasuredSweep& sweep, const std::string& key) {
    const auto found = std::ranges::find(sweep.question, key, &std::pair<std::string, std::string>::first);
    return found == sweep.question.end() ? std::string("none") : found->second;
  };
  for (const auto& questions : {pair.a.question, pair.b.question})
    for (const auto& [key, value] : questions)
      if (value_in(pair.a, key) != value_in(pair.b, key))
        throw Error(where,
                    fmt::format("was measured with {} {}, but {} with {}", key, value_in(pair.b, key),
                                pair.a.file.string(), value_in(pair.a, key)),
                    "measure both with the same flags on the same trace");
}

void refuse_other_machine(const Pair& pair) {
  if (pair.a.processor == pair.b.processor && pair.a.cores == pair.b.cores) return;
  throw Error(pair.b.file.string(),
              fmt::format("comes from another machine ({}, {} cores) than {} ({}, {} cores)", pair.b.processor,
                          pair.b.cores, pair.a.file.string(), pair.a.processor, pair.a.cores),
              "measure both on one machine, or compare the machines with --across-machines");
}

void refuse_other_renderer(const Pair& pair, const ComparedPoint& point) {
  if (point.a.renderer == point.b.renderer) return;
  throw Error(pair.b.file.string(),
              fmt::format("'{}' ran on another OpenGL renderer ({}) than in {} ({})", point.name, point.b.renderer,
                          pair.a.file.string(), point.a.renderer),
              "measure both on one renderer, or compare the renderers with --across-machines");
}

/// Adds "WHAT: A -> B", unless the two are equal or the sentence is there already.
void add_change(std::vector<std::string>& changes, const char* what, const std::string& a, const std::string& b) {
  const std::string sentence = fmt::format("{}: {} -> {}", what, a, b);
  if (a != b && std::ranges::find(changes, sentence) == changes.end()) changes.push_back(sentence);
}

void compare_pair(const Pair& pair, double threshold, Machines machines, SweepComparison& comparison) {
  refuse_other_question(pair);
  if (machines == Machines::kSame) refuse_other_machine(pair);
  const auto machine_of = [](const MeasuredSweep& sweep) {
    return fmt::format("{}, {} cores", sweep.processor, sweep.cores);
  };
  add_change(comparison.changes, "commit", pair.a.commit, pair.b.commit);
  add_change(comparison.changes, "machine", machine_of(pair.a), machine_of(pair.b));
  add_change(comparison.changes, "system", pair.a.system, pair.b.system);
  for (const MeasuredPoint& a : pair.a.points) {
    const auto b = std::ranges::find(pair.b.points, a.name, &MeasuredPoint::name);
    if (b == pair.b.points.end()) {
      comparison.only_a.push_back(point_name(pair.a, a));
      continue;
    }
    ComparedPoint point = {point_name(pair.a, a), a, *b, speed_ratio(a.time, b->time)};
    if (a.pass_frames != b->pass_frames)
      throw Error(pair.b.file.string(),
                  fmt::format("'{}' has {} frames in a pass, but {} in {}", point.name, b->pass_frames, a.pass_frames,
                              pair.a.file.string()),
                  "measure both with the same flags on the same trace");
    if (machines == Machines::kSame) refuse_other_renderer(pair, point);
    add_change(comparison.changes, "OpenGL", fmt::format("{}, {}", a.renderer, a.driver),
               fmt::format("{}, {}", b->renderer, b->driver));
    point.verdict = verdict_of(point.ratio, threshold);
    comparison.points.push_back(std::move(point));
  }
  for (const MeasuredPoint& b : pair.b.points)
    if (std::ranges::find(pair.a.points, b.name, &MeasuredPoint::name) == pair.a.points.end())
      comparison.only_b.push_back(point_name(pair.b, b));
}

void add_all(const MeasuredSweep& sweep, std::vector<std::string>& names) {
  for (const MeasuredPoint& point : sweep.points) names.push_back(point_name(sweep, point));
}

}  // namespace

const char* name_of(SpeedVerdict verdict) {
  switch (verdict) {
    case SpeedVerdict::kSlower:
      return "slower";
    case SpeedVerdict::kFaster:
      return "faster";
    case SpeedVerdict::kUnclear:
      return "unclear";
    case SpeedVerdict::kSame:
      return "same";
  }
  return "";
}

SpeedRatio speed_ratio(const PassTime& a, const PassTime& b) {
  SpeedRatio ratio = {a.us / b.us, kMissing, kMissing};
  const std::size_t batches = std::min(a.batches, b.batches);
  if (batches < kFewestPasses || std::max(a.scatter, b.scatter) > kMostScatter) return ratio;
  const double scatter = kPerScatter * (a.scatter - b.scatter);
  const double between = kBetweenRuns * kBetweenRuns + scatter * scatter;
  const double student = kStudent[batches - kFewestPasses];
  const double half =
      std::sqrt(student * student * (a.error * a.error + b.error * b.error) + kNormal * kNormal * between);
  ratio.low = ratio.ratio * std::exp(-half);
  ratio.high = ratio.ratio * std::exp(half);
  return ratio;
}

SpeedVerdict verdict_of(const SpeedRatio& ratio, double threshold) {
  const double most = 1 + threshold;
  if (ratio.high < 1 && ratio.ratio < 1 / most) return SpeedVerdict::kSlower;
  if (ratio.low > 1 && ratio.ratio > most) return SpeedVerdict::kFaster;
  return ratio.low > 1 / most && ratio.high < most ? SpeedVerdict::kSame : SpeedVerdict::kUnclear;
}

std::size_t SweepComparison::count(SpeedVerdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(points, verdict, &ComparedPoint::verdict));
}

SweepComparison compare_sweeps(const std::vector<MeasuredSweep>& a, const std::vector<MeasuredSweep>& b,
                               double threshold, Machines machines) {
  SweepComparison comparison;
  for (const MeasuredSweep& one : a) {
    const auto other = std::ranges::find(b, one.place, &MeasuredSweep::place);
    if (other == b.end())
      add_all(one, comparison.only_a);
    else
      compare_pair({one, *other}, threshold, machines, comparison);
  }
  for (const MeasuredSweep& one : b)
    if (std::ranges::find(a, one.place, &MeasuredSweep::place) == a.end()) add_all(one, comparison.only_b);
  if (comparison.points.empty())
    throw Error(fmt::format("{} and {}", a.front().file.string(), b.front().file.string()),
                fmt::format("have no point in common: '{}' is only in the first, '{}' only in the second",
                            comparison.only_a.empty() ? "nothing" : comparison.only_a.front(),
                            comparison.only_b.empty() ? "nothing" : comparison.only_b.front()),
                "measure both with the same --detector, --context and --counts");
  std::ranges::stable_sort(comparison.points, {}, [](const ComparedPoint& point) { return point.ratio.ratio; });
  return comparison;
}

}  // namespace vestige
