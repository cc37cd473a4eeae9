#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "analysis/claims/claims.hpp"
#include "analysis/claims/wording.hpp"

namespace vestige {

namespace {

std::string code(const nlohmann::json& word) {
  return "`" + word.get<std::string>() + "`";
}

/// What detectors say in the same words stands together.
using Rows = std::vector<std::pair<std::string, std::vector<DetectorOnRenderer>>>;

void add_to(Rows& rows, const std::string& text, const DetectorOnRenderer& contestant) {
  auto row = std::ranges::find(rows, text, &Rows::value_type::first);
  if (row == rows.end()) row = rows.insert(rows.end(), {text, {}});
  row->second.push_back(contestant);
}

Claim claim_of(std::string text, std::vector<std::string> files) {
  return {Question::kHowRight, "", std::move(text), std::move(files)};
}

/// How many contacts of replays differ from those of another detector. Replays that agree stand together.
void add_verified(const std::vector<Result>& run, std::vector<Claim>& claims) {
  struct Sum {
    std::uint64_t differing = 0;
    std::uint64_t expected = 0;
    std::vector<std::string> methods;
    std::vector<std::string> files;
  };
  std::map<std::tuple<std::string, std::string, bool>, Sum> sums;
  for_each(ResultKind::kReplay, run, [&](const nlohmann::json& replay, const std::string& file) {
    if (!replay.contains("verify") || !replay["verify"].contains("differing")) return;
    const auto& verify = replay["verify"];
    const auto differing = verify["differing"].get<std::uint64_t>();
    const std::string who = code(replay.at("detector")) + on_renderer(replay.at("gl"), ContextName::kSaid) +
                            (replay.value("ignores_radii", false) ? ", which tests the centres of spheres," : "");
    Sum& sum = sums[{who, code(verify.at("against")), differing > 0}];
    sum.differing += differing;
    sum.expected += verify.at("expected").get<std::uint64_t>();
    const std::string method = code(replay.at("method"));
    if (std::ranges::find(sum.methods, method) == sum.methods.end()) sum.methods.push_back(method);
    sum.files.push_back(file);
  });
  for (const auto& [key, sum] : sums) {
    const auto& [who, against, differs] = key;
    const std::string replays = sum.files.size() > 1 ? fmt::format(" in {} replays", sum.files.size()) : "";
    claims.push_back(claim_of(fmt::format("{} by {}: {} of {} contacts differ from those of {}{}", who,
                                          listed(sum.methods), sum.differing, sum.expected, against, replays),
                              sum.files));
  }
}

/// Which detectors write the same texture.
void add_equal_textures(const std::vector<Result>& run, std::vector<Claim>& claims) {
  struct Texture {
    std::vector<DetectorOnRenderer> writers;
    std::string method;
    std::vector<std::string> files;
  };
  std::map<std::string, Texture> textures;
  for_each(ResultKind::kReplay, run, [&](const nlohmann::json& replay, const std::string& file) {
    Texture& texture = textures[replay.at("texture_hash").get<std::string>()];
    const DetectorOnRenderer writer = {replay.at("detector").get<std::string>(),
                                       on_renderer(replay.at("gl"), ContextName::kSaid)};
    if (std::ranges::find(texture.writers, writer) == texture.writers.end()) texture.writers.push_back(writer);
    texture.method = code(replay.at("method"));
    texture.files.push_back(file);
  });
  std::map<std::string, std::pair<std::set<std::string>, std::vector<std::string>>> by_writers;
  for (const auto& [hash, texture] : textures) {
    if (texture.writers.size() < 2) continue;
    auto& [methods, files] = by_writers[listed(texture.writers)];
    methods.insert(texture.method);
    files.insert(files.end(), texture.files.begin(), texture.files.end());
  }
  for (const auto& [writers, shown] : by_writers) {
    claims.push_back(claim_of(fmt::format("{} write the same texture, bit for bit, by {}", writers,
                                          listed(std::vector<std::string>(shown.first.begin(), shown.first.end()))),
                              shown.second));
    claims.back().links = 2;
  }
}

/// Whether a shader skinned the vertices that a replay compares with the CPU's. Older files have a number even where
/// the CPU skinned: `geometry` with skipping.
bool skinned_in_shader(const nlohmann::json& replay) {
  const bool skips = replay.at("detector") == "geometry" && replay.value("skip", "on") == "on";
  return !replay.at("gl").is_null() && !skips && !replay.at("skinning").at("identical_to_cpu").is_null();
}

/// How far skinned vertices lie from the double reference, and whether they have the CPU's bits.
void add_skinning(const std::vector<Result>& run, std::vector<Claim>& claims) {
  struct Skinning {
    double error = -1;
    std::uint64_t identical = 0;
    std::uint64_t vertices = 0;
    std::vector<std::string> files;  ///< the one with the largest error first
  };
  std::map<std::string, Skinning> skinnings;
  for_each(ResultKind::kReplay, run, [&](const nlohmann::json& replay, const std::string& file) {
    const bool in_shader = skinned_in_shader(replay);
    Skinning& skinning = skinnings[in_shader ? on_renderer(replay.at("gl")) : ""];
    const auto& measured = replay.at("skinning");
    const auto error = measured.at("largest_error_of_height").get<double>();
    skinning.files.insert(error > skinning.error ? skinning.files.begin() : skinning.files.end(), file);
    skinning.error = std::max(skinning.error, error);
    if (!in_shader) return;
    skinning.identical += measured.at("identical_to_cpu").get<std::uint64_t>();
    skinning.vertices += measured.at("vertices").get<std::uint64_t>();
  });
  if (skinnings.empty()) return;
  std::vector<std::string> texts;
  std::vector<std::string> files;
  for (const auto& [renderer, skinning] : skinnings) {
    texts.push_back(fmt::format("{:.2g}{}", skinning.error, renderer.empty() ? " on the CPU" : renderer));
    if (!renderer.empty())
      texts.back() += fmt::format(", with the CPU's bits in {} of {} vertices", skinning.identical, skinning.vertices);
    // The worst of each first.
    files.insert(files.begin(), skinning.files.front());
    files.insert(files.end(), skinning.files.begin() + 1, skinning.files.end());
  }
  claims.push_back(claim_of(
      fmt::format("Skinned vertices differ from the double reference by at most this share of the avatar's height: {}",
                  fmt::join(texts, "; ")),
      files));
  claims.back().links = skinnings.size();
}

/// "pairs", or "pairs with spheres".
std::string with_colliders(const nlohmann::json& agreement, const std::string& what) {
  return agreement.value("colliders", "points") == "points" ? what : what + " with spheres";
}

void add_agreement(const std::vector<Result>& run, std::vector<Claim>& claims) {
  struct Sum {
    std::uint64_t pairs = 0;
    std::uint64_t differences = 0;
    std::vector<std::string> files;
  };
  std::map<std::pair<std::string, std::string>, Sum> sums;  // what, method
  for_each(ResultKind::kAgreement, run, [&](const nlohmann::json& agreement, const std::string& file) {
    Sum& sum = sums[{with_colliders(agreement, "pairs"), agreement.at("method").get<std::string>()}];
    sum.files.push_back(file);
    for (const auto& family : agreement.at("families")) {
      sum.pairs += family.at("pairs").get<std::uint64_t>();
      sum.differences += family.at("differences").get<std::uint64_t>();
    }
  });
  if (sums.empty()) return;
  std::vector<std::string> texts;
  std::vector<std::string> files;
  for (const auto& [what, sum] : sums) {
    texts.push_back(fmt::format("{} of {} {} by `{}`", sum.differences, in_words(sum.pairs), what.first, what.second));
    files.insert(files.end(), sum.files.begin(), sum.files.end());
  }
  claims.push_back(claim_of(
      "The deciding code differs from the slow truth, which is rational arithmetic, in " + listed(texts), files));
}

void add_geometry_agreement(const std::vector<Result>& run, std::vector<Claim>& claims) {
  struct Sum {
    std::uint64_t pairs = 0;
    std::uint64_t missed = 0;
    std::uint64_t winners_differing = 0;
    std::vector<std::string> methods;
  };
  for_each(ResultKind::kGeometryAgreement, run, [&](const nlohmann::json& agreement, const std::string& file) {
    std::map<std::tuple<std::string, std::string, bool>, Sum> sums;  // detector, renderer, skipping
    for (const auto& method : agreement.at("methods")) {
      Sum& sum = sums[{method.value("detector", "geometry"), on_renderer(method, ContextName::kSaid),
                       method.value("skip", false)}];
      sum.pairs += method.at("pairs").get<std::uint64_t>();
      sum.missed += method.at("missed").get<std::uint64_t>();
      sum.winners_differing += method.at("winners_differing").get<std::uint64_t>();
      sum.methods.push_back(code(method.at("method")));
    }
    Rows rows;
    for (const auto& [who, sum] : sums)
      add_to(rows,
             fmt::format("{} by {}, against `cpu` on {} adversarial {}: {} missed, {} winners differ",
                         std::get<2>(who) ? " with skipping" : "", listed(sum.methods), in_words(sum.pairs),
                         with_colliders(agreement, "pairs"), sum.missed, sum.winners_differing),
             {std::get<0>(who), std::get<1>(who)});
    for (const auto& [text, contestants] : rows) claims.push_back(claim_of(listed(contestants) + text, {file}));
  });
}

void add_queries(const std::vector<Result>& run, std::vector<Claim>& claims) {
  for_each(ResultKind::kQuery, run, [&](const nlohmann::json& query, const std::string& file) {
    const auto& total = query.at("total");
    const auto count = [&total](const char* field) { return total.at(field).get<std::uint64_t>(); };
    const auto detector = query.at("detector").get<std::string>();
    claims.push_back(claim_of(
        fmt::format("`{}`{} answers {} queries of known truth by `{}` ({}) with {} false negatives and {} false "
                    "positives; {} in the median, {} at most",
                    detector, on_renderer(gl_used_by(detector, query.value("gl", nlohmann::json()))), count("queries"),
                    query.at("method").get<std::string>(), query.at("arithmetic").get<std::string>(),
                    count("false_negatives"), count("false_positives"), duration(total.at("median_us").get<double>()),
                    duration(total.at("max_us").get<double>())),
        {file}));
  });
}

/// Returns "8.2 to 11.0 %", or "0.0 %", for the shares missed at all rates.
std::string range_missed(const nlohmann::json& points) {
  std::vector<double> percent;
  for (const auto& point : points) {
    const nlohmann::json& share = point.at("missed_share");  // null: there was no true contact
    percent.push_back(share.is_number() ? 100 * share.get<double>() : 0);
  }
  if (percent.empty()) return "nothing measured";
  const auto [least, most] = std::ranges::minmax(percent);
  const std::string highest = fmt::format("{:.1f}", most);
  const std::string lowest = fmt::format("{:.1f}", least);
  return lowest == highest ? highest + " %" : fmt::format("{} to {} %", lowest, highest);
}

/// What the detectors of one scene miss by each method.
struct Scene {
  std::string name;
  Rows missed;                  ///< "8.2 to 11.0 % by `static`", and which detectors
  std::set<std::string> rates;  ///< one, unless the detectors were measured at different ones
  std::string detectors;        ///< which detectors each method has; "" if those of one method do not agree
};

Scene read_scene(const nlohmann::json& json, const nlohmann::json& gl) {
  Scene scene;
  scene.name = fmt::format("{}, of {} true contacts", json.at("colliders").get<std::string>(),
                           json.at("truth").at("events").get<std::uint64_t>());
  Rows methods;
  for (const auto& series : json.at("series")) {
    const auto detector = series.at("detector").get<std::string>();
    const DetectorOnRenderer contestant = {detector, on_renderer(gl_used_by(detector, gl))};
    const std::string method = code(series.at("method"));
    add_to(scene.missed, fmt::format("{} by {}", range_missed(series.at("points")), method), contestant);
    add_to(methods, method, contestant);
    std::vector<std::string> rates;
    for (const auto& point : series["points"]) rates.push_back(fmt::format("{}", point.at("rate_hz").get<double>()));
    scene.rates.insert(listed(rates));
  }
  if (scene.missed.size() != methods.size()) return scene;
  std::vector<std::string> names;
  for (const auto& [method, contestants] : methods)
    names.push_back(fmt::format("{} of {}", method, listed(contestants)));
  scene.detectors = fmt::format("{}", fmt::join(names, "; "));
  return scene;
}

/// As written by version 0.2: what detectors miss on a moving avatar. If those with the same method miss the same in
/// all scenes, a row of its own names them.
void add_missed(const nlohmann::json& accuracy, const std::string& file, std::vector<Claim>& claims) {
  std::vector<Scene> scenes;
  std::set<std::string> rates;
  for (const auto& scene : accuracy.at("scenes")) {
    scenes.push_back(read_scene(scene, accuracy.value("gl", nlohmann::json())));
    rates.insert(scenes.back().rates.begin(), scenes.back().rates.end());
  }
  if (scenes.empty()) return;
  const std::string topic = fmt::format("Contacts missed on a moving avatar, at {} Hz", fmt::join(rates, " or "));
  const std::string& detectors = scenes[0].detectors;
  const bool agree = std::ranges::all_of(
      scenes, [&](const Scene& scene) { return !detectors.empty() && scene.detectors == detectors; });
  for (const Scene& scene : scenes) {
    std::vector<std::string> missed;
    for (const auto& [text, contestants] : scene.missed)
      missed.push_back(agree ? text : fmt::format("{} ({})", text, listed(contestants)));
    claims.push_back({Question::kHowRight, topic, fmt::format("{}: {}", scene.name, fmt::join(missed, "; ")), {file}});
  }
  if (agree)
    claims.push_back({Question::kHowRight,
                      topic,
                      "Every detector with the same method misses the same shares: " + detectors,
                      {file}});
}

/// The rate at which events are quoted: that of common head-mounted displays, where it was measured.
constexpr double kQuotedRate_hz = 90;

double quoted_rate_hz(const nlohmann::json& accuracy) {
  std::vector<double> rates_hz;
  for (const auto& scene : accuracy.at("scenes"))
    for (const auto& series : scene.at("series"))
      for (const auto& point : series.at("points")) rates_hz.push_back(point.at("rate_hz").get<double>());
  if (rates_hz.empty() || std::ranges::find(rates_hz, kQuotedRate_hz) != rates_hz.end()) return kQuotedRate_hz;
  return rates_hz.front();
}

/// Returns "62.1 (55.0 to 70.2)", or "< 0.14" if none is wrong, for each hundred.
std::string per_100(const nlohmann::json& share) {
  if (!share.at("value").is_number()) return "nothing measured";
  const double value = share["value"].get<double>();
  const auto has_interval = share.at("low").is_number() && share.at("high").is_number();
  if (value == 0 && has_interval) return fmt::format("< {:.2g}", 100 * share["high"].get<double>());
  if (!has_interval) return fmt::format("{:.1f}", 100 * value);
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", 100 * value, 100 * share["low"].get<double>(),
                     100 * share["high"].get<double>());
}

/// What every detector gets wrong in one scene at one rate, those with the fewest errors first.
std::string wrong_in(const nlohmann::json& scene, double rate_hz, const nlohmann::json& gl) {
  Rows rows;
  std::map<std::string, double> order;
  for (const auto& series : scene.at("series"))
    for (const auto& point : series.at("points")) {
      if (point.at("rate_hz") != rate_hz) continue;
      const auto& share = point.at("within_tolerance").at("wrong_share");
      const auto detector = series.at("detector").get<std::string>();
      const std::string text = fmt::format(" by {}: {}", code(series.at("method")), per_100(share));
      const std::string approximate = approximate_words(series);
      add_to(rows, text, {detector, approximate + on_renderer(gl_used_by(detector, gl))});
      order[text] = share.at("value").is_number() ? share["value"].get<double>() : 0;
    }
  std::ranges::stable_sort(rows, {}, [&](const Rows::value_type& row) { return order[row.first]; });
  std::vector<std::string> texts;
  for (const auto& [text, contestants] : rows) texts.push_back(listed(contestants) + text);
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// What detectors get wrong on a moving avatar, within the tolerance on the time of impact.
void add_wrong(const nlohmann::json& accuracy, const std::string& file, std::vector<Claim>& claims) {
  const double rate_hz = quoted_rate_hz(accuracy);
  const std::string topic = fmt::format(
      "Events wrong (missed, false or with another actuator) for each 100 true contacts of a moving avatar, at {} Hz, "
      "within {} ms",
      rate_hz, accuracy.at("tolerance_ms").get<double>());
  for (const auto& scene : accuracy.at("scenes")) {
    const std::string text = wrong_in(scene, rate_hz, accuracy.value("gl", nlohmann::json()));
    if (text.empty()) continue;
    claims.push_back({Question::kHowRight,
                      topic,
                      fmt::format("{}, {} true contacts: {}", scene.at("colliders").get<std::string>(),
                                  scene.at("truth").at("events").get<std::uint64_t>(), text),
                      {file}});
  }
}

/// Whether touches of spheres are reported in every frame of theirs, and in no other.
void add_touches(const nlohmann::json& accuracy, const std::string& file, std::vector<Claim>& claims) {
  for (const auto& scene : accuracy.at("scenes")) {
    Rows rows;
    for (const auto& series : scene.at("series"))
      for (const auto& point : series.at("points")) {
        if (!point.contains("touches")) continue;
        const auto& touches = point["touches"];
        const auto count = [&touches](const char* field) { return touches.at(field).get<std::uint64_t>(); };
        add_to(rows,
               fmt::format(" by {} at {} Hz: {} of {} frames within a touch reported, {} of {} frames outside reported "
                           "falsely",
                           code(series.at("method")), point.at("rate_hz").get<double>(), count("reported"),
                           count("frames_within"), count("false"), count("frames_outside")),
               {series.at("detector").get<std::string>(), ""});
      }
    for (const auto& [text, contestants] : rows)
      claims.push_back({Question::kHowRight,
                        "Frames of spheres, more than one frame from a touch's beginning and end",
                        fmt::format("{}, {}{}", scene.at("colliders").get<std::string>(), listed(contestants), text),
                        {file}});
  }
}

void add_accuracy(const nlohmann::json& accuracy, const std::string& file, std::vector<Claim>& claims) {
  if (accuracy.contains("tolerance_ms")) {
    add_wrong(accuracy, file, claims);
    add_touches(accuracy, file, claims);
  } else {
    add_missed(accuracy, file, claims);
  }
}

}  // namespace

std::vector<Claim> claims_how_right(const std::vector<Result>& run) {
  std::vector<Claim> claims;
  add_agreement(run, claims);
  add_geometry_agreement(run, claims);
  add_verified(run, claims);
  add_equal_textures(run, claims);
  add_skinning(run, claims);
  add_queries(run, claims);
  for_each(ResultKind::kAccuracy, run,
           [&](const nlohmann::json& accuracy, const std::string& file) { add_accuracy(accuracy, file, claims); });
  return claims;
}

}  // namespace vestige
