#include "analysis/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "analysis/provenance.hpp"

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

nlohmann::ordered_json to_json(const SweepPoint& point, std::uint64_t seed) {
  const Interval interval = bootstrap_frequency_hz(point.repetitions, seed);
  const auto us = [&](double p) { return quantile(point.frame_us, p); };
  return {{"colliders", point.colliders},
          {"frames", point.frame_us.size()},
          {"frames_skipped", point.frames_skipped},
          {"hz", point.hz()},
          {"hz_low", interval.low},
          {"hz_high", interval.high},
          {"hz_median", 1e6 / us(0.5)},
          {"us_median", us(0.5)},
          {"us_p95", us(0.95)},
          {"us_p99", us(0.99)},
          {"us_max", us(1)},
          {"noise", relative_noise(point.repetitions)},
          {"repetitions", point.repetitions.size()},
          {"contacts", point.contacts},
          {"pairs_tested", point.pairs_tested},
          {"triangles_tested", point.triangles_tested},
          {"meshlets_skinned", point.meshlets_skinned},
          {"texture_hash", point.texture_hash}};
}

}  // namespace

std::string name_of(const SweepSeries& series) {
  return series.gl.context.empty() ? series.detector : fmt::format("{}, {}", series.detector, series.gl.context);
}

nlohmann::ordered_json to_json(std::span<const SweepSeries> series, std::uint64_t seed) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SweepSeries& one : series) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const SweepPoint& point : one.points)
      if (!point.repetitions.empty()) points.push_back(to_json(point, seed));
    list.push_back({{"detector", one.detector},
                    {"context", one.gl.context},
                    {"skip", "off"},
                    {"method", "static"},
                    {"gl", to_json(one.gl)},
                    {"points", points}});
  }
  return list;
}

std::string frame_times_csv(std::span<const SweepSeries> series) {
  std::string csv = "detector,context,colliders,repetition,frame,us\n";
  for (const SweepSeries& one : series)
    for (const SweepPoint& point : one.points) {
      std::size_t frame = 0;
      for (std::size_t r = 0; r < point.repetitions.size(); ++r)
        for (std::uint64_t i = 0; i < point.repetitions[r].frames; ++i)
          fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{:.2f}\n", one.detector, one.gl.context,
                         point.colliders, r, i, point.frame_us[frame++]);
    }
  return csv;
}

std::string sweep_table(std::span<const SweepSeries> series, std::uint64_t seed) {
  std::string table = fmt::format("{:>9}", "colliders");
  for (const SweepSeries& one : series) fmt::format_to(std::back_inserter(table), "  {:>28}", name_of(one));
  table += "   HAVE 2010, GTX 285\n";
  if (series.empty()) return table;
  for (std::size_t p = 0; p < series.front().points.size(); ++p) {
    fmt::format_to(std::back_inserter(table), "{:>9}", series.front().points[p].colliders);
    for (const SweepSeries& one : series) {
      const SweepPoint& point = one.points[p];
      const Interval interval = bootstrap_frequency_hz(point.repetitions, seed);
      const std::string cell = fmt::format("{:.0f} ({:.0f} to {:.0f})", point.hz(), interval.low, interval.high);
      fmt::format_to(std::back_inserter(table), "  {:>28}", point.repetitions.empty() ? "-" : cell);
    }
    const std::string_view paper = paper_figure(series.front().points[p].colliders);
    fmt::format_to(std::back_inserter(table), "   {}\n", paper);
  }
  return table + "Hz: frames / total time, whole round trip (95 % bootstrap interval).\n";
}

std::vector<std::string> noise_warnings(std::span<const SweepSeries> series) {
  std::vector<std::string> warnings;
  for (const SweepSeries& one : series) {
    std::size_t noisy = 0;
    double worst = 0;
    for (const SweepPoint& point : one.points) {
      const double noise = relative_noise(point.repetitions);
      if (noise > kNoisy) ++noisy;
      worst = std::max(worst, noise);
    }
    if (noisy == 0) continue;
    warnings.push_back(fmt::format(
        "{}: at {} of {} counts the repetitions scatter by more than {:.0f} % (worst {:.0f} %). Other programs were "
        "probably running: close them, or raise --min-time.",
        name_of(one), noisy, one.points.size(), 100 * kNoisy, 100 * worst));
  }
  return warnings;
}

}  // namespace vestige
