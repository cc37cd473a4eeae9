#include "analysis/frequency/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <string_view>

#include "analysis/base/provenance.hpp"
#include "analysis/frequency/render_thread.hpp"
#include "analysis/frequency/stage_report.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

constexpr double kNoisy = 0.05;
/// HAVE 2010, Fig. 2 and §IV: a GeForce GTX 285 under Windows 7.
struct PaperFigure {
  std::uint32_t colliders;
  std::string_view hz;
};
constexpr std::array<PaperFigure, 3> kPaper = {{{1, "> 5000"}, {40, "> 1000"}, {100, "> 500"}}};

std::string_view paper_figure(std::uint32_t colliders) {
  const auto found = std::ranges::find(kPaper, colliders, &PaperFigure::colliders);
  return found == kPaper.end() ? "" : found->hz;
}

/// What others are measured against: `paper` in any context, Embree in any mode.
struct Rival {
  std::string_view prefix;  ///< of the detector's name
  std::string_view title;
  const char* field;  ///< in JSON
};
constexpr std::array<Rival, 2> kRivals = {
    {{"paper", "the fastest paper", "times_paper"}, {"embree", "the fastest Embree", "times_embree"}}};

/// Returns the highest frequency of a rival of this series at the p-th count, or 0 if none was measured.
double fastest_hz(std::span<const SweepSeries> series, const Rival& rival, const SweepSeries& of, std::size_t p) {
  double fastest = 0;
  for (const SweepSeries& one : series)
    if (one.detector.starts_with(rival.prefix) && one.same_crowd(of) && !one.renderer &&
        !one.points[p].repetitions.empty())
      fastest = std::max(fastest, one.points[p].hz());
  return fastest;
}

Interval interval_of(const SweepPoint& point, std::uint64_t seed) {
  return bootstrap_frequency_hz(point.repetitions, point.places, seed);
}

double noise_of(const SweepPoint& point) {
  return relative_noise(point.repetitions, point.places);
}

/// Of more passes than these, the file of durations holds as many, evenly spread: enough to compare runs by.
constexpr std::size_t kMostStoredPasses = 100;

/// Returns the repetitions whose durations are stored: those of whole passes.
std::vector<std::size_t> stored_repetitions(const SweepPoint& point) {
  const std::size_t passes = point.repetitions.size() / point.places;
  const std::size_t stored_passes = std::min(passes, kMostStoredPasses);
  std::vector<std::size_t> stored;
  stored.reserve(stored_passes * point.places);
  for (std::size_t k = 0; k < stored_passes; ++k)
    for (std::size_t place = 0; place < point.places; ++place)
      stored.push_back(k * passes / stored_passes * point.places + place);
  return stored;
}

std::uint64_t stored_frames(const SweepPoint& point) {
  std::uint64_t frames = 0;
  for (const std::size_t repetition : stored_repetitions(point)) frames += point.repetitions[repetition].frames;
  return frames;
}

const char* around(const SweepSeries& series) {
  return series.first_only ? "first" : "all";
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}

nlohmann::ordered_json to_json(const FrameContacts& contacts) {
  return {{"empty_share", contacts.empty_share}, {"contacts_per_frame", contacts.contacts_per_frame}};
}

nlohmann::ordered_json to_json(const SweepPoint& point, std::uint64_t seed) {
  const Interval interval = interval_of(point, seed);
  const auto us = [&](double p) { return quantile(point.frame_us, p); };
  return {{"colliders", point.colliders},
          {"frames", point.frame_us.size()},
          {"stored_frames", stored_frames(point)},
          {"pass_frames", point.pass_frames},
          {"frames_skipped", point.work.frames_skipped},
          {"hz", point.hz()},
          {"hz_low", number_or_null(interval.low)},
          {"hz_high", number_or_null(interval.high)},
          {"cold_hz", number_or_null(point.cold_hz())},
          {"hz_median", 1e6 / us(0.5)},
          {"us_median", us(0.5)},
          {"us_p95", us(0.95)},
          {"us_p99", us(0.99)},
          {"us_max", us(1)},
          {"noise", noise_of(point)},
          {"repetitions", point.repetitions.size()},
          {"empty_share", static_cast<double>(point.empty_frames) / static_cast<double>(point.pass_frames)},
          {"contacts", point.contacts},
          {"pairs_tested", point.work.pairs_tested},
          {"pairs_meeting", point.work.pairs_meeting},
          {"triangles_tested", point.work.triangles_tested},
          {"meshlets_skinned", point.work.meshlets_skinned},
          {"part_pairs", point.work.part_pairs},
          {"pairs_spared", point.work.pairs_spared},
          {"texture_hash", point.texture_hash},
          {"disagreements", point.disagreements}};
}

