#include "analysis/accuracy/true_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <set>
#include <thread>

#include "analysis/accuracy/touch_score.hpp"
#include "analysis/run/detection_run.hpp"
#include "detector/frame.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// The number of parts is fixed, so that the origin of a part (detector/CONTRACT.md, 2) does not depend on the machine.
constexpr std::uint64_t kParts = 16;

struct Part {
  std::vector<ContactEvent> events;
  std::uint64_t contacts = 0;
};

/// What the threads share.
struct Work {
  std::atomic<std::uint64_t> next_part = 0;
  std::atomic<std::uint64_t> frames_done = 0;
  std::atomic<bool> stopped = false;
};

/// Finds contacts in the frames first + 1 … last. Frame `first` only gives the start of the first segments.
Part find_in_part(const MovingScene& scene, double rate_hz, Detector& detector, std::uint64_t first, std::uint64_t last,
                  Work& work) {
  SceneSampler sampler(scene, rate_hz, first);
  DetectionRun detection(scene.avatar, scene.collider_ids, detector);
  ContactEventFinder finder;
  detection.begin(sampler.next());
  for (std::uint64_t index = first + 1; index <= last && !work.stopped; ++index) {
    detection.step(sampler.next());
    finder.add(detection.frame(), detection.row());
    ++work.frames_done;
  }
  const std::uint64_t contacts = finder.contacts();
  return {finder.take(), contacts};
}

}  // namespace

TrueContacts find_true_contacts(const MovingScene& scene, double rate_hz,
                                const std::function<std::unique_ptr<Detector>()>& make,
                                const std::function<bool(double)>& progress) {
  const std::uint64_t frames = last_frame_within(scene, rate_hz);
  std::vector<Part> parts(kParts);
  Work work;
  const auto find_parts = [&] {
    try {
      const std::unique_ptr<Detector> detector = make();
      for (std::uint64_t i = work.next_part++; i < kParts && !work.stopped; i = work.next_part++)
        parts[i] = find_in_part(scene, rate_hz, *detector, frames * i / kParts, frames * (i + 1) / kParts, work);
    } catch (...) {
      work.stopped = true;
      throw;
    }
  };
  std::vector<std::future<void>> threads;
  const unsigned count = std::max(1U, std::thread::hardware_concurrency());
  threads.reserve(count);
  for (unsigned i = 0; i < count; ++i) threads.push_back(std::async(std::launch::async, find_parts));
  for (std::future<void>& thread : threads)
    while (thread.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready)
      if (!progress(static_cast<double>(work.frames_done) / static_cast<double>(std::max<std::uint64_t>(1, frames))))
        work.stopped = true;
  for (std::future<void>& thread : threads) thread.get();

  TrueContacts truth;
  truth.rate_hz = rate_hz;
  if (work.stopped) return truth;
  std::vector<std::vector<ContactEvent>> events;
  events.reserve(parts.size());
  for (Part& part : parts) {
    truth.contacts += part.contacts;
    events.push_back(std::move(part.events));
  }
  truth.events = join_events(events);
  if (!scene.has_spheres()) return truth;
  truth.by_actuator = std::move(truth.events);
  truth.events = touches_of(truth.by_actuator, scene.is_sphere);
  return truth;
}

std::uint64_t check_true_contacts(const MovingScene& scene, const TruthCheck& check,
                                  const std::function<bool(double)>& progress) {
  const std::uint64_t last = last_frame_within(scene, check.rate_hz);
  std::mt19937_64 random(check.seed);
  std::set<std::uint64_t> drawn;
  while (drawn.size() < std::min(check.frames, last)) drawn.insert(1 + random() % last);
  const std::unique_ptr<Detector> fast = check.make();
  const std::unique_ptr<Detector> exact = check.make_exact();
  double done = 0;
  for (const std::uint64_t index : drawn) {
    if (!progress(done++ / static_cast<double>(drawn.size()))) return 0;
    const auto row_of = [&](Detector& detector) {
      SceneSampler sampler(scene, check.rate_hz, index - 1);
      DetectionRun detection(scene.avatar, scene.collider_ids, detector);
      detection.begin(sampler.next());
      detection.step(sampler.next());
      return detection.row();
    };
    const ContactRow found = row_of(*fast);
    const ContactRow expected = row_of(*exact);
    if (!std::ranges::equal(found, expected,
                            [](const Contact& a, const Contact& b) { return a.triangle == b.triangle && a.t == b.t; }))
      throw Error(
          "the truth",
          fmt::format("'{}' and '{}' differ in frame {} at {} Hz", fast->name(), exact->name(), index, check.rate_hz),
          "this is a bug in Vestige: report it with this command");
  }
  return drawn.size();
}

}  // namespace vestige
