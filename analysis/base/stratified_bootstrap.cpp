#include "analysis/base/stratified_bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace vestige {

namespace {

constexpr double kTail = 0.025;

/// Holm's step-down correction of the p of all tests.
void correct(std::vector<std::optional<LeaderTest>>& tests, std::size_t leader) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < tests.size(); ++c)
    if (tests[c] && c != leader) order.push_back(c);
  std::ranges::stable_sort(order, {}, [&](std::size_t c) { return tests[c]->p; });
  double most = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    LeaderTest& test = *tests[order[k]];
    most = std::max(most, std::min(1.0, test.p * static_cast<double>(order.size() - k)));
    test.p_holm = most;
  }
}

/// The two best of some candidates, lower being better.
struct BestTwo {
  std::size_t best = 0;
  std::size_t second = 0;

  /// Returns the best other than `candidate`.
  std::size_t other_than(std::size_t candidate) const { return candidate == best ? second : best; }
};

BestTwo best_two(std::span<const double> means) {
  BestTwo two = {means[1] < means[0] ? 1U : 0U, means[1] < means[0] ? 0U : 1U};
  for (std::size_t k = 2; k < means.size(); ++k) {
    if (means[k] < means[two.best])
      two = {k, two.best};
    else if (means[k] < means[two.second])
      two.second = k;
  }
  return two;
}

/// Candidates that are compared unit by unit. A unit's part in a candidate's mean is how far it moves the mean from
/// those of the strata.
class Comparison {
 public:
  using Strata = std::vector<std::vector<std::uint32_t>>;

  /// `count` candidates are then added.
  Comparison(const Strata& units_of, std::size_t units, std::size_t count)
      : units_of_(units_of), count_(count), parts_(units * count) {}

  void add(std::span<const double> values, double sign) {
    const std::size_t k = means_.size();
    double sum = 0;
    double count = 0;
    for (const auto& units : units_of_) {
      double sum_here = 0;
      double count_here = 0;
      for (const std::uint32_t unit : units) {
        if (std::isnan(values[unit])) continue;
        sum_here += sign * values[unit];
        ++count_here;
      }
      // Values drawn from few scatter less than those few.
      const double widening = std::sqrt(static_cast<double>(units.size()) / static_cast<double>(units.size() - 1));
      for (const std::uint32_t unit : units)
        if (!std::isnan(values[unit]))
          parts_[unit * count_ + k] = widening * (sign * values[unit] - sum_here / count_here);
      sum += sum_here;
      count += count_here;
    }
    for (std::size_t unit = 0; unit < values.size(); ++unit) parts_[unit * count_ + k] /= count;
    means_.push_back(sum / count);
  }

  const std::vector<double>& means() const { return means_; }

  /// Adds up the parts of drawn units for each candidate.
  void sum_up(std::span<const std::uint32_t> drawn, std::vector<double>& sums) const {
    sums.assign(count_, 0);
    for (const std::uint32_t unit : drawn)
      for (std::size_t k = 0; k < count_; ++k) sums[k] += parts_[unit * count_ + k];
  }

  /// Returns the standard error of the difference between each candidate and the best of the others.
  void errors(std::span<const std::uint32_t> drawn, const BestTwo& two, std::vector<double>& errors) const {
    errors.assign(count_, 0);
    std::vector<double>& sums = sums_;
    std::vector<double>& squares = squares_;
    for (std::size_t s = 0, at = 0; s < units_of_.size(); ++s) {
      const auto units = static_cast<double>(units_of_[s].size());
      sums.assign(count_, 0);
      squares.assign(count_, 0);
      for (const std::size_t end = at + units_of_[s].size(); at < end; ++at) {
        const double* parts = &parts_[drawn[at] * count_];
        const double best = parts[two.best];
        for (std::size_t k = 0; k < count_; ++k) {
          const double difference = parts[k] - best;
          sums[k] += difference;
          squares[k] += difference * difference;
        }
      }
      for (std::size_t k = 0; k < count_; ++k) {
        const double scatter = squares[k] - sums[k] * sums[k] / units;  // the widening makes up for units - 1
        constexpr double kRounding = 1e-12;                             // equal differences scatter by rounding only
        if (scatter > kRounding * squares[k]) errors[k] += scatter;
      }
    }
    for (double& error : errors) error = std::sqrt(error);
    errors[two.best] = errors[two.second];  // the best of the others is the second, and a difference has one error
  }

