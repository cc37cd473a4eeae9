#pragma once

#include <span>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Finds room for labels between what is already drawn.
class FreePlace {
 public:
  /// Labels stay inside `page`.
  explicit FreePlace(const Box& page) : page_(page) {}

  void take(const Box& box) { taken_.push_back(box); }
  void take(std::span<const Place> line);

  bool is_free(const Box& box) const;
  /// Returns the first free box of `candidates`, otherwise the first of all: a label on a line is better than no label.
  /// The returned box is then taken.
  Box take_first(std::span<const Box> candidates);

 private:
  struct Segment {
    Place from;
    Place to;
  };

  Box page_;
  std::vector<Box> taken_;
  std::vector<Segment> segments_;
};

/// Moves heights as little as needed, so that each is at least `gap` above the one before it and all lie within [low,
/// high] (if there is enough room). Keeps the order of `heights` by value.
void spread(std::span<double> heights, double gap, double low, double high);

}  // namespace vestige::plot
