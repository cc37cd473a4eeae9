#pragma once

#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige::test {

inline const Avatar& builtin_avatar() {
  static const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  return avatar;
}

}  // namespace vestige::test
