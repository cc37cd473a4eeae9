#include "traces/mannequin/charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <stdexcept>

#include "traces/mannequin/flatten.hpp"
#include "traces/mannequin/shape.hpp"

namespace vestige::mannequin {

namespace {

/// `p` and `normal` belong to the left half.
Panel panel_of(const glm::dvec3& p, const glm::dvec3& normal) {
  const Landmarks& at = landmarks();
  if (on_arm(p)) {
    const glm::dvec3 axis = glm::normalize(at.wrist - at.elbow);
    const glm::dvec3 outer = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), axis));
    const glm::dvec3& from = glm::dot(p - at.elbow, axis) > 0 ? at.elbow : at.shoulder;
    // A hand is thin and curled, so the normal distinguishes its back from its palm.
    if (glm::dot(p - at.wrist, axis) > 0) return glm::dot(normal, outer) > 0 ? Panel::kHandBack : Panel::kPalm;
    return glm::dot(p - from, outer) > 0 ? Panel::kArmOuter : Panel::kArmInner;
  }
  const double neck_y = 1.50 + 0.35 * (at.neck.z - p.z);
  if (p.y > neck_y) return p.z > at.neck.z - 0.004 ? Panel::kHeadFront : Panel::kHeadBack;
  if (p.y > 0.800 + 0.75 * p.x) return p.z > -0.012 ? Panel::kTorsoFront : Panel::kTorsoBack;
  if (p.y < 0.014) return Panel::kSole;
  return p.z > -0.012 - 0.01 * (0.5 - p.y) ? Panel::kLegFront : Panel::kLegBack;
}

bool is_paired(Panel panel) {
  return panel >= Panel::kArmOuter;
}

using Label = std::pair<Panel, bool>;  // second: whether the panel is the right one of a pair

/// Returns the neighbour across each edge: edge i runs from corner i to corner i + 1.
std::vector<std::array<std::uint32_t, 3>> neighbours(const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> by_edge;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) by_edge[{surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]}] = t;
  std::vector<std::array<std::uint32_t, 3>> result(surface.triangles.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      result[t][static_cast<std::size_t>(i)] = by_edge.at({surface.triangles[t][(i + 1) % 3], surface.triangles[t][i]});
  return result;
}

std::vector<std::vector<std::uint32_t>> components(const std::vector<Label>& labels,
                                                   const std::vector<std::array<std::uint32_t, 3>>& adjacent) {
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<bool> seen(labels.size());
  for (std::uint32_t first = 0; first < labels.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    auto& component = result.emplace_back(1, first);
    for (std::size_t i = 0; i < component.size(); ++i)
      for (const std::uint32_t next : adjacent[component[i]])
        if (!seen[next] && labels[next] == labels[first]) {
          seen[next] = true;
          component.push_back(next);
        }
  }
  return result;
}

/// Returns every triangle's panel. Smooths borders by majority, and gives islands to the panel around them.
std::vector<Label> label(const Surface& surface, const std::vector<std::array<std::uint32_t, 3>>& adjacent) {
  std::vector<Label> labels;
  for (const glm::uvec3& t : surface.triangles) {
    const glm::dvec3& a = surface.positions_m[t.x];
    const glm::dvec3& b = surface.positions_m[t.y];
    const glm::dvec3& c = surface.positions_m[t.z];
    glm::dvec3 p = (a + b + c) / 3.0;
    glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const bool right = p.x < 0;
    if (right) {
      p.x = -p.x;
      normal.x = -normal.x;
    }
    const Panel panel = panel_of(p, normal);
    labels.emplace_back(panel, is_paired(panel) && right);
  }
  for (int round = 0; round < 4; ++round) {
    const std::vector<Label> before = labels;
    for (std::uint32_t t = 0; t < labels.size(); ++t) {
      const auto& [x, y, z] = adjacent[t];
      if (before[x] == before[y] || before[x] == before[z]) labels[t] = before[x];
      if (before[y] == before[z]) labels[t] = before[y];
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    std::map<Label, const std::vector<std::uint32_t>*> largest;
    const auto pieces = components(labels, adjacent);
    for (const auto& piece : pieces) {
      const auto*& best = largest[labels[piece.front()]];
      if (best == nullptr || piece.size() > best->size()) best = &piece;
    }
    for (const auto& piece : pieces) {
      if (&piece == largest[labels[piece.front()]]) continue;
      std::map<Label, int> around;
      for (const std::uint32_t t : piece)
        for (const std::uint32_t next : adjacent[t])
          if (labels[next] != labels[t]) ++around[labels[next]];
      const Label winner = std::ranges::max_element(around, {}, &std::pair<const Label, int>::second)->first;
      for (const std::uint32_t t : piece) labels[t] = winner;
      changed = true;
      break;
    }
  }
  // The right half's triangles follow the left half's, in the same order.
  const std::size_t half = labels.size() / 2;
  for (std::size_t t = 0; t < half; ++t) labels[half + t] = {labels[t].first, is_paired(labels[t].first)};
  return labels;
}

using Corners = std::array<glm::dvec2, 3>;

/// Whether the interiors of two triangles intersect, by separating axes.
bool overlap(const Corners& a, const Corners& b) {
  constexpr double kTouching_m = 1e-9;
  for (const Corners* side : {&a, &b})
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 edge = glm::normalize((*side)[(i + 1) % 3] - (*side)[i]);
      const glm::dvec2 axis(-edge.y, edge.x);
      const auto range = [&](const Corners& t) {
        return std::minmax({glm::dot(t[0], axis), glm::dot(t[1], axis), glm::dot(t[2], axis)});
      };
      const auto [low_a, high_a] = range(a);
      const auto [low_b, high_b] = range(b);
      if (high_a <= low_b + kTouching_m || high_b <= low_a + kTouching_m) return false;
    }
  return true;
}

