#pragma once

#include <span>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Finds room for labels between what is drawn already.
class FreePlace {
 public:
  /// Labels stay inside `page`.
  explicit FreePlace(const Box& page) : page_(page) {}

  void take(const Box& box) { taken_.push_back(box); }
  void take(std::span<const Place> line);

  bool is_free(const Box& box) const;
  /// The first of `candidates` that is free, else the first of all (a label on a line is better than none). Taken then.
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

/// Moves heights as little as needed so that each is `gap` above the one before it and all lie within [low, high]
/// (where there is room at all). The order of `heights` by value is kept.
void spread(std::span<double> heights, double gap, double low, double high);

}  // namespace vestige::plot
