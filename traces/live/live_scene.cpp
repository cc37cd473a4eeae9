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
  shown_.resize(sources_.size());
  for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i]->show(shown_[i]);
  find_owners();
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    teleported[i] = shown_[i].teleported;
    frame.poses.push_back(shown_[i].poses.front());
    const auto owns = [&](std::uint32_t id) {
      const auto source = source_of_.find(id);
      return source != source_of_.end() && source->second == i;
    };
    for (const ColliderSample& collider : shown_[i].colliders) {
      if (owns(collider.id))
        frame.colliders.push_back(collider);
      else
        ids_clash_ = true;
    }
    std::ranges::copy_if(shown_[i].teleported, std::back_inserter(frame.teleported), owns);
  }
  std::ranges::sort(frame.colliders, {}, &ColliderSample::id);
  return teleported;
}

void LiveScene::find_owners() {
  std::unordered_map<std::uint32_t, std::size_t> before;
  before.swap(source_of_);
  for (std::size_t i = 0; i < shown_.size(); ++i)
    for (const ColliderSample& collider : shown_[i].colliders)
      if (const auto owner = before.find(collider.id); owner != before.end() && owner->second == i)
        source_of_[collider.id] = i;
  for (std::size_t i = 0; i < shown_.size(); ++i)
    for (const ColliderSample& collider : shown_[i].colliders) source_of_.try_emplace(collider.id, i);
}

}  // namespace vestige
