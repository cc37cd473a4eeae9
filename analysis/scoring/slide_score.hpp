#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace vestige {

/// Finds slides. Contacts of one collider form a chain if each is within 0.1 s and 50 mm of the one before. A chain is
/// a slide once it reaches 50 mm from its beginning with five contacts or more.
class SlideFinder {
 public:
  enum class Step : std::uint8_t { kBegins, kGoesOn };

  /// Returns whether a contact breaks the chain of its collider. A collider without contacts so far has no chain to
  /// break.
  bool breaks(std::uint32_t column, double time_s, const glm::dvec3& position_m) const;
  /// Adds the next contact of a collider, with its instant and its position on the body at rest. Times must ascend for
  /// each collider.
  Step add(std::uint32_t column, double time_s, const glm::dvec3& position_m);
  /// Returns whether the collider's current chain is a slide by now.
  bool is_slide(std::uint32_t column) const;
  std::size_t columns() const { return chains_.size(); }
  /// Returns the length of the collider's path in the current chain so far.
  double way_m(std::uint32_t column) const { return chains_[column].way_m; }
  /// Returns the step from the previous contact to the last one.
  const glm::dvec3& step_m(std::uint32_t column) const { return chains_[column].step_m; }

 private:
  struct Chain {
    glm::dvec3 start_m = glm::dvec3(0);
    glm::dvec3 last_m = glm::dvec3(0);
    glm::dvec3 step_m = glm::dvec3(0);
    double last_s = 0;
    double way_m = 0;
    double reach_m = 0;  ///< largest distance from the start
    std::size_t contacts = 0;
  };
  std::vector<Chain> chains_;  // by column
};

/// How evenly one slide is felt.
class SlideSmoothness {
 public:
  /// Adds the next contact of the slide. `energy` is Σ A_i² of the actuators that it fires. `felt_at_m` is where it is
  /// felt, Σ A_i x_i / Σ A_i, or null if no actuator fires. `step_m` is the collider's step since the previous contact.
  void add(double energy, const glm::dvec3* felt_at_m, const glm::dvec3& step_m);

  std::size_t contacts() const { return contacts_; }
  /// Returns (max - min) / mean of the energies. It is 0 for a phantom of even energy. It is 0.75 for a linear phantom
  /// that moves evenly from one actuator to the next, whose least energy is 0.5. Returns NaN if nothing was ever felt.
  double ripple() const;
  /// Returns the longest straight-line distance that the felt place moved between two contacts.
  double largest_jump_m() const { return largest_jump_m_; }
  /// Returns how often the felt place moved against the collider.
  std::size_t reversals() const { return reversals_; }

 private:
  std::size_t contacts_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = 0;
  double sum_ = 0;
  bool was_felt_ = false;
  glm::dvec3 felt_at_m_ = glm::dvec3(0);
  double largest_jump_m_ = 0;
  std::size_t reversals_ = 0;
};

/// The slides of one law, taken together.
class SlideScore {
 public:
  /// Adds a slide that has ended. `way_m` is the length of its collider's path.
  void add(const SlideSmoothness& slide, double way_m);

  std::size_t slides() const { return slides_; }
  double ripple() const;           ///< mean over felt slides; NaN if there are none
  double largest_jump_m() const;   ///< mean over felt slides; NaN if there are none
  double reversals_per_m() const;  ///< reversals of all felt slides over their path length

 private:
  std::size_t slides_ = 0;
  std::size_t felt_ = 0;  ///< felt slides; the members below cover only these
  double ripple_sum_ = 0;
  double jump_sum_m_ = 0;
  double way_m_ = 0;
  std::size_t reversals_ = 0;
};

}  // namespace vestige
