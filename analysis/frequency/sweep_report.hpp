#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"

namespace vestige {

/// Returns `series[…]` of a sweep's JSON (for the fields, see the comments of each struct). Medians and percentiles are
/// of single frames, in microseconds. hz is frames over total time of all passes but the first; hz_low and hz_high are
/// its 95 % bootstrap interval, null where passes are too few or scatter too much. cold_hz is that of the first pass.
/// throughput_hz, with its interval, is that of spans of in_flight frames, where it was measured.
/// empty_share is the share of frames without a contact. times_paper and times_embree are hz over the hz of the fastest
/// `paper` or Embree detector at the same count, where one was measured.
nlohmann::ordered_json to_json(std::span<const SweepSeries> series, std::uint64_t seed);

/// Returns the durations of frames as CSV:
/// `detector,context,skip,planes,renderer,avatars,colliders_around,colliders,repetition,frame,us`. Of each point, these
/// are at most 100 whole passes, evenly spread over its repetitions; stored_frames is their number.
std::string frame_times_csv(std::span<const SweepSeries> series);

/// Returns a table for people: the frequency of every series at every count, beside the paper's figures. Below, the
/// table says the throughput, where it was measured, how often the measured frames have contacts, how fast the first
/// pass was, how many times as fast each series is as the fastest `paper` and the fastest Embree detector, where they
/// were measured without a renderer, and what further planes cost. It also says how many frames of the scene were
/// drawn, and which points disagreed with their reference.
std::string sweep_table(std::span<const SweepSeries> series, std::uint64_t seed);

/// Returns the part of that table with the throughput. Empty unless it was measured.
std::string throughput_table(std::span<const SweepSeries> series, std::uint64_t seed);

/// Returns, as JSON, how often the measured frames have contacts, and all frames of the trace.
nlohmann::ordered_json sample_json(const Sweep& sweep);
/// Says the same in a sentence.
std::string sample_sentence(const Sweep& sweep);

/// Returns one sentence, with cause and remedy, for each series whose repetitions scatter too much to be quoted.
std::vector<std::string> noise_warnings(std::span<const SweepSeries> series);

/// Returns one line for each point whose contacts were not those of its reference, though its detector promises none.
std::string disagreement_lines(std::span<const SweepSeries> series);

/// Returns one sentence for each count at which detectors that promise the same bits gave different bits.
std::vector<std::string> disagreements(std::span<const SweepSeries> series);

/// Returns the name of a series' detector, for example "paper, egl-surfaceless" or "cpu, skip on".
std::string detector_name(const SweepSeries& series);

/// Returns the name of a series: the detector's, and on whom it was measured if that was not one person.
std::string name_of(const SweepSeries& series);

}  // namespace vestige
