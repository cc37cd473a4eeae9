#include "analysis/plot/canvas/free_place.hpp"

#include <algorithm>
#include <numeric>

namespace vestige::plot {

namespace {

bool overlap(const Box& one, const Box& other) {
  return one.left_pt < other.right_pt && other.left_pt < one.right_pt && one.bottom_pt < other.top_pt &&
         other.bottom_pt < one.top_pt;
}

/// Clips the segment by the box's four sides in turn (Liang and Barsky, 1984). Returns whether a part remains.
bool crosses(const Box& box, Place from, Place to) {
  double begin = 0;
  double end = 1;
  const auto cut = [&](double start, double change, double low, double high) {
    if (change == 0) return start >= low && start <= high;
    double enter = (low - start) / change;
    double leave = (high - start) / change;
    if (enter > leave) std::swap(enter, leave);
    begin = std::max(begin, enter);
    end = std::min(end, leave);
    return begin <= end;
  };
  return cut(from.x_pt, to.x_pt - from.x_pt, box.left_pt, box.right_pt) &&
         cut(from.y_pt, to.y_pt - from.y_pt, box.bottom_pt, box.top_pt);
}

}  // namespace

void FreePlace::take(std::span<const Place> line) {
  for (std::size_t i = 1; i < line.size(); ++i) segments_.push_back({line[i - 1], line[i]});
}

bool FreePlace::is_free(const Box& box) const {
  if (box.left_pt < page_.left_pt || box.right_pt > page_.right_pt || box.bottom_pt < page_.bottom_pt ||
      box.top_pt > page_.top_pt)
    return false;
  return std::ranges::none_of(taken_, [&](const Box& taken) { return overlap(taken, box); }) &&
         std::ranges::none_of(segments_, [&](const Segment& line) { return crosses(box, line.from, line.to); });
}

Box FreePlace::take_first(std::span<const Box> candidates) {
  const auto found = std::ranges::find_if(candidates, [this](const Box& box) { return is_free(box); });
  const Box box = found == candidates.end() ? candidates.front() : *found;
  take(box);
  return box;
}

void spread(std::span<double> heights, double gap, double low, double high) {
  std::vector<std::size_t> order(heights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t index) { return heights[index]; });
  // Labels that would touch form a group, placed at the mean of its members' wishes.
  struct Group {
    double first;
    int count;
  };
  std::vector<Group> groups;
  const auto settle = [&](Group group) {
    const double room = (group.count - 1) * gap;
    group.first = std::max(low, std::min(group.first, high - room));
    return group;
  };
  for (const std::size_t index : order) {
    groups.push_back(settle({heights[index], 1}));
    while (groups.size() > 1) {
      const Group upper = groups.back();
      const Group lower = groups[groups.size() - 2];
      if (lower.first + lower.count * gap <= upper.first) break;
      const double wish =
          (lower.first * lower.count + (upper.first - lower.count * gap) * upper.count) / (lower.count + upper.count);
      groups.pop_back();
      groups.back() = settle({wish, lower.count + upper.count});
    }
  }
  auto next = order.begin();
  for (const Group& group : groups)
    for (int place = 0; place < group.count; ++place) heights[*next++] = group.first + place * gap;
}

}  // namespace vestige::plot
