#include "analysis/accuracy/missed_page.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "analysis/run/seen_run.hpp"
#include "analysis/view/trace_page.hpp"

namespace vestige {

namespace {

double missed_share(const EventCounts& events) {
  return events.true_events() == 0 ? 0 : static_cast<double>(events.missed) / static_cast<double>(events.true_events());
}

}  // namespace

std::optional<MostMissed> most_missed(std::span<const AccuracyScene> scenes,
                                      std::span<const AccuracyContestant> contestants) {
  std::optional<MostMissed> most;
  std::pair<double, double> shares = {0, 0};
  for (const AccuracyScene& scene : scenes)
    for (const AccuracyPoint& point : scene.points) {
      const AccuracyContestant& contestant = contestants[point.contestant];
      if (contestant.method == Method::kCcd && !contestant.instance->is_approximate()) continue;
      const std::pair missed = {missed_share(point.tolerated.all), missed_share(point.score.all)};
      if (missed.first == 0 || missed <= shares) continue;
      most = {&scene, &point};
      shares = missed;
    }
  return most;
}

std::optional<MissedPage> missed_page(const MovingScene& scene, const ActuatorMap& map, const MissedSampling& sampling,
                                      std::vector<MissedSide> sides, const std::function<bool(double)>& progress) {
  const std::array<MappedPerson, 1> people = {{{scene.avatar, map}}};
  const LawFlags law;
  std::vector<std::unique_ptr<SeenRun>> runs;
  std::vector<SeenRun*> run_of_side;
  std::vector<std::string> titles;
  std::vector<PagePerson> bodies;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    runs.push_back(std::make_unique<SeenRun>(SeenRun::Input{people, scene.collider_ids, law, kPagePlanes},
                                             [&](PlaneSet) { return std::move(sides[i].detectors); }));
    run_of_side.push_back(runs.back().get());
    titles.push_back(sides[i].title);
    bodies.push_back({"", scene.avatar, map, 0, i});
  }
  PagePacker packer(bodies, titles, scene.collider_ids);
  MissedPage page = {{}, std::vector<std::uint64_t>(sides.size())};
  SceneSampler sampler(scene, sampling.rate_hz);
  const std::uint64_t last = last_frame_within(scene, sampling.rate_hz);
  for (std::uint64_t i = 0; i <= last; ++i) {
    pack_frame(sampler.next(), run_of_side, packer, page.contacts);
    if (!progress(static_cast<double>(i + 1) / static_cast<double>(last + 1))) return {};
  }
  page.content = packer.finish();
  page.content.head["same_contact_s"] = sampling.tolerance_s;
  return page;
}

}  // namespace vestige