/// A frequency as tables show it.
std::string with_interval(double hz, const Interval& interval) {
  std::string text = fmt::format("{:.0f}", hz);
  if (std::isfinite(interval.low)) text += fmt::format(" ({:.0f} to {:.0f})", interval.low, interval.high);
  return text;
}

/// The width of the columns of a table whose heads are the names of these series, in characters.
std::size_t column_width(std::span<const SweepSeries> series) {
  std::size_t width = 34;
  for (const SweepSeries& one : series) width = std::max(width, name_of(one).size());
  return width;
}

/// Returns a table with one row for each count, and one column for each series that `has_column`. `cell` is what stands
/// in it, empty where nothing was measured. Returns an empty text without columns.
std::string table_of(std::span<const SweepSeries> series, const std::string& title,
                     const std::function<bool(const SweepSeries&)>& has_column,
                     const std::function<std::string(const SweepSeries&, std::size_t)>& cell) {
  if (std::ranges::none_of(series, has_column)) return "";
  const std::size_t width = column_width(series);
  std::string table = fmt::format("\n{}:\n{:>9}", title, "colliders");
  for (const SweepSeries& one : series)
    if (has_column(one)) fmt::format_to(std::back_inserter(table), "  {:>{}}", name_of(one), width);
  for (std::size_t p = 0; p < series.front().points.size(); ++p) {
    fmt::format_to(std::back_inserter(table), "\n{:>9}", series.front().points[p].colliders);
    for (const SweepSeries& one : series) {
      if (!has_column(one)) continue;
      const std::string text = one.points[p].repetitions.empty() ? "" : cell(one, p);
      fmt::format_to(std::back_inserter(table), "  {:>{}}", text.empty() ? "-" : text, width);
    }
  }
  return table + "\n";
}

/// Returns the table of ratios to a rival. Empty if the rival, or everything else, was not measured.
std::string ratio_table(std::span<const SweepSeries> series, const Rival& rival) {
  const auto is_rival = [&](const SweepSeries& one) { return one.detector.starts_with(rival.prefix); };
  if (std::ranges::none_of(series, is_rival)) return "";
  return table_of(series, fmt::format("Times as fast as {}", rival.title), std::not_fn(is_rival),
                  [&](const SweepSeries& one, std::size_t p) {
                    const double rival_hz = fastest_hz(series, rival, one, p);
                    return rival_hz > 0 ? fmt::format("{:.2f}", one.points[p].hz() / rival_hz) : "";
                  });
}

std::string cold_table(std::span<const SweepSeries> series) {
  return table_of(
      series, "Hz of the first pass, with cold caches", [](const SweepSeries&) { return true; },
      [](const SweepSeries& one, std::size_t p) { return fmt::format("{:.0f}", one.points[p].cold_hz()); });
}

/// Empty where nothing was drawn.
std::string rendered_table(std::span<const SweepSeries> series) {
  return table_of(
      series, fmt::format("Frames of the scene drawn meanwhile, Hz ({:.0f} asked for)", RenderThread::kRate_hz),
      [](const SweepSeries& one) { return one.renderer.has_value(); },
      [](const SweepSeries& one, std::size_t p) {
        return one.points[p].rendered_s > 0 ? fmt::format("{:.1f}", one.points[p].rendered_hz()) : "";
      });
}

