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

/// One size of the avatar, and what a number of colliders costs on it.
struct GrowthSize {
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::uint32_t frames = 0;         ///< distinct ones that were measured, again and again
  std::vector<SweepSeries> series;  ///< of one point each
};

struct GrowthSettings {
  SweepSettings sweep;             ///< `counts`: the colliders that the given avatar is measured with
  std::uint32_t subdivisions = 4;  ///< the largest avatar has 4^subdivisions as many triangles
  std::uint32_t colliders = 100;   ///< that all sizes are measured with
};

struct Growth {
  std::vector<SweepSeries> by_colliders;
  std::vector<GrowthSize> by_triangles;
};

/// Where a frame has more pairs of collider and triangle, one may take seconds: then single frames at three places are
/// measured, whatever the settings say.
inline constexpr std::uint64_t kManyPairs = 500'000;

/// Makes the contestants for an avatar and its map, to which they keep references.
using ContestantMaker = std::function<std::vector<Contestant>(const Avatar&, const ActuatorMap&)>;

/// Cost against colliders on the avatar, then against triangles on its subdivisions. All contestants take turns within
/// one size, be it of colliders or triangles; sizes follow each other, since the largest fill the memory. `progress` as
/// for `run_sweep`.
Growth run_growth(TraceReader& trace, const Avatar& avatar, const ActuatorMap& map, const ContestantMaker& make,
                  const GrowthSettings& settings, const std::function<bool(double)>& progress);

/// Mean microseconds of a frame at each point; NaN where nothing was measured.
std::vector<double> mean_us(const SweepSeries& series);

/// Where one line crosses another: below `at` `cheaper_below` costs less, above it `cheaper_above` does.
struct Crossover {
  std::string cheaper_below;
  std::string cheaper_above;
  double at = 0;
};

/// One of the lines that are compared.
struct CostLine {
  std::string name;
  std::vector<double> us;  ///< at each of `sizes`, above 0, or NaN
};

/// Every crossing of two lines, straight between the `sizes` (ascending, above 0) on logarithmic axes.
std::vector<Crossover> crossovers(std::span<const double> sizes, std::span<const CostLine> lines);

/// What skipping saved, at one point that was measured with and without it: means over frames.
struct Ablation {
  std::string name;  ///< of the series with skipping
  std::uint32_t colliders = 0;
  std::uint64_t frames = 0;  ///< of one pass; the counts below are of the same
  std::uint64_t frames_skipped = 0;
  std::uint64_t meshlets_skinned = 0;
  std::uint64_t triangles = 0;  ///< that brute force tested
  std::uint64_t triangles_tested = 0;
  std::uint64_t pairs = 0;  ///< that brute force tested
  std::uint64_t pairs_tested = 0;
  std::uint64_t pairs_meeting = 0;  ///< of those, what no test could have saved
  double off_us = 0;                ///< a frame without skipping
  double on_us = 0;                 ///< a frame with it
  double saved_by_frames_us = 0;    ///< of off_us - on_us, what frames saved that were skipped altogether
  double saved_by_meshlets_us = 0;  ///< the rest: in frames that were not, meshlets and boxes left out
};

std::vector<Ablation> ablations(std::span<const SweepSeries> series);

}  // namespace vestige
