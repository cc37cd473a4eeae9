// Run by hand: geometry_agreement [--pairs N] [--seed K] [--context auto|egl|osmesa] [--skip]. Adversarial pairs
// through `geometry` and `cpu`, every method, N pairs each. Prints JSON: what meets, what was captured and what
// differs; exits 4 if anything does.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/provenance.hpp"
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

struct Settings {
  std::uint64_t pairs = 10'000'000;
  std::uint64_t seed = 2;
  ContextKind context = ContextKind::kAuto;
  bool skip = false;
};

nlohmann::ordered_json compare(Method method, const Settings& settings) {
  const Avatar avatar = loose_triangles(kTriangles);
  const ActuatorMap map;
  const DetectorOptions options = {Surface::kAll, PlaneSet::all(), method, settings.skip ? Skip::kOn : Skip::kOff};
  const auto geometry = make_geometry_detector(make_gl_context(settings.context, -1), avatar, map, options);
  const auto cpu = make_cpu_detector(avatar, map, options);
  test::AdversarialSource source(settings.seed);
  ContactRow row;
  ContactRow expected;
  std::uint64_t done = 0;
  std::uint64_t captured = 0;
  std::uint64_t meeting = 0;
  std::uint64_t missed = 0;
  std::uint64_t differing = 0;
  while (done < settings.pairs) {
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
  return {{"method", name_of(method)},
          {"context", geometry->gl_info().context},
          {"renderer", geometry->gl_info().renderer},
          {"pairs", done},
          {"meeting", meeting},
          {"captured", captured},
          {"missed", missed},
          {"winners_differing", differing}};
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  vestige::Settings settings;
  CLI::App app("Compares the geometry detector with cpu.");
  const std::map<std::string, vestige::ContextKind> contexts = {{"auto", vestige::ContextKind::kAuto},
                                                                {"egl", vestige::ContextKind::kEgl},
                                                                {"osmesa", vestige::ContextKind::kOsMesa}};
  app.add_option("--pairs", settings.pairs)->check(CLI::PositiveNumber);
  app.add_option("--seed", settings.seed);
  app.add_option("--context", settings.context)->transform(CLI::CheckedTransformer(contexts));
  app.add_flag("--skip", settings.skip);
  CLI11_PARSE(app, argc, argv);

  std::vector<std::string> arguments(argv, argv + argc);
  arguments.front() = "geometry_agreement";  // not where it happens to lie
  nlohmann::ordered_json report = vestige::provenance(arguments);
  report["seed"] = settings.seed;
  bool same = true;
  for (const vestige::Method method : {vestige::Method::kStatic, vestige::Method::kCarried, vestige::Method::kCcd}) {
    const nlohmann::ordered_json compared = compare(method, settings);
    same = same && compared["missed"] == 0 && compared["winners_differing"] == 0;
    report["methods"].push_back(compared);
  }
  fmt::print("{}\n", report.dump(2));
  return same ? 0 : 4;
}
