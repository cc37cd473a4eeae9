#include "detector/detectors/path_choice.hpp"

#include <fmt/format.h>

namespace vestige {

PickedPath pick_path(std::size_t triangles, std::size_t colliders, Skip allowed) {
  const std::string pairs =
      fmt::format("{} collider{} x {} triangles", colliders, colliders == 1 ? "" : "s", triangles);
  if (allowed == Skip::kOff) return {"cpu", Skip::kOff, pairs + "; --skip off asks for brute force"};
  return {"cpu", Skip::kOn, pairs + ": skipping was faster than brute force on every measured mesh"};
}

}  // namespace vestige
