// What it costs to judge mappings, beside the detection that they share: prints microseconds a frame and law. By hand:
//   mapping_benchmark [frames]

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <map>

#include "detector/actuators/actuator_model.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/finer_map.hpp"
#include "tests/support/mapping_run.hpp"

namespace vestige {
namespace {

/// Of this processor's time, since the machine may have other work.
double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void measure(const char* scenario, int frames) {
  const Avatar& avatar = test::builtin_avatar();
  const auto start = std::clock();
  const ContactRecording recording = test::record_scenario(scenario, avatar, 100, frames, 60);
  fmt::print("{}: {} frames, {:.1f} contacts a frame; made, posed and detected in {:.1f} us of processor a frame\n",
             scenario, frames, static_cast<double>(recording.contacts.size()) / frames,
             1e6 * seconds_since(start) / frames);
  const std::map<std::string, ActuatorMap> maps = {
      {"6", test::builtin_map()}, {"16", test::finer_map(8, 2)}, {"40", test::finer_map(8, 5)}};
  const auto motors = std::make_shared<ActuatorModel>();
  for (const auto& [name, map] : maps) {
    const auto begin = std::clock();
    const ActuatorLayout layout(avatar, map);
    const double layout_s = seconds_since(begin);
    const auto cost_us = [&](const std::vector<LawChoice>& laws) {
      double best_s = 1e9;
      for (int i = 0; i < 7; ++i) {
        const auto before = std::clock();
        score_all(recording, {&layout}, laws);
        best_s = std::min(best_s, seconds_since(before));
      }
      return 1e6 * best_s / frames / static_cast<double>(laws.size());
    };
    std::vector<LawChoice> laws(law_names().size());
    std::string alone;
    for (std::size_t i = 0; i < laws.size(); ++i) {
      laws[i].name = law_names()[i];
      alone += fmt::format(", {} {:.2f}", laws[i].name, cost_us({laws[i]}));
    }
    const double together_us = cost_us(laws);
    for (LawChoice& law : laws) law.actuators = motors;
    fmt::print("  {} actuators: layout {:.1f} ms; us a frame and law: all together {:.2f}, with motors {:.2f}{}\n",
               name, 1e3 * layout_s, together_us, cost_us(laws), alone);
  }
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 2000;
  for (const char* scenario : {"swarm", "slide"}) vestige::measure(scenario, frames);
}
