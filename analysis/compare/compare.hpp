#pragma once

#include <string>
#include <vector>

#include "analysis/compare/measured_sweep.hpp"

namespace vestige {

/// How many times as fast B is as A, and the 95 % interval. The ends are NaN if one of the runs has too
/// few passes or scatters too much (`kFewestPasses`, `kMostScatter`).
struct SpeedRatio {
  double ratio = 1;
  double low = 0;
  double high = 0;
};

enum class SpeedVerdict { kSlower, kFaster, kUnclear, kSame };

/// Returns "slower", "faster", "unclear" or "same".
const char* name_of(SpeedVerdict verdict);

/// Returns the ratio of two runs of one point. The interval comes from both runs' passes, and from what two runs of one
/// program differ by although each agrees with itself (the constants in compare.cpp).
SpeedRatio speed_ratio(const PassTime& a, const PassTime& b);

/// kSlower and kFaster: the interval does not hold 1, and the ratio changes the duration by more than `threshold`
/// (0.05: 5 %). kSame: the whole interval changes it by less. kUnclear: anything else.
SpeedVerdict verdict_of(const SpeedRatio& ratio, double threshold);

struct ComparedPoint {
  std::string name;  ///< with the place of its sweep: "skip-hug: cpu, skip on, 40 colliders"
  MeasuredPoint a;
  MeasuredPoint b;
  SpeedRatio ratio;
  SpeedVerdict verdict = SpeedVerdict::kUnclear;

  bool same_answers() const { return a.texture_hash == b.texture_hash && a.contacts == b.contacts; }
};

struct SweepComparison {
  std::vector<ComparedPoint> points;  ///< the slowest first
  std::vector<std::string> only_a;    ///< points that B does not have
  std::vector<std::string> only_b;
  /// What differs between the runs beside their speed, a sentence each: commit, system, driver.
  std::vector<std::string> changes;

  std::size_t count(SpeedVerdict verdict) const;
};

enum class Machines { kSame, kAny };

/// Compares the points that both runs have. Sweeps belong together by their place, points by their name. Throws `Error`
/// if the runs share no point, if two sweeps that belong together have different schema versions or asked different
/// questions (avatar, surface, frames), and, with kSame, if they come from different machines or OpenGL renderers.
SweepComparison compare_sweeps(const std::vector<MeasuredSweep>& a, const std::vector<MeasuredSweep>& b,
                               double threshold, Machines machines);

}  // namespace vestige
