#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"

namespace vestige {

/// `series[…]` of a sweep's JSON (notes on the fields: the header of each struct). Medians and percentiles are of
/// single frames, in microseconds; hz is frames over total time, hz_low and hz_high its 95 % bootstrap interval.
/// times_paper and times_embree: hz over that of the fastest of theirs at the same count, where one was measured.
nlohmann::ordered_json to_json(std::span<const SweepSeries> series, std::uint64_t seed);

/// Every frame's duration as CSV: `detector,context,skip,renderer,colliders,repetition,frame,us`.
std::string frame_times_csv(std::span<const SweepSeries> series);

/// The table for people: frequency of every series at every count, with the paper's figures beside it; below, how many
/// times as fast each is as the fastest of `paper` and as the fastest of Embree, where they were measured without a
/// renderer, and how many frames of the scene were drawn meanwhile.
std::string sweep_table(std::span<const SweepSeries> series, std::uint64_t seed);

/// One sentence for each series whose repetitions scatter too much to be quoted, with cause and remedy.
std::vector<std::string> noise_warnings(std::span<const SweepSeries> series);

/// One sentence for each count at which detectors that promise the same bits gave different ones.
std::vector<std::string> disagreements(std::span<const SweepSeries> series);

/// "paper, egl-surfaceless", or "cpu, skip on".
std::string name_of(const SweepSeries& series);

}  // namespace vestige
