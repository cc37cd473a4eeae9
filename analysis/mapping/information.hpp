#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "detector/actuator_layout.hpp"
#include "detector/held_amplitudes.hpp"

namespace vestige {

/// IT = Σ p_ij log2(p_ij / (p_i p_j)), in bits, of stimuli i (rows) and responses j (columns) that were counted so
/// often (Tan, Reed & Durlach 2010, "Optimum information transfer rates for communication through haptic and other
/// sensory modalities"). n stimuli, equally frequent, each with a response of its own: log2 n. 0 for no counts. The
/// estimate from few counts is too high by about (rows - 1)(columns - 1) / (2 ln 2 counts) (Miller 1955).
double transmitted_bits(std::span<const double> counts, std::size_t columns);

/// What a noisy observer can tell of where contacts are, in a closed form: a model.
///
/// A stimulus is the region of a contact: its actuator by the map, else the nearest one. The observer attends to one of
/// the actuators that fire, i with probability A_i² / Σ A²; feels it at a place that is off by Gaussian noise of half
/// the torso's acuity (12.5 mm, van Erp 2005); and names the actuator j with probability ∝ exp(-d_ij² / 2σ²), d_ij
/// being the distance along the surface. Where nothing fires, the answer is "nothing".
class RegionObserver {
 public:
  explicit RegionObserver(std::size_t actuator_count);

  /// A contact in `region`, from 0, and what fires. Weights need not be normalised.
  void add(std::size_t region, std::span<const Share> shares);

  /// What it learns of the regions of all contacts added, bits. NaN for none.
  double bits(const ActuatorLayout& layout) const;

 private:
  std::size_t actuators_;
  std::size_t contacts_ = 0;
  std::vector<double> attended_;  // region x (actuators and, last, nothing)
};

}  // namespace vestige
