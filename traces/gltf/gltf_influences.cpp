#include "traces/gltf/gltf_influences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vestige::gltf {

namespace {

// Exporters that round to 8 bits or to a few digits stay below this.
constexpr double kSumTolerance = 1e-2;

void sort_by_palette(std::vector<Influence>& influences) {
  std::stable_sort(influences.begin(), influences.end(),
                   [](const Influence& a, const Influence& b) { return a.palette < b.palette; });
}

void merge_equal(std::vector<Influence>& sorted) {
  std::size_t used = 0;
  for (const Influence& influence : sorted) {
    if (influence.weight == 0) continue;
    if (used > 0 && sorted[used - 1].palette == influence.palette)
      sorted[used - 1].weight += influence.weight;
    else
      sorted[used++] = influence;
  }
  sorted.resize(used);
}

double sum_of(const std::vector<Influence>& influences) {
  double sum = 0;
  for (const Influence& influence : influences) sum += influence.weight;
  return sum;
}

}  // namespace

Influences combine_influences(std::vector<Influence>& influences, std::uint16_t first, std::string_view path,
                              Report& report) {
  sort_by_palette(influences);
  merge_equal(influences);
  if (influences.empty()) {
    report.warn(path, "has vertices without any weight; they follow their first joint");
    influences.push_back({first, 1.0});
  }
  if (std::abs(sum_of(influences) - 1) > kSumTolerance)
    report.warn(path, "has weights whose sum is not 1; they are normalised");
  if (influences.size() > kMaxInfluences) {
    report.warn(path, fmt::format("has vertices with more than {0} joints; only the {0} largest weights are kept",
                                  kMaxInfluences));
    std::stable_sort(influences.begin(), influences.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    influences.resize(kMaxInfluences);
    sort_by_palette(influences);
  }
  const double sum = sum_of(influences);
  // A weight that is zero in single precision moves nothing.
  std::erase_if(influences, [&](const Influence& i) { return static_cast<float>(i.weight / sum) == 0; });
  Influences result;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    result.palette[i] = influences[i].palette;
    result.weight[i] = static_cast<float>(influences[i].weight / sum);
  }
  return result;
}

}  // namespace vestige::gltf
