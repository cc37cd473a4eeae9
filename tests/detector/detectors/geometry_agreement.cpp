// Run by hand, and by the bundle's `measure`: geometry_agreement [--method static|carried|ccd] [--pairs N] [--seed K]
// [--context auto|egl|osmesa] [--device K] [--skip]. Adversarial pairs through `geometry` and `compute` (with --skip:
// also through both, and `cpu`, with skipping) and the `cpu` that skips nothing, every method or the one named, N pairs
// each. Prints JSON: what meets, what was captured and what differs; exits 4 if anything does.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/pairs/adversarial_pairs.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

constexpr std::size_t kTriangles = 50;
constexpr std::size_t kSegments = 40;

bool same(const Contact& a, const Contact& b) {
  return a.triangle == b.triangle && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t) &&
         a.actuator == b.actuator && a.side == b.side;
}

struct Settings {
  std::uint64_t pairs = 10'000'000;
  std::uint64_t seed = 2;
  std::vector<Method> methods = {Method::kStatic, Method::kCarried, Method::kCcd};
  ContextKind context = ContextKind::kAuto;
  int device = -1;
  bool skip = false;
  ColliderShape shape = ColliderShape::kPoints;
};

/// A detector and what it did otherwise than the `cpu` that skips nothing.
struct Contestant {
  std::unique_ptr<Detector> detector;
  bool skips = false;
  std::uint64_t captured = 0;
  std::uint64_t missed = 0;
  std::uint64_t winners_differing = 0;

  void detect(const DetectorFrame& frame, const ContactRow& expected, std::uint64_t expected_meeting) {
    ContactRow row;
    const DetectorWork work = detector->detect(frame, row);
    captured += work.pairs_captured;
    missed += expected_meeting - work.pairs_meeting;
    for (std::size_t i = 0; i < row.size(); ++i)
      if (!same(row[i], expected[i])) ++winners_differing;
  }
};

nlohmann::ordered_json compare(Method method, const Settings& settings) {
  const Avatar avatar = loose_triangles(kTriangles);
  const ActuatorMap map;
  const auto options = [&](Skip skip) { return DetectorOptions{Surface::kAll, PlaneSet::all(), method, skip}; };
  const auto cpu = make_cpu_detector(avatar, map, options(Skip::kOff));
  std::vector<Contestant> contestants;
  const auto add_shaders = [&](Skip skip) {
    for (const auto make : {make_geometry_detector, make_compute_detector}) {
      // own context: the one that the flags name
      contestants.push_back(
          {.detector = make(make_gl_context(settings.context, settings.device), avatar, map, options(skip)),
           .skips = skip == Skip::kOn});
    }
  };
  add_shaders(Skip::kOff);
  if (settings.skip) {
    add_shaders(Skip::kOn);
    contestants.push_back({.detector = make_cpu_detector(avatar, map, options(Skip::kOn)), .skips = true});
  }
  test::AdversarialSource source(settings.seed, settings.shape);
  ContactRow expected;
  std::uint64_t done = 0;
  std::uint64_t meeting = 0;
  while (done < settings.pairs) {
    const test::AdversarialPairs drawn = source.draw(kTriangles, kSegments);
    const DetectorFrame frame = loose_frame(drawn.before, drawn.now, drawn.segments);
    const std::uint64_t met = cpu->detect(frame, expected).pairs_meeting;
    meeting += met;
    done += kTriangles * kSegments;
    for (Contestant& contestant : contestants) contestant.detect(frame, expected, met);
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Contestant& contestant : contestants) {
    const GlInfo info = contestant.detector->gl_info();
    rows.push_back({{"method", name_of(method)},
                    {"detector", contestant.detector->name()},
                    {"skip", contestant.skips},
                    {"context", info.context},
                    {"renderer", info.renderer},
                    {"pairs", done},
                    {"meeting", meeting},
                    {"captured", contestant.captured},
                    {"missed", contestant.missed},
                    {"winners_differing", contestant.winners_differing}});
  }
  return rows;
}

}  // namespace
}  // namespace vestige

namespace {

int run(int argc, char** argv) {
  vestige::Settings settings;
  CLI::App app("Compares the detectors geometry and compute with cpu.");
  std::string method;
  const std::map<std::string, vestige::ContextKind> contexts = {{"auto", vestige::ContextKind::kAuto},
                                                                {"egl", vestige::ContextKind::kEgl},
                                                                {"osmesa", vestige::ContextKind::kOsMesa}};
  app.add_option("--pairs", settings.pairs)->check(CLI::PositiveNumber);
  app.add_option("--seed", settings.seed);
  app.add_option("--context", settings.context)->transform(CLI::CheckedTransformer(contexts));
  app.add_option("--method", method)->check(CLI::IsMember({"static", "carried", "ccd"}));
  app.add_option("--device", settings.device)->check(CLI::Range(0, 1023));
  app.add_flag("--skip", settings.skip);
  app.add_flag_callback("--spheres", [&settings] { settings.shape = vestige::ColliderShape::kSpheres; });
  CLI11_PARSE(app, argc, argv);
  if (!method.empty())
    std::erase_if(settings.methods, [&](vestige::Method one) { return vestige::name_of(one) != method; });

  std::vector<std::string> arguments(argv, argv + argc);
  arguments.front() = "geometry_agreement";  // not where it happens to lie
  nlohmann::ordered_json report = vestige::provenance(arguments);
  report["seed"] = settings.seed;
  if (settings.shape == vestige::ColliderShape::kSpheres) report["colliders"] = "spheres";
  bool same = true;
  for (const vestige::Method each : settings.methods) {
    for (nlohmann::ordered_json& row : vestige::compare(each, settings)) {
      same = same && row["missed"] == 0 && row["winners_differing"] == 0;
      report["methods"].push_back(std::move(row));
    }
  }
  fmt::print("{}\n", report.dump(2));
  return same ? 0 : 4;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const vestige::Error& error) {
    fmt::print(stderr, "geometry_agreement: error: {}\n", error.what());
    return 1;
  }
}
