#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/stress/stress_families.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// All families, in the order of their tables.
std::vector<StressFamily> stress_families();

/// The winner of each column by `exact::`, pair by pair; pairs that some axis keeps apart all the time are left out.
/// Rows carry everything.
void stress_truth(const StressSubject& subject, const Frame& frame, Method method, ContactRow& row);

/// A detector with a method. `make` is called for each body, and again for no other reason.
struct StressContestant {
  std::string detector;
  Method method = Method::kStatic;
  std::function<std::unique_ptr<Detector>(const StressSubject&)> make;
};

/// What one detector answered to one family at one magnitude.
struct StressCount {
  StressFamily family;
  double magnitude = 0;
  std::string detector;
  Method method = Method::kStatic;
  std::uint64_t cases = 0;
  std::uint64_t contacts = 0;  ///< that there truly are; with `kMustHit`, all
  std::uint64_t false_negatives = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t wrong_winner = 0;    ///< another triangle, or t of other bits, than the contract's winner rule gives
  std::uint64_t wrong_triangle = 0;  ///< those of them on another triangle
  std::uint64_t wrong_actuator = 0;  ///< on the right triangle with the right t, another actuator
  std::uint64_t unsure = 0;          ///< pairs that took exact arithmetic

  /// Errors that a user could feel or map differently: misses, false contacts, other triangles, other actuators.
  std::uint64_t felt() const { return false_negatives + false_positives + wrong_triangle + wrong_actuator; }
};

struct StressSettings {
  std::size_t cases = 200;  ///< of each family and magnitude
  std::uint64_t seed = 1;
};

/// Runs the families, all contestants on the same cases. Equal settings give equal counts, whichever other families run
/// beside. `progress` is told the share done and returns false to stop: then only what is complete comes back. Methods
/// other than `kStatic` are left out of the families that must hit, since there nothing moves.
std::vector<StressCount> run_stress(const std::vector<StressFamily>& families,
                                    const std::vector<StressContestant>& contestants, const StressSettings& settings,
                                    const std::function<bool(double)>& progress);

}  // namespace vestige
