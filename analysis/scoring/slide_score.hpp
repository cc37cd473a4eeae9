#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace vestige {

/// Which contacts follow each other in a slide: those of one collider, each within 0.1 s and 50 mm of the one before.
/// The whole is a slide where it gets 50 mm away from its beginning, in five contacts or more.
class SlideFinder {
 public:
  enum class Step : std::uint8_t { kBegins, kGoesOn };

  /// Whether a contact does not go on with those before, if there were any.
  bool breaks(std::uint32_t column, double time_s, const glm::dvec3& position_m) const;
  /// The next contact of a collider, at an instant, on the body at rest. Times ascend for each collider.
  Step add(std::uint32_t column, double time_s, const glm::dvec3& position_m);
  /// Whether what has been going on for a collider is a slide by now.
  bool is_slide(std::uint32_t column) const;
  std::size_t columns() const { return chains_.size(); }
  /// How far it went so far.
  double way_m(std::uint32_t column) const { return chains_[column].way_m; }
  /// From the contact before to the last one.
  const glm::dvec3& step_m(std::uint32_t column) const { return chains_[column].step_m; }

 private:
  struct Chain {
    glm::dvec3 start_m = glm::dvec3(0);
    glm::dvec3 last_m = glm::dvec3(0);
    glm::dvec3 step_m = glm::dvec3(0);
    double last_s = 0;
    double way_m = 0;
    double reach_m = 0;  ///< farthest from the start
    std::size_t contacts = 0;
  };
  std::vector<Chain> chains_;  // by column
};

/// How evenly one slide is felt.
class SlideSmoothness {
 public:
  /// The next contact: Σ A_i² of what it fires; where it is felt (Σ A_i x_i / Σ A_i; nothing where nothing fires); and
  /// the collider's step since the contact before.
  void add(double energy, const glm::dvec3* felt_at_m, const glm::dvec3& step_m);

  std::size_t contacts() const { return contacts_; }
  /// (max - min) / mean of the energies: 0 for a phantom of even energy; 0.75 for a linear one that goes evenly from
  /// one actuator to the next, whose least energy is 0.5. NaN where nothing was ever felt.
  double ripple() const;
  /// The longest way that the felt place went between two contacts, in a straight line.
  double largest_jump_m() const { return largest_jump_m_; }
  /// How often it went against the collider.
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

/// Slides of one law, taken together.
class SlideScore {
 public:
  /// A slide that has ended, and how far its collider went.
  void add(const SlideSmoothness& slide, double way_m);

  std::size_t slides() const { return slides_; }
  double ripple() const;           ///< mean over slides that were felt; NaN for none
  double largest_jump_m() const;   ///< likewise
  double reversals_per_m() const;  ///< of those together, over their way

 private:
  std::size_t slides_ = 0;
  std::size_t felt_ = 0;  ///< slides, of which alone the rest tells
  double ripple_sum_ = 0;
  double jump_sum_m_ = 0;
  double way_m_ = 0;
  std::size_t reversals_ = 0;
};

}  // namespace vestige
