// Run by hand: `geometry_agreement PAIRS [SEED]`. Adversarial pairs through `geometry` and `cpu`, every method, as many
// pairs each; prints what meets, what was captured and what differs, and fails if anything does.

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <string>

#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/adversarial_pairs.hpp"

namespace vestige {
namespace {

constexpr std::size_t kTriangles = 50;
constexpr std::size_t kSegments = 40;

bool same(const Contact& a, const Contact& b) {
  return a.triangle == b.triangle && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t) &&
         a.actuator == b.actuator && a.side == b.side;
}

/// Returns whether nothing differed.
bool compare(Method method, std::uint64_t pairs, std::uint64_t seed) {
  const Avatar avatar = loose_triangles(kTriangles);
  const ActuatorMap map;
  const DetectorOptions options = {Surface::kAll, PlaneSet::all(), method};
  const auto geometry = make_geometry_detector(make_gl_context(ContextKind::kAuto, -1), avatar, map, options);
  const auto cpu = make_cpu_detector(avatar, map, options);
  test::AdversarialSource source(seed);
  ContactRow row;
  ContactRow expected;
  std::uint64_t done = 0;
  std::uint64_t captured = 0;
  std::uint64_t meeting = 0;
  std::uint64_t missed = 0;
  std::uint64_t differing = 0;
  while (done < pairs) {
    const test::AdversarialPairs drawn = source.draw(kTriangles, kSegments);
    const Frame frame = loose_frame(drawn.before, drawn.now, drawn.segments);
    const DetectorWork work = geometry->detect(frame, row);
    const DetectorWork expected_work = cpu->detect(frame, expected);
    done += kTriangles * kSegments;
    captured += work.pairs_captured;
    meeting += expected_work.pairs_meeting;
    missed += expected_work.pairs_meeting - work.pairs_meeting;
    for (std::size_t i = 0; i < row.size(); ++i)
      if (!same(row[i], expected[i])) ++differing;
  }
  fmt::print("{:<8} {}: {} pairs, {} meet, {} captured, {} missed, {} winners differ\n", name_of(method),
             geometry->gl_info().renderer, done, meeting, captured, missed, differing);
  return missed == 0 && differing == 0;
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  const std::uint64_t pairs = argc > 1 ? std::stoull(argv[1]) : 10'000'000;
  const std::uint64_t seed = argc > 2 ? std::stoull(argv[2]) : 2;
  bool same = true;
  for (const vestige::Method method : {vestige::Method::kStatic, vestige::Method::kCarried, vestige::Method::kCcd})
    same = vestige::compare(method, pairs, seed) && same;
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}
