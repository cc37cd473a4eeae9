// How often the intervals of a ranking hold the truth: batches of known truth are simulated, ranked as 'vestige batch'
// ranks them, and counted. Prints, and writes coverage.json.
// usage: coverage_benchmark [FOLDER] [BATCHES]

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/base/stratified_bootstrap.hpp"

namespace vestige {
namespace {

enum class Shape { kNormal, kSkewed, kVerySkewed };
constexpr const char* kShapeNames[] = {"normal", "skewed", "very skewed"};

/// What a batch is of. One stratum: files, each a cluster. Otherwise: scenarios with several seeds.
struct Design {
  std::string name;
  std::size_t strata = 1;
  std::size_t units = 0;  ///< of a stratum
  Shape shape = Shape::kSkewed;
};

/// Localisation errors as batches show them: some candidates lie close together, others far behind.
constexpr double kMeans_mm[] = {18.8, 19.6, 21.5, 30, 47, 70};
constexpr std::size_t kCandidates = std::size(kMeans_mm);

/// Factors of mean 1. Skewed ones have a normal logarithm, as errors nearly do.
class Factor {
 public:
  Factor(double spread, Shape shape) : spread_(shape == Shape::kVerySkewed ? 2 * spread : spread), shape_(shape) {}
  double operator()(std::mt19937_64& random) {
    const double value = spread_ * normal_(random);
    return shape_ == Shape::kNormal ? 1 + value : std::exp(value - spread_ * spread_ / 2);
  }

 private:
  double spread_;
  Shape shape_;
  std::normal_distribution<double> normal_;
};

struct Batch {
  std::vector<std::size_t> stratum_of_unit;
  std::vector<std::vector<double>> values;  ///< by candidate and unit
  std::vector<double> truth;                ///< by candidate
};

Batch simulate(const Design& design, bool equal, std::mt19937_64& random) {
  Factor hard(0.4, design.shape);        // a unit is hard for all candidates
  Factor own(0.25, design.shape);        // and another for one of them
  Factor scenario(0.5, Shape::kSkewed);  // scenarios differ, for all
  Factor suits(0.2, Shape::kSkewed);     // and for one candidate
  Batch batch;
  batch.values.resize(kCandidates);
  batch.truth.resize(kCandidates);
  for (std::size_t s = 0; s < design.strata; ++s) {
    const double level = design.strata == 1 ? 1 : scenario(random);
    std::vector<double> expected;
    for (std::size_t c = 0; c < kCandidates; ++c) {
      expected.push_back(equal ? 20 * level : kMeans_mm[c] * level * (design.strata == 1 ? 1 : suits(random)));
      batch.truth[c] += expected[c] / static_cast<double>(design.strata);
    }
    for (std::size_t u = 0; u < design.units; ++u) {
      batch.stratum_of_unit.push_back(s);
      const double here = hard(random);
      for (std::size_t c = 0; c < kCandidates; ++c) batch.values[c].push_back(expected[c] * here * own(random));
    }
  }
  return batch;
}

struct Count {
  std::size_t held = 0;
  std::size_t of = 0;

  void add(bool holds) {
    held += holds ? 1U : 0U;
    ++of;
  }
  void add(const Count& other) {
    held += other.held;
    of += other.of;
  }
  double share() const { return static_cast<double>(held) / static_cast<double>(of); }
};

struct Coverage {
  Count mean;
  Count leader_mean;  ///< of the first of the ranking alone
  Count difference;
  Count from_found;   ///< the difference from the first of the ranking, who need not be the best
  Count false_alarm;  ///< batches of equal candidates, one of which is called worse

