#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"

namespace vestige {

/// Returns IT = Σ p_ij log2(p_ij / (p_i p_j)), in bits, where `counts` says how often stimulus i (row) got response j
/// (column) (Tan, Reed & Durlach 2010, "Optimum information transfer rates for communication through haptic and other
/// sensory modalities"). n equally frequent stimuli, each with its own response, give log2 n. No counts give 0. The
/// estimate from few counts is too high by about (rows - 1)(columns - 1) / (2 ln 2 counts) (Miller 1955).
double transmitted_bits(std::span<const double> counts, std::size_t columns);

/// A closed-form model of a noisy observer who tells where contacts are.
///
/// The stimulus is the region of a contact: its actuator by the map, otherwise the nearest actuator. The observer feels
/// the contact at the middle of the actuators that fire (`FeltOffset::amplitude_m`), with Gaussian noise of half the
/// torso's acuity (σ = 12.5 mm, van Erp 2005). The observer names actuator j with probability ∝ exp(-D_j² / 2σ²), where
/// D_j is the way along the surface from that middle to the actuator. If no actuator fires, the answer is "nothing".
/// Where the map lets several regions fire the same actuators, however strongly (`Firing`), the observer cannot tell
/// them apart.
class RegionObserver {
 public:
  explicit RegionObserver(std::size_t actuator_count);

  /// Adds a contact in `region` (from 0) under which no actuator fires.
  void add_unfelt(std::size_t region) { ++named_[region * (actuators_ + 1) + actuators_], ++contacts_; }
  /// Adds a contact under which only one actuator fires. The contact is felt at that actuator.
  void add_single(std::size_t region, std::size_t actuator) { ++single_[region * actuators_ + actuator], ++contacts_; }
  /// Adds a contact that is felt `offset_m` away from where it is (`felt_offset`).
  void add(std::size_t region, const ActuatorLayout& layout, const LocatedContact& contact, const glm::dvec2& offset_m);

  /// Returns the information that the observer gets about the regions of all contacts added, in bits. NaN if no contact
  /// was added.
  double bits(const ActuatorLayout& layout) const;

 private:
  std::size_t actuators_;
  std::size_t contacts_ = 0;
  std::vector<double> single_;  // region x actuator that fires alone
  std::vector<double> named_;   // region x (actuator that is named and, last, nothing)
  std::vector<Share> likely_;   // scratch of `add`
};

}  // namespace vestige