/// Whether two series differ in nothing but their planes.
bool differ_in_planes(const SweepSeries& a, const SweepSeries& b) {
  return a.detector == b.detector && a.gl.context == b.gl.context && a.skip == b.skip && a.method == b.method &&
         a.renderer.has_value() == b.renderer.has_value() && a.same_crowd(b) && a.planes.count() != b.planes.count();
}

/// Says what planes cost beyond those of the series with the fewest. Empty unless a detector was measured with several
/// numbers of planes.
std::string planes_table(std::span<const SweepSeries> series) {
  const auto with_fewest = [&](const SweepSeries& one) {
    const SweepSeries* fewest = &one;
    for (const SweepSeries& other : series)
      if (differ_in_planes(one, other) && other.planes.count() < fewest->planes.count()) fewest = &other;
    return fewest;
  };
  return table_of(
      series, "What each further plane (render target) costs, µs a frame",
      [&](const SweepSeries& one) { return with_fewest(one) != &one; },
      [&](const SweepSeries& one, std::size_t p) -> std::string {
        const SweepSeries& fewest = *with_fewest(one);
        if (fewest.points[p].repetitions.empty()) return "";
        const auto further = static_cast<double>(one.planes.count() - fewest.planes.count());
        return fmt::format("{:+.1f}", (1e6 / one.points[p].hz() - 1e6 / fewest.points[p].hz()) / further);
      });
}

/// Per cent with one digit, rounded down: what is not all never reads 100.
double percent_floor(double share) {
  return std::floor(1000 * share) / 10;
}

/// Says how often the frames of each count have contacts, once for all series that agree with the first.
std::string contacts_table(std::span<const SweepSeries> series) {
  const auto tells_more = [&](const SweepSeries& one) {
    return &one == &series.front() ||
           !std::ranges::equal(one.points, series.front().points, {}, &SweepPoint::contacts, &SweepPoint::contacts);
  };
  return table_of(series, "Contacts in one pass, and share of its frames without any (those left out: as the first)",
                  tells_more, [](const SweepSeries& one, std::size_t p) {
                    const SweepPoint& point = one.points[p];
                    const double empty =
                        static_cast<double>(point.empty_frames) / static_cast<double>(point.pass_frames);
                    return fmt::format("{} ({:.1f} %)", point.contacts, percent_floor(empty));
                  });
}

/// Says how much of a frame was known from the frame before. Empty unless a detector remembers.
std::string spared_table(std::span<const SweepSeries> series) {
  const auto remembers = [](const SweepSeries& one) {
    return std::ranges::any_of(one.points, [](const SweepPoint& point) { return point.work.pairs_spared > 0; });
  };
  return table_of(series,
                  "Share of the pairs of collider and part of the skin that needed no look, as an earlier frame had "
                  "proven them apart",
                  remembers, [](const SweepSeries& one, std::size_t p) {
                    const DetectorWork& work = one.points[p].work;
                    if (work.part_pairs == 0) return std::string();
                    return fmt::format("{:.1f} %", percent_floor(static_cast<double>(work.pairs_spared) /
                                                                 static_cast<double>(work.part_pairs)));
                  });
}

}  // namespace

std::string detector_name(const SweepSeries& series) {
  std::string name = series.detector;
  if (series.approximate)
    name +=
        series.triangles_kept ? fmt::format(" (approximate, {} triangles)", *series.triangles_kept) : " (approximate)";
  if (!series.gl.context.empty()) name += ", " + series.gl.context;
  if (series.planes.count() > 1) name += fmt::format(", {} planes", series.planes.count());
  if (series.skip == Skip::kOn) name += ", skip on";
  if (series.renderer) name += ", rendering";
  return name;
}

std::string name_of(const SweepSeries& series) {
  std::string name = detector_name(series);
  if (series.people > 1) name += fmt::format(", {} people", series.people);
  if (series.first_only) name += ", colliders around the first";
  return name;
}