  void add(const Coverage& other) {
    mean.add(other.mean);
    leader_mean.add(other.leader_mean);
    difference.add(other.difference);
    from_found.add(other.from_found);
    false_alarm.add(other.false_alarm);
  }
};

bool holds(const Interval& interval, double truth) {
  constexpr double kSlack = 1e-9;  // rounding
  return interval.low <= truth + kSlack && truth <= interval.high + kSlack;
}

void judge(const Batch& batch, std::uint64_t seed, Coverage& coverage) {
  const StratifiedBootstrap bootstrap(batch.stratum_of_unit, seed);
  const auto tests = bootstrap.against_leader(batch.values, 1);
  const double best = std::ranges::min(batch.truth);
  std::size_t leader = 0;
  for (std::size_t c = 0; c < kCandidates; ++c)
    if (tests[c]->difference == 0) leader = c;
  for (std::size_t c = 0; c < kCandidates; ++c) {
    const bool covered = holds(bootstrap.mean(batch.values[c]).interval, batch.truth[c]);
    coverage.mean.add(covered);
    if (c == leader) {
      coverage.leader_mean.add(covered);
      continue;
    }
    coverage.difference.add(holds(tests[c]->interval, batch.truth[c] - best));
    coverage.from_found.add(holds(tests[c]->interval, std::max(0.0, batch.truth[c] - batch.truth[leader])));
  }
}

Coverage measure(const Design& design, std::uint64_t first_seed, std::size_t batches) {
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<Coverage> counted(threads);
  std::vector<std::thread> running;
  std::atomic<std::uint64_t> next = 0;
  for (std::size_t t = 0; t < threads; ++t)
    running.emplace_back([&, t] {
      for (std::uint64_t b = next++; b < batches; b = next++) {
        std::mt19937_64 random(first_seed + b);
        judge(simulate(design, false, random), b, counted[t]);
        const Batch equal = simulate(design, true, random);
        const auto tests = StratifiedBootstrap(equal.stratum_of_unit, b).against_leader(equal.values, 1);
        counted[t].false_alarm.add(std::ranges::any_of(tests, [](const auto& test) { return test->p_holm < 0.05; }));
      }
    });
  for (std::thread& thread : running) thread.join();
  Coverage all;
  for (const Coverage& one : counted) all.add(one);
  return all;
}

int run(const std::filesystem::path& folder, std::size_t batches) {
  std::vector<Design> designs;
  for (const Shape shape : {Shape::kNormal, Shape::kSkewed, Shape::kVerySkewed}) {
    for (const std::size_t files : {8U, 20U}) designs.push_back({fmt::format("{} files", files), 1, files, shape});
    designs.push_back({"2 scenarios x 5 seeds", 2, 5, shape});
    for (const std::size_t seeds : {5U, 20U})
      designs.push_back({fmt::format("6 scenarios x {} seeds", seeds), 6, seeds, shape});
  }
  nlohmann::ordered_json json = provenance(std::vector<std::string>{"coverage_benchmark", folder.string()});
  json["batches"] = batches;
  json["resamples"] = StratifiedBootstrap::kResamples;
  fmt::print("{} simulated batches of {} candidates a row; how often a 95 % interval holds the truth\n", batches,
             kCandidates);
  fmt::print("{:<24}  {:<11}  {:>8}  {:>14}  {:>10}  {:>14}  {:>12}\n", "batch of", "errors", "mean", "leader's mean",
             "from best", "from the first", "false alarms");
  std::uint64_t first_seed = 1;
  for (const Design& design : designs) {
    const Coverage found = measure(design, first_seed, batches);
    first_seed += batches;
    const char* shape = kShapeNames[static_cast<std::size_t>(design.shape)];
    const auto percent = [](const Count& count) { return fmt::format("{:.1f} %", 100 * count.share()); };
    fmt::print("{:<24}  {:<11}  {:>8}  {:>14}  {:>10}  {:>14}  {:>12}\n", design.name, shape, percent(found.mean),
               percent(found.leader_mean), percent(found.difference), percent(found.from_found),
               percent(found.false_alarm));
    json["designs"].push_back({{"name", design.name},
                               {"strata", design.strata},
                               {"units", design.units},
                               {"errors", shape},
                               {"mean", found.mean.share()},
                               {"leader_mean", found.leader_mean.share()},
                               {"difference_from_best", found.difference.share()},
                               {"difference_from_first", found.from_found.share()},
                               {"false_alarms", found.false_alarm.share()}});
  }
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "coverage.json") << json.dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  return vestige::run(argc > 1 ? argv[1] : "out/coverage_benchmark",
                      argc > 2 ? static_cast<std::size_t>(std::atoll(argv[2])) : 2000);
}
