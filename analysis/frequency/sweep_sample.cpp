#include "analysis/frequency/sweep_sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"

namespace vestige {

namespace {

constexpr std::uint64_t kTriedShifts = 64;

/// Returns the number of contacts in every frame of the trace. Empty if `goes_on` said no.
std::vector<std::uint32_t> count_contacts(TraceReader& trace, std::span<const DetectedPerson> people,
                                          const std::function<bool()>& goes_on) {
  constexpr std::size_t kFramesBetweenQuestions = 256;
  DetectionRun detection(people, trace.collider_ids());
  std::vector<std::uint32_t> contacts;
  TraceFrame frame;
  trace.rewind();
  while (trace.next(frame)) {
    if (contacts.size() % kFramesBetweenQuestions == 0 && !goes_on()) return {};
    detection.step(frame);
    std::uint32_t& count = contacts.emplace_back(0);
    for (std::size_t i = 0; i < people.size(); ++i) count += static_cast<std::uint32_t>(detection.row(i).hits());
  }
  return contacts;
}

/// Frames of the trace at equal distances, each of which begins a place.
struct Grid {
  std::uint64_t first = 0;
  std::uint64_t distance = 0;
  std::uint64_t count = 0;
  std::uint64_t length = 0;  ///< of each place, with the frame before it

  std::uint64_t start(std::uint64_t i) const { return first + i * distance; }
};

FrameContacts describe(std::span<const std::uint32_t> contacts) {
  const auto frames = static_cast<double>(contacts.size());
  double sum = 0;
  for (const std::uint32_t count : contacts) sum += count;
  return {static_cast<double>(std::ranges::count(contacts, 0U)) / frames, sum / frames};
}

FrameContacts describe(const Grid& grid, std::span<const std::uint32_t> contacts) {
  std::vector<std::uint32_t> sampled;
  sampled.reserve(grid.count * grid.length);
  for (std::uint64_t i = 0; i < grid.count; ++i) {
    const auto place = contacts.subspan(grid.start(i) + 1, grid.length - 1);
    sampled.insert(sampled.end(), place.begin(), place.end());
  }
  return describe(sampled);
}

/// Returns how far a sample is from the trace: 0 if contacts and empty frames are as frequent.
double distance_between(const FrameContacts& sampled, const FrameContacts& trace) {
  if (trace.contacts_per_frame == 0) return 0;
  const double contacts = std::abs(sampled.contacts_per_frame - trace.contacts_per_frame) / trace.contacts_per_frame;
  return contacts + std::abs(sampled.empty_share - trace.empty_share);
}

Grid best_grid(Grid grid, std::span<const std::uint32_t> contacts, const FrameContacts& trace) {
  grid.distance = contacts.size() / grid.count;
  const std::uint64_t room = contacts.size() - (grid.count - 1) * grid.distance - grid.length;
  double least = std::numeric_limits<double>::infinity();
  Grid best = grid;
  for (std::uint64_t shift = 0; shift < kTriedShifts; ++shift) {
    grid.first = room * shift / (kTriedShifts - 1);
    const double distance = distance_between(describe(grid, contacts), trace);
    if (distance >= least) continue;
    least = distance;
    best = grid;
  }
  return best;
}

void add(const TraceFrame& frame, Sha256& sha) {
  const auto add_value = [&sha](const auto& value) { sha.update(std::as_bytes(std::span(&value, 1))); };
  add_value(frame.time_ns);
  for (const Pose& pose : frame.poses) {
    add_value(pose.origin_m);
    for (const NodeLocal& node : pose.nodes) {
      add_value(node.translation);
      add_value(node.rotation);
      add_value(node.scale);
    }
  }
  for (const auto& collider : frame.colliders) {
    add_value(collider.id);
    add_value(collider.position_m);
  }
}

std::string sha256_of(const std::vector<Place>& places) {
  Sha256 sha;
  for (const Place& place : places)
    for (const TraceFrame& frame : place) add(frame, sha);
  return sha.hex();
}

}  // namespace

SweepSample sample_places(TraceReader& trace, std::span<const DetectedPerson> people, std::uint32_t places,
                          std::uint32_t place_frames, const std::function<bool()>& goes_on) {
  const std::uint64_t frames = trace.frame_count();
  if (frames < 2)
    throw Error("the trace", fmt::format("has {} frame{}; at least two are needed", frames, frames == 1 ? "" : "s"),
                "record a longer trace");
  const std::vector<std::uint32_t> contacts = count_contacts(trace, people, goes_on);
  SweepSample sample;
  if (contacts.size() < 2) return sample;
  sample.trace = describe(std::span(contacts).subspan(1));
  Grid grid;
  grid.length = std::min<std::uint64_t>(std::uint64_t{place_frames} + 1, contacts.size());
  grid.count = std::clamp<std::uint64_t>(contacts.size() / grid.length, 1, places);
  grid = best_grid(grid, contacts, sample.trace);
  sample.sampled = describe(grid, contacts);
  sample.places.resize(grid.count);
  TraceFrame frame;
  trace.rewind();
  for (std::uint64_t number = 0; trace.next(frame); ++number)
    for (std::uint64_t i = 0; i < grid.count; ++i)
      if (number >= grid.start(i) && number < grid.start(i) + grid.length) sample.places[i].push_back(frame);
  sample.sha256 = sha256_of(sample.places);
  return sample;
}

std::vector<std::vector<std::uint32_t>> draw_colliders(std::span<const std::uint32_t> ids, std::uint32_t count,
                                                       std::size_t places, std::uint64_t seed) {
  std::seed_seq seeds = {seed, seed >> 32U, std::uint64_t{count}};
  std::mt19937_64 random(seeds);
  std::vector<std::uint32_t> shuffled(ids.begin(), ids.end());
  std::ranges::shuffle(shuffled, random);
  std::vector<std::vector<std::uint32_t>> drawn(places);
  std::size_t next = 0;
  for (auto& place : drawn) {
    place.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) place.push_back(shuffled[next++ % shuffled.size()]);
    std::ranges::sort(place);
  }
  return drawn;
}

}  // namespace vestige