/// Separates overlapping triangles. If a border turns inwards sharply, its two sides may overlap. Their corners then
/// move towards the middle of their neighbours until they do not.
void relax(const Surface& surface, const Chart& chart, std::vector<glm::dvec2>& flat) {
  std::map<std::uint32_t, std::size_t> local;
  for (std::size_t i = 0; i < chart.vertices.size(); ++i) local[chart.vertices[i]] = i;
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const std::uint32_t t : chart.triangles)
    triangles.push_back({local[surface.triangles[t].x], local[surface.triangles[t].y], local[surface.triangles[t].z]});
  const auto corners = [&](const std::array<std::size_t, 3>& t) { return Corners{flat[t[0]], flat[t[1]], flat[t[2]]}; };
  constexpr int kMostRounds = 400;
  constexpr double kStep = 0.1;
  for (int round = 0; round < kMostRounds; ++round) {
    std::set<std::size_t> doubled;
    for (const auto& t : triangles)
      for (const auto& other : triangles)
        if (&other != &t && overlap(corners(t), corners(other))) doubled.insert(t.begin(), t.end());
    if (doubled.empty()) return;
    std::vector<glm::dvec2> sums(flat.size(), glm::dvec2(0));
    std::vector<double> counts(flat.size(), 0);
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        sums[t[i]] += flat[t[(i + 1) % 3]] + flat[t[(i + 2) % 3]];
        counts[t[i]] += 2;
      }
    for (const std::size_t i : doubled) flat[i] = glm::mix(flat[i], sums[i] / counts[i], kStep);
  }
  throw std::runtime_error("charts overlap");
}

/// Turns a flat chart so that `up` on the body points up on average, and scales it to the body's area.
void set_upright(const Surface& surface, const Chart& chart, const glm::dvec3& up, std::vector<glm::dvec2>& flat) {
  std::map<std::uint32_t, std::size_t> local;
  for (std::size_t i = 0; i < chart.vertices.size(); ++i) local[chart.vertices[i]] = i;
  glm::dvec2 direction(0);
  double area = 0;
  double flat_area = 0;
  for (const std::uint32_t t : chart.triangles) {
    const glm::uvec3& corner = surface.triangles[t];
    const glm::dvec3 e1 = surface.positions_m[corner.y] - surface.positions_m[corner.x];
    const glm::dvec3 e2 = surface.positions_m[corner.z] - surface.positions_m[corner.x];
    const glm::dvec2 f1 = flat[local[corner.y]] - flat[local[corner.x]];
    const glm::dvec2 f2 = flat[local[corner.z]] - flat[local[corner.x]];
    // The component of `up` in the triangle's plane, as a combination of its edges.
    const double a = glm::dot(e1, e1), b = glm::dot(e1, e2), c = glm::dot(e2, e2);
    const double determinant = a * c - b * b;
    const double s = (c * glm::dot(up, e1) - b * glm::dot(up, e2)) / determinant;
    const double r = (a * glm::dot(up, e2) - b * glm::dot(up, e1)) / determinant;
    const double weight = std::sqrt(determinant) / 2;
    direction += weight * (s * f1 + r * f2);
    area += weight;
    flat_area += std::abs(f1.x * f2.y - f1.y * f2.x) / 2;
  }
  direction = glm::normalize(direction);
  const double scale = std::sqrt(area / flat_area);
  for (glm::dvec2& p : flat) p = scale * glm::dvec2(p.x * direction.y - p.y * direction.x, glm::dot(p, direction));
}

