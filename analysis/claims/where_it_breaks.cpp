#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/claims/claims.hpp"
#include "analysis/claims/wording.hpp"

namespace vestige {

namespace {

/// What one detector gets wrong by one method.
struct Sum {
  std::uint64_t cases = 0;
  std::uint64_t missed = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t wrong_winner = 0;
  std::map<std::string, std::uint64_t> missed_of_family;
};

std::string text_of(const Sum& sum, const std::string& method) {
  std::string text = fmt::format("`{}`, {} cases: {} missed, {} false, {} with a wrong winner", method,
                                 in_words(sum.cases), sum.missed, sum.false_positives, sum.wrong_winner);
  const auto worst = std::ranges::max_element(sum.missed_of_family, {}, [](const auto& item) { return item.second; });
  if (sum.missed_of_family.size() > 1 && worst->second > 0)
    text += fmt::format("; `{}` is missed most often ({})", worst->first, worst->second);
  return text;
}

void add_stress(const nlohmann::json& stress, const std::string& file, std::vector<Claim>& claims) {
  std::vector<std::pair<std::string, std::string>> order;  // method, detector
  std::map<std::pair<std::string, std::string>, Sum> sums;
  std::set<std::string> families;
  for (const auto& row : stress.at("families")) {
    const std::pair key = {row.at("method").get<std::string>(), row.at("detector").get<std::string>()};
    if (!sums.contains(key)) order.push_back(key);
    Sum& sum = sums[key];
    const auto family = row.value("name", "");
    families.insert(family);
    sum.cases += row.at("cases").get<std::uint64_t>();
    sum.missed += row.at("false_negatives").get<std::uint64_t>();
    sum.false_positives += row.at("false_positives").get<std::uint64_t>();
    sum.wrong_winner += row.at("wrong_winner").get<std::uint64_t>();
    sum.missed_of_family[family] += row["false_negatives"].get<std::uint64_t>();
  }
  std::vector<std::pair<std::string, std::vector<DetectorOnRenderer>>> rows;
  for (const auto& [method, detector] : order) {
    const std::string text = text_of(sums[{method, detector}], method);
    auto row = std::ranges::find(rows, text, &std::pair<std::string, std::vector<DetectorOnRenderer>>::first);
    if (row == rows.end()) row = rows.insert(rows.end(), {text, {}});
    row->second.emplace_back(detector, on_renderer(gl_used_by(detector, stress.value("gl", nlohmann::json()))));
  }
  const std::string topic = families.size() == 1 ? fmt::format("Hostile cases of the family `{}`", *families.begin())
                                                 : fmt::format("Hostile cases of {} families", families.size());
  for (const auto& [text, contestants] : rows)
    claims.push_back({Question::kWhereItBreaks, topic, fmt::format("{} by {}", listed(contestants), text), {file}});
}

}  // namespace

std::vector<Claim> claims_where_it_breaks(const std::vector<Result>& run) {
  std::vector<Claim> claims;
  for_each(ResultKind::kStress, run,
           [&](const nlohmann::json& stress, const std::string& file) { add_stress(stress, file, claims); });
  return claims;
}

}  // namespace vestige
