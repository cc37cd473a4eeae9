#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "analysis/claims/claims.hpp"
#include "analysis/claims/wording.hpp"

namespace vestige {

namespace {

/// The counts at which the paper quotes its own figures (HAVE 2010 §IV).
const std::set<int> kQuotedCounts = {1, 40, 100};

/// One curve of a sweep.
struct Curve {
  std::string who;  ///< detector and renderer
  bool skips = false;
  std::string beside;             ///< " beside a renderer…", or "" if it ran alone
  std::map<int, std::string> hz;  ///< by count of colliders, with interval
};

int people_of(const nlohmann::json& series) {
  return series.value("avatars", 1);
}

Curve curve_of(const nlohmann::json& series, ContextName context) {
  Curve curve;
  curve.who = fmt::format("`{}`{}{}", series.at("detector").get<std::string>(), approximate_words(series),
                          on_renderer(series.at("gl"), context));
  if (const auto planes = series.value("planes", 1); planes > 1) curve.who += fmt::format(" with {} planes", planes);
  if (const int people = people_of(series); people > 1) curve.who += fmt::format(" on {} people", people);
  if (series.value("colliders_around", "all") == "first") curve.who += " of whom only the first has colliders";
  curve.skips = series.value("skip", "off") == "on";
  if (series.value("renderer", "off") == "on")
    curve.beside = " beside a renderer" + on_renderer(series.value("renderer_gl", nlohmann::json()));
  for (const auto& point : series.at("points")) {
    std::string& text = curve.hz[point.at("colliders").get<int>()];
    text = fmt::format("{:.0f} Hz", point.at("hz").get<double>());
    if (!point.at("hz_low").is_null())
      text += fmt::format(" ({:.0f} to {:.0f})", point["hz_low"].get<double>(), point.at("hz_high").get<double>());
  }
  return curve;
}

/// Returns the paper's counts among those measured, or the largest of those measured.
std::set<int> quoted_counts(const std::vector<std::vector<Curve>>& detectors) {
  std::set<int> quoted;
  int largest = 0;
  for (const auto& curves : detectors)
    for (const Curve& curve : curves)
      for (const auto& [count, hz] : curve.hz) {
        if (kQuotedCounts.contains(count)) quoted.insert(count);
        largest = std::max(largest, count);
      }
  return quoted.empty() ? std::set<int>{largest} : quoted;
}

std::string colliders(int count) {
  return fmt::format("{} collider{}", count, count == 1 ? "" : "s");
}

/// Returns the curve at each count: "… Hz with 1 collider, … Hz with 40". Returns "" if none was measured.
std::string along(const Curve& curve, const std::set<int>& counts) {
  std::vector<std::string> figures;
  for (const int count : counts)
    if (curve.hz.contains(count))
      figures.push_back(
          fmt::format("{} with {}", curve.hz.at(count), figures.empty() ? colliders(count) : std::to_string(count)));
  if (figures.empty()) return "";
  return fmt::format("{}{}: {}", curve.who, curve.skips ? " with skipping" : "", fmt::join(figures, ", "));
}

/// Returns what the curves of one detector say at one count: "… Hz with skipping, … Hz without". Returns
/// "" if none was measured.
std::string compared(const std::vector<Curve>& curves, int count) {
  const auto differ = [&curves](auto field) {
    return std::ranges::any_of(curves, [&](const Curve& curve) { return curve.*field != curves[0].*field; });
  };
  const bool by_skipping = differ(&Curve::skips);
  const bool by_renderer = differ(&Curve::beside);
  std::vector<std::string> figures;
  for (const Curve& curve : curves) {
    if (!curve.hz.contains(count)) continue;
    std::string figure = curve.hz.at(count);
    if (by_skipping) figure += curve.skips ? " with skipping" : " without skipping";
    if (by_renderer) figure += curve.beside.empty() ? " alone" : curve.beside;
    figures.push_back(figure);
  }
  if (figures.empty()) return "";
  return fmt::format("{}{}: {}", curves[0].who, curves[0].skips && !by_skipping ? " with skipping" : "",
                     fmt::join(figures, ", "));
}

/// The claims of one sweep.
struct Sweep {
  std::size_t counts = 0;
  bool is_comparison = false;  ///< some detector ran in more than one way
  std::vector<Claim> claims;
};

Sweep read_sweep(const nlohmann::json& json, const std::string& file) {
  const std::string context = shared_context(json.at("series"));
  Sweep sweep;
  std::vector<std::vector<Curve>> detectors;  // the curves of one detector stand together
  const auto [fewest, most] = std::ranges::minmax_element(json["series"], {}, people_of);
  for (const auto& series : json["series"]) {
    // Of several numbers of people, the fewest and the most tell enough.
    if (people_of(series) != people_of(*fewest) && people_of(series) != people_of(*most)) continue;
    const Curve curve = curve_of(series, context.empty() ? ContextName::kSaid : ContextName::kLeftOut);
    sweep.counts = std::max(sweep.counts, curve.hz.size());
    auto same = std::ranges::find_if(detectors, [&](const auto& curves) { return curves[0].who == curve.who; });
    if (same == detectors.end()) same = detectors.insert(same, std::vector<Curve>());
    same->push_back(curve);
    sweep.is_comparison |= same->size() > 1;
  }
  const std::set<int> counts = quoted_counts(detectors);
  std::string topic = fmt::format("{}, {} triangles", file_name(json.at("trace")),
                                  json.at("avatar").at("triangles").get<std::uint64_t>());
  if (sweep.is_comparison) topic += ", " + colliders(*counts.rbegin());
  if (!context.empty()) topic += ", " + context;
  std::vector<std::string> others;
  for (const auto& curves : detectors) {
    const std::string text = sweep.is_comparison ? compared(curves, *counts.rbegin()) : along(curves[0], counts);
    if (text.empty()) continue;
    if (sweep.is_comparison && curves.size() == 1) {
      others.push_back(text);
    } else {
      sweep.claims.push_back({Question::kHowFast, topic, text, {file}});
    }
  }
  if (!others.empty())
    sweep.claims.push_back({Question::kHowFast, topic, fmt::format("{}", fmt::join(others, "; ")), {file}});
  return sweep;
}

/// Returns one claim for all rates of one kind: the slowest and the fastest.
std::optional<Claim> range_claim(std::vector<std::pair<double, std::string>> rates, const std::string& what,
                                 const std::string& runs) {
  if (rates.empty()) return std::nullopt;
  std::ranges::sort(rates);
  if (rates.size() > 2) std::rotate(rates.begin() + 1, rates.end() - 1, rates.end());
  Claim claim{Question::kHowFast, "", fmt::format("{} {:.0f} frames/s", what, rates[0].first), {}, 2};
  if (rates.size() > 1)
    claim.text =
        fmt::format("{} {:.0f} to {:.0f} frames/s in {} {}", what, rates[0].first, rates[1].first, rates.size(), runs);
  for (const auto& [rate, file] : rates) claim.files.push_back(file);
  return claim;
}

}  // namespace

std::vector<Claim> claims_how_fast(const std::vector<Result>& run) {
  std::vector<Sweep> sweeps;
  for_each(ResultKind::kSweep, run,
           [&](const nlohmann::json& sweep, const std::string& file) { sweeps.push_back(read_sweep(sweep, file)); });
  std::ranges::stable_sort(sweeps, [](const Sweep& a, const Sweep& b) {
    return std::pair(a.is_comparison, b.counts) < std::pair(b.is_comparison, a.counts);
  });
  std::vector<Claim> claims;
  for (const Sweep& sweep : sweeps) claims.insert(claims.end(), sweep.claims.begin(), sweep.claims.end());

  std::vector<std::pair<double, std::string>> recorded;
  std::vector<std::pair<double, std::string>> read;
  for_each(ResultKind::kRecord, run, [&](const nlohmann::json& record, const std::string& file) {
    recorded.emplace_back(record.at("frames").get<double>() / record.at("recording_s").get<double>(), file);
  });
  for_each(ResultKind::kReplay, run, [&](const nlohmann::json& replay, const std::string& file) {
    read.emplace_back(replay.at("frames").get<double>() / replay.at("reading_s").get<double>(), file);
  });
  for (const auto& claim : {range_claim(recorded, "`record` samples and writes", "recordings"),
                            range_claim(read, "The reader of traces delivers", "replays")})
    if (claim) claims.push_back(*claim);

  for_each(ResultKind::kExactness, run, [&](const nlohmann::json& benchmark, const std::string& file) {
    std::vector<std::string> ratios;
    for (const auto& frame : benchmark.at("frames"))
      ratios.push_back(fmt::format("{:.3f} ({}, skip {})", frame.at("ratio").get<double>(),
                                   frame.at("colliders").get<std::string>(), frame.value("skip", "off")));
    claims.push_back(
        {Question::kHowFast,
         "",
         fmt::format("A frame with exact decisions takes {} times the time of a frame with plain double decisions",
                     listed(ratios)),
         {file}});
  });
  return claims;
}

}  // namespace vestige
