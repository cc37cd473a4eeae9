#include "traces/live/live_scene.hpp"

#include <algorithm>
#include <iterator>

namespace vestige {

std::vector<std::vector<std::uint32_t>> LiveScene::show(TraceFrame& frame) {
  std::vector<std::vector<std::uint32_t>> teleported(sources_.size());
  if (sources_.size() == 1) {  // whose ids clash with nobody's
    sources_.front()->show(frame);
    teleported.front() = frame.teleported;
    return teleported;
  }
  frame.poses.clear();
  frame.colliders.clear();
  frame.teleported.clear();
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    sources_[i]->show(shown_);
    teleported[i] = shown_.teleported;
    frame.poses.push_back(shown_.poses.front());
    const auto keep = [&](std::uint32_t id) { return source_of_.try_emplace(id, i).first->second == i; };
    for (const ColliderSample& collider : shown_.colliders) {
      if (keep(collider.id))
        frame.colliders.push_back(collider);
      else
        ids_clash_ = true;
    }
    std::ranges::copy_if(shown_.teleported, std::back_inserter(frame.teleported), keep);
  }
  std::ranges::sort(frame.colliders, {}, &ColliderSample::id);
  return teleported;
}

}  // namespace vestige