nlohmann::ordered_json to_json(std::span<const SweepSeries> series, std::uint64_t seed) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SweepSeries& one : series) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (std::size_t p = 0; p < one.points.size(); ++p) {
      if (one.points[p].repetitions.empty()) continue;
      nlohmann::ordered_json point = to_json(one.points[p], seed);
      for (const Rival& rival : kRivals)
        if (const double rival_hz = fastest_hz(series, rival, one, p); rival_hz > 0)
          point[rival.field] = one.points[p].hz() / rival_hz;
      if (one.renderer) point["rendered_hz"] = one.points[p].rendered_hz();
      if (!one.points[p].spanned.empty()) {
        const Interval interval = bootstrap_frequency_hz(one.points[p].spanned, one.points[p].places, seed);
        point["throughput_hz"] = one.points[p].throughput_hz();
        point["throughput_hz_low"] = number_or_null(interval.low);
        point["throughput_hz_high"] = number_or_null(interval.high);
        point["in_flight"] = one.points[p].in_flight;
      }
      if (one.points[p].memory_bytes) point["memory_bytes"] = *one.points[p].memory_bytes;
      point.update(to_json(one.points[p].stages));
      points.push_back(std::move(point));
    }
    list.push_back({{"detector", one.detector},
                    {"approximate", one.approximate},
                    {"context", one.gl.context},
                    {"skip", one.skip == Skip::kOn ? "on" : "off"},
                    {"triangles_kept", one.triangles_kept ? nlohmann::ordered_json(*one.triangles_kept) : nullptr},
                    {"method", name_of(one.method)},
                    {"planes", one.planes.count()},
                    {"renderer", one.renderer ? "on" : "off"},
                    {"renderer_gl", one.renderer ? to_json(*one.renderer) : nullptr},
                    {"avatars", one.people},
                    {"colliders_around", around(one)},
                    {"gl", to_json(one.gl)},
                    {"points", points}});
  }
  return list;
}

nlohmann::ordered_json sample_json(const Sweep& sweep) {
  return {{"places", sweep.places},
          {"sha256", sweep.sample_sha256},
          {"sampled", to_json(sweep.sampled)},
          {"trace", to_json(sweep.trace)}};
}

std::string sample_sentence(const Sweep& sweep) {
  return fmt::format(
      "\nMeasured at {} of {}{}. With all colliders, {:.1f} % of these frames have no contact, and {:.1f} % of the "
      "trace's; a frame has {:.3g} contacts, and {:.3g} in the whole trace.\n",
      counted(sweep.places, "place"), counted(sweep.place_frames, "frame"),
      sweep.places > 1 ? ", with other colliders drawn for each" : "", percent_floor(sweep.sampled.empty_share),
      percent_floor(sweep.trace.empty_share), sweep.sampled.contacts_per_frame, sweep.trace.contacts_per_frame);
}

std::string frame_times_csv(std::span<const SweepSeries> series) {
  std::string csv = "detector,context,skip,planes,renderer,avatars,colliders_around,colliders,repetition,frame,us\n";
  for (const SweepSeries& one : series)
    for (const SweepPoint& point : one.points) {
      std::vector<std::size_t> first_frame = {0};  // of each repetition
      first_frame.reserve(point.repetitions.size() + 1);
      for (const Repetition& repetition : point.repetitions)
        first_frame.push_back(first_frame.back() + repetition.frames);
      for (const std::size_t r : stored_repetitions(point))
        for (std::size_t frame = first_frame[r]; frame < first_frame[r + 1]; ++frame)
          fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{},{},{},{:.2f}\n", one.detector,
                         one.gl.context, one.skip == Skip::kOn ? "on" : "off", one.planes.count(),
                         one.renderer ? "on" : "off", one.people, around(one), point.colliders, r,
                         frame - first_frame[r], point.frame_us[frame]);
    }
  return csv;
}

