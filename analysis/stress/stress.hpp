#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/stress/stress_families.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// Returns all families, in the order of the tables.
std::vector<StressFamily> stress_families();

/// Fills `row` with the true winner of each column, found by `exact::` pair by pair. Pairs of a point and a triangle
/// that some axis separates all the time are skipped. The row carries all planes.
void stress_truth(const StressSubject& subject, const DetectorFrame& frame, Method method, ContactRow& row);

/// A detector with a method. `make` is called once for each body.
struct StressContestant {
  std::string detector;
  Method method = Method::kStatic;
  std::function<std::unique_ptr<Detector>(const StressSubject&)> make;
  bool takes_radii = true;  ///< it tests spheres, and not only their centres
};

/// How one detector answered one family at one magnitude.
struct StressCount {
  StressFamily family;
  double magnitude = 0;
  std::string detector;
  Method method = Method::kStatic;
  std::uint64_t cases = 0;
  std::uint64_t contacts = 0;  ///< true contacts; with `kMustHit`, all cases
  std::uint64_t false_negatives = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t wrong_winner = 0;    ///< other triangle, or other bits of t, than the contract's winner rule gives
  std::uint64_t wrong_triangle = 0;  ///< those of `wrong_winner` on another triangle
  std::uint64_t wrong_actuator = 0;  ///< on the right triangle, with another actuator
  std::uint64_t unsure = 0;          ///< pairs that needed exact arithmetic

  /// Returns the errors that a user could feel or map differently: misses, false contacts, other triangles, other
  /// actuators.
  std::uint64_t felt() const { return false_negatives + false_positives + wrong_triangle + wrong_actuator; }
};

struct StressSettings {
  std::size_t cases = 200;  ///< for each family and magnitude
  std::uint64_t seed = 1;
};

/// Runs the families with all contestants on the same cases. Equal settings give equal counts, whichever other families
/// run too. `progress` receives the share done and returns false to stop. A stopped run returns only complete counts.
/// Families with `kMustHit` run with `kStatic` only, since their bodies do not move.
std::vector<StressCount> run_stress(const std::vector<StressFamily>& families,
                                    const std::vector<StressContestant>& contestants, const StressSettings& settings,
                                    const std::function<bool(double)>& progress);

}  // namespace vestige
