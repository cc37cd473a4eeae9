#include "detector/approximate/union_surface.hpp"

#include <algorithm>

namespace vestige {

std::optional<Crossing> first_crossing(std::span<const Chord> chords) {
  // From inside: the end of the run of overlapping chords that begins at the start.
  std::optional<std::size_t> within;
  double end = 0;
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t i = 0; i < chords.size(); ++i) {
      if (chords[i].misses() || chords[i].enter > end || !(chords[i].leave > end)) continue;
      end = chords[i].leave;
      within = i;
      grows = true;
    }
  }
  if (within) return end <= 1 ? std::optional(Crossing{end, *within, -1}) : std::nullopt;

  std::optional<Crossing> first;
  for (std::size_t i = 0; i < chords.size(); ++i)
    if (!chords[i].misses() && chords[i].enter > 0 && chords[i].enter <= 1 && (!first || chords[i].enter < first->t))
      first = Crossing{chords[i].enter, i, 1};
  return first;
}

std::optional<double> first_touch(std::span<const Chord> grown, std::span<const Chord> shrunk) {
  const auto touches = [&](double t) {
    return t >= 0 && t <= 1 &&
           std::ranges::any_of(grown, [t](const Chord& chord) { return chord.enter <= t && t <= chord.leave; }) &&
           std::ranges::none_of(shrunk, [t](const Chord& chord) { return chord.enter < t && t < chord.leave; });
  };
  if (touches(0)) return 0;
  std::optional<double> first;
  const auto offer = [&](const Chord& chord, double t) {
    if (!chord.misses() && (!first || t < *first) && touches(t)) first = t;
  };
  for (const Chord& chord : grown) offer(chord, chord.enter);
  for (const Chord& chord : shrunk) offer(chord, chord.leave);
  return first;
}

}  // namespace vestige
