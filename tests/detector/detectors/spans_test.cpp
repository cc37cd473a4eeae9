// Frames that are detected in spans, several of them in flight, and one by one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/proofs/in_flight.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/gl/limited_context.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;
using ::testing::HasSubstr;

using MakeProver = decltype(&make_compute_detector);

/// Every number of a frame's work.
std::array<std::uint64_t, sizeof(DetectorWork) / sizeof(std::uint64_t)> numbers(const DetectorWork& work) {
  std::array<std::uint64_t, sizeof(DetectorWork) / sizeof(std::uint64_t)> all;
  std::memcpy(all.data(), &work, sizeof work);
  return all;
}

struct SpanResults {
  explicit SpanResults(std::size_t frames) : rows(frames), work(frames) {}
  std::vector<ContactRow> rows;
  std::vector<DetectorWork> work;
};

std::vector<DetectorFrame> frames_of(std::string_view scenario, Method method, Skip skip, float radius_m) {
  const int count = skip == Skip::kOn ? 45 : 12;
  constexpr double kRate_hz = 250;
  const std::uint32_t colliders = find_scenario(scenario)->default_count;
  std::vector<std::uint32_t> ids(colliders);
  std::iota(ids.begin(), ids.end(), 0U);
  FrameBuilder builder(builtin_avatar(), ids, method, 0, skip);
  std::vector<DetectorFrame> frames;
  for (TraceFrame& frame : test::scene(scenario, builtin_avatar(), colliders, count, kRate_hz)) {
    for (ColliderSample& collider : frame.colliders) collider.radius_m = collider.id % 2 == 0 ? radius_m : 0;
    frames.push_back(builder.next(frame));
  }
  return frames;
}

SpanResults one_by_one(Detector& detector, std::span<const DetectorFrame> frames) {
  SpanResults results(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) results.work[i] = detector.detect(frames[i], results.rows[i]);
  return results;
}

SpanResults in_spans(Detector& detector, std::span<const DetectorFrame> frames, std::size_t length) {
  SpanResults results(frames.size());
  for (std::size_t first = 0; first < frames.size(); first += length) {
    const std::size_t count = std::min(length, frames.size() - first);
    detector.detect_all(frames.subspan(first, count), std::span(results.rows).subspan(first, count),
                        std::span(results.work).subspan(first, count));
  }
  return results;
}

std::string hash_of(std::span<const ContactRow> rows) {
  TextureHash hash;
  for (const ContactRow& row : rows) hash.add(row);
  return hash.hex();
}

void expect_equal(const SpanResults& expected, const SpanResults& found) {
  EXPECT_EQ(hash_of(expected.rows), hash_of(found.rows));
  for (std::size_t i = 0; i < expected.work.size(); ++i)
    EXPECT_EQ(numbers(expected.work[i]), numbers(found.work[i])) << "frame " << i;
}

/// A detector with shaders, and what they do.
struct Proving {
  DetectorOptions with(DetectorOptions options) const {
    options.as_on_gpu = as_on_gpu;
    options.culling = culling;
    return options;
  }

  MakeProver make;
  bool as_on_gpu = false;
  Culling culling = Culling::kCpu;
};

std::vector<Proving> ways_of_proving(Skip skip) {
  std::vector<Proving> all;
  for (const MakeProver make : {make_geometry_detector, make_compute_detector})
    for (const bool as_on_gpu : {false, true}) all.push_back({make, as_on_gpu});
  if (skip == Skip::kOn) all.push_back({make_compute_detector, true, Culling::kGpu});
  return all;
}

using SpanQuestion = std::tuple<std::string_view, Method, float, Skip>;

class Spans : public ::testing::TestWithParam<SpanQuestion> {};