 private:
  const Strata& units_of_;
  std::size_t count_;
  std::vector<double> means_;
  std::vector<double> parts_;  ///< by unit, then by candidate
  mutable std::vector<double> sums_;
  mutable std::vector<double> squares_;
};

/// How resamples of a candidate differ from the best of the others, in standard errors.
struct Studentized {
  std::vector<double> differences;  ///< less the difference found
  double behind = 0;                ///< resamples in which chance alone puts it behind
  double as_far = 0;                ///< and as far behind as it is
};

}  // namespace

StratifiedBootstrap::StratifiedBootstrap(std::span<const std::size_t> stratum_of_unit, std::uint64_t seed)
    : stratum_of_unit_(stratum_of_unit.begin(), stratum_of_unit.end()) {
  if (stratum_of_unit_.empty()) return;
  const std::size_t strata = std::ranges::max(stratum_of_unit_) + 1;
  units_of_.resize(strata);
  for (std::uint32_t unit = 0; unit < stratum_of_unit_.size(); ++unit)
    units_of_[stratum_of_unit_[unit]].push_back(unit);
  all_units_.reserve(stratum_of_unit_.size());
  for (const auto& of_stratum : units_of_) all_units_.insert(all_units_.end(), of_stratum.begin(), of_stratum.end());
  if (std::ranges::any_of(units_of_, [](const auto& of_stratum) { return of_stratum.size() < kLeastUnits; })) return;
  if (stratum_of_unit_.size() < strata + kLeastFreedom) return;
  std::mt19937_64 random(seed);
  drawn_.reserve(kResamples * stratum_of_unit_.size());
  for (std::size_t i = 0; i < kResamples; ++i)
    for (const std::vector<std::uint32_t>& of_stratum : units_of_)
      for (std::size_t k = 0; k < of_stratum.size(); ++k)
        drawn_.push_back(of_stratum[((random() >> 32U) * of_stratum.size()) >> 32U]);
}

bool StratifiedBootstrap::has_interval(std::span<const double> values) const {
  if (!has_intervals()) return false;
  std::size_t freedom = 0;
  for (const std::vector<std::uint32_t>& of_stratum : units_of_) {
    const auto there = static_cast<std::size_t>(
        std::ranges::count_if(of_stratum, [&](std::uint32_t unit) { return !std::isnan(values[unit]); }));
    if (there == 0) continue;
    if (there < kLeastUnits) return false;
    freedom += there - 1;
  }
  return freedom >= kLeastFreedom;
}

StratifiedBootstrap::Estimate StratifiedBootstrap::estimate(std::span<const double> values,
                                                            std::span<const std::uint32_t> units) const {
  double all = 0;
  double sum = 0;
  double variance = 0;
  for (std::size_t s = 0, at = 0; s < units_of_.size(); ++s) {
    double count = 0;
    double sum_here = 0;
    double squares = 0;
    for (const std::size_t end = at + units_of_[s].size(); at < end; ++at) {
      const double value = values[units[at]];
      if (std::isnan(value)) continue;
      ++count;
      sum_here += value;
      squares += value * value;
    }
    if (count == 0) continue;
    all += count;
    sum += sum_here;
    variance += count > 1 ? std::max(0.0, squares - sum_here * sum_here / count) * count / (count - 1) : kMissing;
  }
  if (all == 0) return {kMissing, kMissing};
  return {sum / all, std::sqrt(variance) / all};
}

