#include "analysis/scoring/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/base/statistics.hpp"
#include "analysis/scoring/balance.hpp"
#include "analysis/scoring/law_tally.hpp"
#include "detector/actuators/portable_math.hpp"

namespace vestige {

namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMilliseconds = 1e3;
constexpr double kLn2 = 0x1.62e42fefa39efp-1;

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : kMissing;
}

double root_mean(double sum_of_squares, std::uint64_t count) {
  return std::sqrt(ratio(sum_of_squares, static_cast<double>(count)));
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

double actuators_of(const LawTally& all) {
  return static_cast<double>(all.layout->actuator_count());
}

double share_felt(const LawTally& all) {
  return ratio(static_cast<double>(all.felt), static_cast<double>(all.contacts));
}

double error_with_unfelt_m(const LawTally& all) {
  if (!all.unfelt_m) return kMissing;
  const auto unfelt = static_cast<double>(all.contacts - all.felt);
  return root_mean(all.squared_error_m2 + unfelt * *all.unfelt_m * *all.unfelt_m, all.contacts);
}

double area_ratio(const ActuatorLayout& layout) {
  double least_m2 = std::numeric_limits<double>::infinity();
  double most_m2 = 0;
  for (std::size_t i = 0; i < layout.actuator_count(); ++i) {
    least_m2 = std::min(least_m2, layout.area_m2(i));
    most_m2 = std::max(most_m2, layout.area_m2(i));
  }
  return ratio(most_m2, least_m2);
}

/// In the order of listing, which is that of the columns in files.
constexpr Metric kMetrics[] = {
    {.name = "coverage",
     .unit = "",
     .better = Better::kHigher,
     .model_based = false,
     .shown = Shown::kBesideTheRank,
     .formula = "contacts that are felt / contacts; felt: an actuator vibrates for it, strongly enough if the motors "
                "have a threshold",
     .source = "Vestige",
     .value = [](const LawTally& all) { return share_felt(all); }},
    {.name = "mapped_area_m2",
     .unit = "m²",
     .better = Better::kNeither,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "area of the skin that fires anything, body at rest",
     .source = "Vestige",
     .value = [](const LawTally& all) { return all.layout->mapped_area_m2(); }},
    {.name = "mapped_share",
     .unit = "",
     .better = Better::kNeither,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "mapped area / area of the whole skin",
     .source = "Vestige",
     .value = [](const LawTally& all) { return ratio(all.layout->mapped_area_m2(), all.layout->skin_area_m2()); }},
    {.name = "area_ratio",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "largest / smallest area of an actuator",
     .source = "Vestige",
     .value = [](const LawTally& all) { return area_ratio(*all.layout); }},
    {.name = "localisation_error_mm",
     .unit = "mm",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kBesideTheRank,
     .formula =
         "sqrt(mean |Σ A_i v_i / Σ A_i|²) over contacts that are felt; v_i: path along the body from the contact to "
         "actuator i. Where the map's \"fires\" lets a region drive others, A_i is felt at the place that is meant",
     .source = "amplitude centroid",
     .value = [](const LawTally& all) { return root_mean(all.squared_error_m2, all.felt) * kMillimetres; }},
    {.name = "common_error_mm",
     .unit = "mm",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kBesideTheRank,
     .formula = "localisation_error_mm over the contacts that every compared map and law lets feel",
     .source = "Vestige",
     .value = [](const LawTally& all) { return root_mean(all.squared_common_error_m2, all.common) * kMillimetres; }},
    {.name = "error_with_unfelt_mm",
     .unit = "mm",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "localisation_error_mm over all contacts; one that is not felt counts as --unfelt-mm",
     .source = "Vestige",
     .value = [](const LawTally& all) { return error_with_unfelt_m(all) * kMillimetres; }},
    {.name = "localisation_error_acuities",
     .unit = "",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula =
         "localisation_error_mm with each contact's error in units of the torso's acuity: 25 mm, at the midline 10 mm",
     .source = "van Erp 2005",
     .value = [](const LawTally& all) { return root_mean(all.squared_acuities, all.felt); }},
    {.name = "energy_localisation_error_mm",
     .unit = "mm",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula =
         "sqrt(mean |Σ A_i² v_i / Σ A_i²|²): phantom assumes this formula, so for phantom it is 0 between actuators on "
         "flat skin",
     .source = "Israr & Poupyrev 2011",
     .value = [](const LawTally& all) { return root_mean(all.squared_energy_error_m2, all.felt) * kMillimetres; }},
    {.name = "slide_ripple",
     .unit = "",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "(max - min) / mean of Σ A_i² along a slide, mean over felt slides",
     .source = "Israr & Poupyrev 2011",
     .value = [](const LawTally& all) { return all.slides.ripple(); }},
    {.name = "slide_jump_mm",
     .unit = "mm",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "largest step of Σ A_i x_i / Σ A_i between a slide's contacts, mean over felt slides",
     .source = "amplitude centroid",
     .value = [](const LawTally& all) { return all.slides.largest_jump_m() * kMillimetres; }},
    {.name = "slide_reversals_per_m",
     .unit = "1/m",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "steps of Σ A_i x_i / Σ A_i against the collider's, per metre of felt slide",
     .source = "amplitude centroid",
     .value = [](const LawTally& all) { return all.slides.reversals_per_m(); }},
    {.name = "timing_f1",
     .unit = "",
     .better = Better::kHigher,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "2 TP / (2 TP + FP + FN) over frames and actuators: actuators that vibrate, against those that a "
                "contact of the "
                "frame asks for",
     .source = "Mesaros et al. 2016",
     .value = [](const LawTally& all) { return all.timing.f1(); }},
    {.name = "onset_error_ms",
     .unit = "ms",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "mean time from a contact's instant to its actuator's vibration",
     .source = "Vestige",
     .value = [](const LawTally& all) { return all.timing.mean_onset_s() * kMilliseconds; }},
    {.name = "offset_error_ms",
     .unit = "ms",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "mean time from the last contact's instant to the vibration's end",
     .source = "Vestige",
     .value = [](const LawTally& all) { return all.timing.mean_offset_s() * kMilliseconds; }},
    {.name = "onset_over_15ms",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "share of onsets later than 15 ms",
     .source = "Di Luca & Mahnan 2019",
     .value = [](const LawTally& all) { return all.timing.late_share(0); }},
    {.name = "onset_over_45ms",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "share of onsets later than 45 ms",
     .source = "Vogels 2004",
     .value = [](const LawTally& all) { return all.timing.late_share(1); }},
    {.name = "onset_over_50ms",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "share of onsets later than 50 ms",
     .source = "Di Luca & Mahnan 2019",
     .value = [](const LawTally& all) { return all.timing.late_share(2); }},
    {.name = "information_bits",
     .unit = "bit",
     .better = Better::kHigher,
     .model_based = true,
     .shown = Shown::kBesideTheRank,
     .formula = "Σ p_ij log2(p_ij / (p_i p_j)): regions of contact, against those that a noisy observer names",
     .source = "Tan et al. 2010",
     .value = [](const LawTally& all) { return all.information_bits; }},
    {.name = "information_categories",
     .unit = "",
     .better = Better::kHigher,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "2^information_bits: regions told apart without error",
     .source = "Tan et al. 2010",
     .value = [](const LawTally& all) { return portable_exp(all.information_bits * kLn2); }},
    {.name = "use_evenness",
     .unit = "",
     .better = Better::kHigher,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "-Σ p_i log2 p_i / log2 n, p_i: actuator i's share of all duty",
     .source = "Shannon 1948; Pielou 1966",
     .value = [](const LawTally& all) { return use_evenness(all.use); }},
    {.name = "mean_duty",
     .unit = "",
     .better = Better::kNeither,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "mean of the duties 0 … 1 over frames and actuators",
     .source = "Vestige",
     .value =
         [](const LawTally& all) {
           return ratio(sum_of(all.use), actuators_of(all) * static_cast<double>(all.frames));
         }},
    {.name = "peak_duty",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "the largest frame's mean of the duties 0 … 1 over actuators",
     .source = "Vestige",
     .value = [](const LawTally& all) { return ratio(all.peak, actuators_of(all)); }},
    {.name = "switches_hz",
     .unit = "Hz",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "times that an actuator begins to vibrate, per second and actuator",
     .source = "Vestige",
     .value =
         [](const LawTally& all) {
           return ratio(static_cast<double>(all.switches), actuators_of(all) * all.duration_s);
         }},
    {.name = "ambiguous_share",
     .unit = "",
     .better = Better::kLower,
     .model_based = false,
     .shown = Shown::kInFiles,
     .formula = "mapped skin that shares its texels with skin more than 50 mm away / mapped skin",
     .source = "Vestige",
     .value = [](const LawTally& all) { return all.layout->ambiguous_share(); }},
    {.name = "superseded",
     .unit = "",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "changed states that a newer state replaced before the line was free / all changed states",
     .source = "Vestige",
     .value =
         [](const LawTally& all) {
           return ratio(static_cast<double>(all.link.superseded()), static_cast<double>(all.link.changes()));
         }},
    {.name = "line_load",
     .unit = "",
     .better = Better::kLower,
     .model_based = true,
     .shown = Shown::kInFiles,
     .formula = "bytes sent / bytes that the line can carry in that time",
     .source = "Vestige",
     .value = [](const LawTally& all) { return ratio(all.link.bytes_sent(), all.line_bytes_per_s * all.duration_s); }},
};

}  // namespace

std::span<const Metric> metrics() {
  return kMetrics;
}

}  // namespace vestige