TEST_P(Spans, HaveTheBitsAndTheWorkOfSingleFramesWhateverTheirLength) {
  const auto [scenario, method, radius_m, skip] = GetParam();
  const std::vector<DetectorFrame> frames = frames_of(scenario, method, skip, radius_m);
  const std::shared_ptr<GlContext> context = test::make_context();
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, method, skip};
  const SpanResults on_cpu = one_by_one(*make_cpu_detector(builtin_avatar(), builtin_map(), options), frames);
  for (const Proving& proving : ways_of_proving(skip)) {
    const auto make = [&] { return proving.make(context, builtin_avatar(), builtin_map(), proving.with(options)); };
    const auto single = make();
    const SpanResults expected = one_by_one(*single, frames);
    EXPECT_EQ(hash_of(expected.rows), hash_of(on_cpu.rows));
    EXPECT_TRUE(std::ranges::any_of(expected.rows, [](const ContactRow& row) { return row.hits() > 0; }));
    for (const std::size_t length : {std::size_t{2}, kMostInFlight, frames.size()}) {
      SCOPED_TRACE(testing::Message() << single->name() << " in spans of " << length
                                      << ", as on a GPU: " << proving.as_on_gpu);
      expect_equal(expected, in_spans(*make(), frames, length));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Spans,
                         ::testing::Combine(::testing::Values("swarm", "hug", "slide"),
                                            ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                                            ::testing::Values(0.0F, 0.02F), ::testing::Values(Skip::kOff, Skip::kOn)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" + name_of(std::get<1>(test.param)) +
                                  (std::get<2>(test.param) > 0 ? "_spheres" : "") +
                                  (std::get<3>(test.param) == Skip::kOn ? "_skipping" : "");
                         });

TEST(SpansOfADetectorWithoutAGpu, HaveTheBitsAndTheWorkOfSingleFrames) {
  const std::vector<DetectorFrame> frames = frames_of("hug", Method::kCcd, Skip::kOn, 0);
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, Method::kCcd, Skip::kOn};
  const SpanResults expected = one_by_one(*make_cpu_detector(builtin_avatar(), builtin_map(), options), frames);
  expect_equal(expected, in_spans(*make_cpu_detector(builtin_avatar(), builtin_map(), options), frames, 7));
}

TEST(SpansOfSeveralDetectors, MayTakeTurnsInOneContext) {
  const std::vector<DetectorFrame> frames = frames_of("hug", Method::kStatic, Skip::kOn, 0);
  const std::shared_ptr<GlContext> context = test::make_context();
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, Method::kStatic, Skip::kOn};
  const auto geometry = make_geometry_detector(context, builtin_avatar(), builtin_map(), options);
  const auto compute = make_compute_detector(context, builtin_avatar(), builtin_map(), options);
  const SpanResults expected =
      one_by_one(*make_compute_detector(context, builtin_avatar(), builtin_map(), options), frames);
  for (int turn = 0; turn < 2; ++turn)
    for (Detector* const detector : {geometry.get(), compute.get()})
      EXPECT_EQ(hash_of(in_spans(*detector, frames, 5).rows), hash_of(expected.rows)) << detector->name();
}

TEST(SpanWithAFrameThatTheDriverLoses, IsRefusedAndLeavesTheDetectorUsable) {
  const std::vector<DetectorFrame> frames = frames_of("swarm", Method::kStatic, Skip::kOn, 0);
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, Method::kStatic, Skip::kOn};
  for (const Proving& proving : ways_of_proving(Skip::kOn)) {
    const auto detector =
        proving.make(test::LimitedContext::make({}), builtin_avatar(), builtin_map(), proving.with(options));
    const SpanResults expected = one_by_one(*detector, frames);
    for (const int lost : {0, 1, 3, 12}) {
      test::LimitedContext::lose_work_after(lost);
      EXPECT_THAT(test::message_of([&] { in_spans(*detector, frames, frames.size()); }),
                  HasSubstr("ended a shader before its work was done"));
      expect_equal(expected, in_spans(*detector, frames, frames.size()));
    }
  }
}

}  // namespace
}  // namespace vestige
