#include "analysis/frequency/detector_memory.hpp"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>

#include "analysis/run/detection_run.hpp"

namespace vestige {

namespace {

/// Returns the private memory of this process that is in RAM, less what malloc keeps for later. Asking malloc alone
/// would miss Embree, which maps memory itself.
std::optional<std::uint64_t> anonymous_bytes() {
  ::malloc_trim(0);
  std::ifstream file("/proc/self/smaps_rollup");
  std::string word;
  while (file >> word && word != "Anonymous:") {
  }
  std::uint64_t kibibytes = 0;
  if (!(file >> kibibytes)) return {};
  return 1024 * kibibytes;
}

std::unique_ptr<Detector> used_detector(const Contestant& contestant, const SweptPerson& person,
                                        const SweepScene& scene) {
  std::unique_ptr<Detector> detector = contestant.make(person.avatar, person.map, contestant.planes);
  DetectionRun detection(person.avatar, scene.drawn.front().front(), *detector);
  for (const TraceFrame& frame : scene.places.front()) detection.step(frame);
  return detector;
}

}  // namespace

std::optional<std::uint64_t> detector_memory_bytes(const Contestant& contestant, const SweptPerson& person,
                                                   const SweepScene& scene) {
  // The first makes drivers free what earlier detectors left.
  const std::unique_ptr<Detector> first = used_detector(contestant, person, scene);
  const std::optional<std::uint64_t> before = anonymous_bytes();
  const std::unique_ptr<Detector> second = used_detector(contestant, person, scene);
  const std::optional<std::uint64_t> after = anonymous_bytes();
  if (!before || !after) return {};
  return std::max(*after, *before) - *before;
}

}  // namespace vestige