std::string sweep_table(std::span<const SweepSeries> series, std::uint64_t seed) {
  const std::size_t width = column_width(series);
  std::string table = fmt::format("{:>9}", "colliders");
  for (const SweepSeries& one : series) fmt::format_to(std::back_inserter(table), "  {:>{}}", name_of(one), width);
  table += "   HAVE 2010, GTX 285\n";
  if (series.empty()) return table;
  for (std::size_t p = 0; p < series.front().points.size(); ++p) {
    fmt::format_to(std::back_inserter(table), "{:>9}", series.front().points[p].colliders);
    for (const SweepSeries& one : series) {
      const SweepPoint& point = one.points[p];
      const std::string cell = point.repetitions.empty() ? "-" : with_interval(point.hz(), interval_of(point, seed));
      fmt::format_to(std::back_inserter(table), "  {:>{}}", cell, width);
    }
    const std::string_view paper = paper_figure(series.front().points[p].colliders);
    fmt::format_to(std::back_inserter(table), "   {}\n", paper);
  }
  table += "Hz: frames / total time, whole round trip (95 % bootstrap interval).\n";
  table += throughput_table(series, seed);
  table += cold_table(series);
  table += contacts_table(series);
  table += spared_table(series);
  for (const Rival& rival : kRivals) table += ratio_table(series, rival);
  table += planes_table(series);
  table += rendered_table(series);
  table += stage_table(series);
  table += disagreement_lines(series);
  return table;
}

std::string throughput_table(std::span<const SweepSeries> series, std::uint64_t seed) {
  const auto has_throughput = [](const SweepSeries& one) {
    return std::ranges::any_of(one.points, [](const SweepPoint& point) { return !point.spanned.empty(); });
  };
  const auto measured = std::ranges::find_if(series, has_throughput);
  if (measured == series.end()) return "";
  const std::string title =
      fmt::format("Throughput: Hz of frames that detectors are given {} at a time (95 % bootstrap interval)",
                  measured->points.front().in_flight);
  return table_of(series, title, has_throughput, [&](const SweepSeries& one, std::size_t p) -> std::string {
    const SweepPoint& point = one.points[p];
    if (point.spanned.empty()) return "";
    return with_interval(point.throughput_hz(), bootstrap_frequency_hz(point.spanned, point.places, seed));
  });
}

std::string disagreement_lines(std::span<const SweepSeries> series) {
  std::string lines;
  for (const SweepSeries& one : series)
    for (const SweepPoint& point : one.points)
      if (point.disagreements != 0)
        fmt::format_to(std::back_inserter(lines),
                       "{} with {} collider{}: {} of {} results differ from its own with other planes and the most "
                       "colliders.\n",
                       name_of(one), point.colliders, point.colliders == 1 ? "" : "s", point.disagreements,
                       point.results);
  return lines.empty() ? "" : "\n" + lines;
}

std::vector<std::string> disagreements(std::span<const SweepSeries> series) {
  std::vector<std::string> found;
  for (const SweepSeries& one : series) {
    if (!promises_same_bits(one.detector)) continue;
    for (std::size_t p = 0; p < one.points.size(); ++p) {
      const std::string& hash = one.points[p].texture_hash;
      // Empty: the run was stopped before the hash was computed, or the point was left out.
      if (hash.empty()) continue;
      const auto first = std::ranges::find_if(series, [&](const SweepSeries& other) {
        return promises_same_bits(other.detector) && other.same_crowd(one) && !other.points[p].texture_hash.empty();
      });
      if (hash != first->points[p].texture_hash)
        found.push_back(
            fmt::format("with {} colliders, '{}' and '{}' gave different contacts, but both must give the same",
                        one.points[p].colliders, name_of(*first), name_of(one)));
    }
  }
  return found;
}

std::vector<std::string> noise_warnings(std::span<const SweepSeries> series) {
  std::vector<std::string> warnings;
  for (const SweepSeries& one : series) {
    std::size_t noisy = 0;
    double worst = 0;
    for (const SweepPoint& point : one.points) {
      const double noise = noise_of(point);
      if (noise > kNoisy) ++noisy;
      worst = std::max(worst, noise);
    }
    if (noisy == 0) continue;
    warnings.push_back(fmt::format(
        "{}: at {} of {} counts the repetitions scatter by more than {:.0f} % (worst {:.1f} %). Other programs were "
        "probably running: close them, or raise --min-time.",
        name_of(one), noisy, one.points.size(), 100 * kNoisy, 100 * worst));
  }
  return warnings;
}

}  // namespace vestige