/// Packs boxes on shelves, tallest first. Sets the corner of each box, and returns the side of the square that holds
/// all.
double pack(const std::vector<glm::dvec2>& sizes, double width, double gap, std::vector<glm::dvec2>& corners) {
  std::vector<std::size_t> order(sizes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return sizes[a].y > sizes[b].y; });
  corners.assign(sizes.size(), glm::dvec2(0));
  struct Shelf {
    double y, height, x;
  };
  std::vector<Shelf> shelves;
  double used_width = 0;
  for (const std::size_t i : order) {
    auto shelf = std::ranges::find_if(shelves, [&](const Shelf& s) { return s.x + sizes[i].x + gap <= width; });
    if (shelf == shelves.end()) {
      const double y = shelves.empty() ? gap : shelves.back().y + shelves.back().height + gap;
      shelf = shelves.insert(shelves.end(), {y, sizes[i].y, gap});
    }
    corners[i] = {shelf->x, shelf->y};
    shelf->x += sizes[i].x + gap;
    used_width = std::max(used_width, shelf->x);
  }
  return std::max(used_width, shelves.back().y + shelves.back().height + gap);
}

glm::dvec3 up_of(Panel panel) {
  const Landmarks& at = landmarks();
  if (panel >= Panel::kArmOuter && panel <= Panel::kPalm) return glm::normalize(at.shoulder - at.wrist);
  if (panel == Panel::kSole) return {0, 0, 1};
  return {0, 1, 0};
}

/// Charts and their flat shapes: in metres, y up, upright, at any position.
struct Layout {
  std::vector<Chart> charts;
  std::vector<std::vector<glm::dvec2>> flats;
};

Layout lay_out(const Surface& surface, const std::vector<Label>& labels) {
  std::map<Label, Chart> by_label;
  for (std::uint32_t t = 0; t < labels.size(); ++t) {
    Chart& chart = by_label[labels[t]];
    chart.panel = labels[t].first;
    chart.right = labels[t].second;
    chart.triangles.push_back(t);
    for (int i = 0; i < 3; ++i) chart.vertices.push_back(surface.triangles[t][i]);
  }
  Layout layout;
  auto& [charts, flats] = layout;
  for (auto& [key, chart] : by_label) {
    std::ranges::sort(chart.vertices);
    chart.vertices.erase(std::unique(chart.vertices.begin(), chart.vertices.end()), chart.vertices.end());
    std::map<std::uint32_t, std::size_t> local;
    for (std::size_t i = 0; i < chart.vertices.size(); ++i) local[chart.vertices[i]] = i;
    std::vector<glm::dvec2> flat;
    if (chart.right) {
      // The chart is the mirror image of its left twin, which comes before it.
      const Chart& twin = charts.back();
      std::map<std::uint32_t, std::size_t> twin_local;
      for (std::size_t i = 0; i < twin.vertices.size(); ++i) twin_local[twin.vertices[i]] = i;
      for (const std::uint32_t v : chart.vertices) {
        const glm::dvec2 p = flats.back()[twin_local.at(surface.mirror[v])];
        flat.emplace_back(-p.x, p.y);
      }
    } else {
      flat = flatten(surface, chart);
      relax(surface, chart, flat);
      set_upright(surface, chart, up_of(chart.panel), flat);
      if (!is_paired(chart.panel)) {
        const std::vector<glm::dvec2> before = flat;
        for (std::size_t i = 0; i < flat.size(); ++i) {
          const glm::dvec2& twin = before[local.at(surface.mirror[chart.vertices[i]])];
          flat[i] = {(before[i].x - twin.x) / 2, (before[i].y + twin.y) / 2};
        }
      }
    }
    charts.push_back(chart);
    flats.push_back(flat);
  }
  return layout;
}

}  // namespace

std::vector<Chart> make_charts(const Surface& surface) {
  Layout layout = lay_out(surface, label(surface, neighbours(surface)));
  auto& [charts, flats] = layout;
  // Moves each chart into the square: to the origin, y down, then to its packed place.
  std::vector<glm::dvec2> sizes;
  for (auto& flat : flats) {
    glm::dvec2 low = flat.front();
    glm::dvec2 high = low;
    for (const glm::dvec2& p : flat) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    for (glm::dvec2& p : flat) p = {p.x - low.x, high.y - p.y};
    sizes.push_back(high - low);
  }
  constexpr double kGap_m = 0.02;
  double best = 1e9;
  std::vector<glm::dvec2> corners;
  double width = 0.8;
  while (width < 3) {
    std::vector<glm::dvec2> candidate;
    const double side = pack(sizes, width, kGap_m, candidate);
    if (side < best) {
      best = side;
      corners = candidate;
    }
    width += 0.01;
  }
  for (std::size_t i = 0; i < charts.size(); ++i)
    for (const glm::dvec2& p : flats[i]) charts[i].uv.emplace_back((p + corners[i]) / best);
  return charts;
}

}  // namespace vestige::mannequin
