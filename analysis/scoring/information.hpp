#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"

namespace vestige {

/// IT = Σ p_ij log2(p_ij / (p_i p_j)), in bits, of stimuli i (rows) and responses j (columns) that were counted so
/// often (Tan, Reed & Durlach 2010, "Optimum information transfer rates for communication through haptic and other
/// sensory modalities"). n stimuli, equally frequent, each with a response of its own: log2 n. 0 for no counts. The
/// estimate from few counts is too high by about (rows - 1)(columns - 1) / (2 ln 2 counts) (Miller 1955).
double transmitted_bits(std::span<const double> counts, std::size_t columns);

/// What a noisy observer can tell of where contacts are, in a closed form: a model.
///
/// A stimulus is the region of a contact: its actuator by the map, else the nearest one. The observer feels it in the
/// middle of what fires (`FeltOffset::amplitude_m`), off by Gaussian noise of half the torso's acuity (σ = 12.5 mm, van
/// Erp 2005), and names actuator j with probability ∝ exp(-D_j² / 2σ²), D_j being the way along the surface from that
/// middle to the actuator. Where nothing fires, the answer is "nothing".
class RegionObserver {
 public:
  explicit RegionObserver(std::size_t actuator_count);

  /// A contact in `region`, from 0, under which nothing fires.
  void add_unfelt(std::size_t region) { ++named_[region * (actuators_ + 1) + actuators_], ++contacts_; }
  /// One under which one actuator alone fires: it is felt there.
  void add_single(std::size_t region, std::size_t actuator) { ++single_[region * actuators_ + actuator], ++contacts_; }
  /// One that is felt `offset_m` away from where it is (`felt_offset`).
  void add(std::size_t region, const ActuatorLayout& layout, const LocatedContact& contact, const glm::dvec2& offset_m);

  /// What it learns of the regions of all contacts added, bits. NaN for none.
  double bits(const ActuatorLayout& layout) const;

 private:
  std::size_t actuators_;
  std::size_t contacts_ = 0;
  std::vector<double> single_;  // region x actuator that fires alone
  std::vector<double> named_;   // region x (actuator that is named and, last, nothing)
  std::vector<Share> likely_;   // of one contact
};

}  // namespace vestige
