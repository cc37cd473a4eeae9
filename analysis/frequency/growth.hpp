#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// One size of the avatar, and the cost of a number of colliders on it.
struct GrowthSize {
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::uint32_t frames = 0;         ///< distinct frames, which are measured repeatedly
  std::vector<SweepSeries> series;  ///< one point each
};

struct GrowthSettings {
  SweepSettings sweep;             ///< `counts`: numbers of colliders on the given avatar
  std::uint32_t subdivisions = 4;  ///< the largest avatar has 4^subdivisions as many triangles
  std::uint32_t colliders = 100;   ///< number of colliders on every size
  double frame_limit_s = 1;        ///< as in Growth
};

/// The traces to measure on.
struct GrowthTraces {
  TraceReader& usual;
  TraceReader& crowded;  ///< for numbers of colliders that `usual` lacks; may be the same

  TraceReader& with(std::uint32_t colliders) const {
    return usual.collider_ids().size() >= colliders ? usual : crowded;
  }
};

/// At each size, all series are in the same order. A point is empty if the series was left out of that size.
struct Growth {
  std::vector<SweepSeries> by_colliders;
  std::vector<GrowthSize> by_triangles;
  /// A contestant whose mean frame took longer is left out of the larger sizes.
  double frame_limit_s = 0;
};

/// Above this number of collider-triangle pairs in a frame, a frame may take seconds. Then only single frames at three
/// places are measured, whatever the settings say.
inline constexpr std::uint64_t kManyPairs = 500'000;

/// Measures the cost against colliders on the avatar, then against triangles on subdivisions of the avatar. Within one
/// size (of colliders or of triangles), all contestants take turns. The sizes follow one another, since the largest
/// fill the memory. After each size, it measures the memory of its detectors. `survey` and `progress` are used as in
/// `run_sweep`.
Growth run_growth(GrowthTraces traces, SweptPerson person, const ContestantMaker& survey,
                  const std::vector<Contestant>& contestants, const GrowthSettings& settings,
                  const std::function<bool(double)>& progress);

/// Returns the mean microseconds of a frame at each point. NaN where nothing was measured.
std::vector<double> mean_us(const SweepSeries& series);

/// A crossing of two lines: below `at`, `cheaper_below` costs less; above `at`, `cheaper_above` costs less.
struct Crossover {
  std::string cheaper_below;
  std::string cheaper_above;
  double at = 0;
};

/// A line to compare with others.
struct CostLine {
  std::string name;
  std::vector<double> us;  ///< at each of `sizes`; above 0, or NaN
};

/// A line that ends before the largest size, since its frames became too slow.
struct LeftOut {
  std::string name;
  double size = 0;  ///< the last that was measured
  double frame_s = 0;
};

/// Returns the lines that are slower than the limit at a size other than the largest.
std::vector<LeftOut> left_out(std::span<const double> sizes, std::span<const CostLine> lines, double frame_limit_s);

/// Returns every crossing of two lines. Lines are straight between the `sizes` (ascending, above 0) on logarithmic
/// axes. A crossing does not count if the two lines cost the same within 2 % at the size before it.
std::vector<Crossover> crossovers(std::span<const double> sizes, std::span<const CostLine> lines);

/// What skipping saved at one point that was measured with and without skipping, as means over frames.
struct Ablation {
  std::string name;  ///< name of the series with skipping
  std::uint32_t colliders = 0;
  std::uint64_t frames = 0;  ///< frames of one pass; the counts below are of the same pass
  std::uint64_t frames_skipped = 0;
  std::uint64_t meshlets_skinned = 0;
  std::uint64_t triangles = 0;  ///< tested by brute force
  std::uint64_t triangles_tested = 0;
  std::uint64_t pairs = 0;  ///< tested by brute force
  std::uint64_t pairs_tested = 0;
  std::uint64_t pairs_meeting = 0;  ///< of those tested, the pairs that no test could have saved
  double off_us = 0;                ///< mean of a frame without skipping
  double on_us = 0;                 ///< mean of a frame with skipping
  double saved_by_frames_us = 0;    ///< of off_us - on_us: saved by frames that were skipped entirely
  double saved_by_meshlets_us = 0;  ///< the rest: saved by meshlets and boxes left out of the other frames
};

std::vector<Ablation> ablations(std::span<const SweepSeries> series);

}  // namespace vestige