MeanInterval StratifiedBootstrap::mean(std::span<const double> values) const {
  MeanInterval result = {kMissing, {kMissing, kMissing}, 0};
  // Values are taken from a middle one, so that squares of large values lose nothing.
  const auto some = std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  if (some == values.end()) return result;
  const double middle = *some;
  std::vector<double> centred(values.begin(), values.end());
  for (double& value : centred) value -= middle;
  const Estimate found = estimate(centred, all_units_);
  result.n = static_cast<std::size_t>(std::ranges::count_if(values, [](double value) { return !std::isnan(value); }));
  result.mean = middle + found.mean;
  if (!has_interval(values)) return result;
  if (found.error == 0) {
    result.interval = {result.mean, result.mean};
    return result;
  }
  std::vector<double> studentized;
  studentized.reserve(kResamples);
  for (std::size_t i = 0; i < kResamples; ++i) {
    const Estimate drawn = estimate(centred, resample(i));
    if (drawn.error > 0) studentized.push_back((drawn.mean - found.mean) / drawn.error);
  }
  result.interval = {result.mean - found.error * quantile(studentized, 1 - kTail),
                     result.mean - found.error * quantile(studentized, kTail)};
  return result;
}

std::vector<std::optional<LeaderTest>> StratifiedBootstrap::against_leader(
    std::span<const std::vector<double>> candidates, double sign) const {
  std::vector<std::optional<LeaderTest>> tests(candidates.size());
  if (!has_intervals()) return tests;
  std::vector<std::size_t> index;  // of those that can be compared
  for (std::size_t c = 0; c < candidates.size(); ++c)
    if (has_interval(candidates[c])) index.push_back(c);
  const std::size_t count = index.size();
  if (count == 0) return tests;
  if (count == 1) {
    tests[index.front()].emplace();
    return tests;
  }
  Comparison compared(units_of_, stratum_of_unit_.size(), count);
  for (const std::size_t c : index) compared.add(candidates[c], sign);
  const std::vector<double>& means = compared.means();
  const BestTwo found = best_two(means);
  std::vector<double> found_errors;
  compared.errors(all_units_, found, found_errors);

  std::vector<Studentized> studentized(count);
  std::vector<double> chance;
  std::vector<double> drawn_means(count);
  std::vector<double> errors;
  for (Studentized& one : studentized) one.differences.reserve(kResamples);
  for (std::size_t i = 0; i < kResamples; ++i) {
    compared.sum_up(resample(i), chance);
    for (std::size_t k = 0; k < count; ++k) drawn_means[k] = means[k] + chance[k];
    const BestTwo drawn = best_two(drawn_means);
    compared.errors(resample(i), drawn, errors);
    for (std::size_t k = 0; k < count; ++k) {
      const double difference = drawn_means[k] - drawn_means[drawn.other_than(k)];
      const double behind = means[k] - means[found.other_than(k)];
      if (errors[k] > 0) studentized[k].differences.push_back((difference - behind) / errors[k]);
    }
    const BestTwo lucky = best_two(chance);
    compared.errors(resample(i), lucky, errors);
    for (std::size_t k = 0; k < count; ++k) {
      if (k == lucky.best) continue;
      ++studentized[k].behind;
      const double behind = means[k] - means[found.other_than(k)];
      const double by_chance = chance[k] - chance[lucky.best];
      // Two that differ in a few units only may not scatter at all in a resample without these.
      const bool is_as_far = errors[k] > 0 ? by_chance * found_errors[k] >= behind * errors[k] : by_chance >= behind;
      if (behind > 0 && is_as_far) ++studentized[k].as_far;
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    LeaderTest& test = tests[index[k]].emplace();
    const double behind = means[k] - means[found.best];
    if (behind == 0) continue;  // a leader, maybe one of several
    const std::vector<double>& spread = studentized[k].differences;
    test.difference = sign * behind;
    const double error = found_errors[k];
    const Interval interval = spread.empty() ? Interval{behind, behind}
                                             : Interval{std::max(0.0, behind - error * quantile(spread, 1 - kTail)),
                                                        std::max(0.0, behind - error * quantile(spread, kTail))};
    test.interval = sign > 0 ? interval : Interval{-interval.high, -interval.low};
    test.p = std::min(1.0, (1 + studentized[k].as_far) / (1 + studentized[k].behind));
  }
  correct(tests, index[found.best]);
  return tests;
}

}  // namespace vestige
