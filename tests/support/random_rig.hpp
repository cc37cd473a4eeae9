#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "detector/frame.hpp"
#include "traces/gltf/gltf_influences.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::test {

/// The shape of a random rig. Sizes and the offset are exponents of two.
struct RigShape {
  std::uint64_t seed = 0;
  int triangles = 1;
  int entries = 1;
  int influences = 1;  ///< most influences of a vertex
  int mesh_size = 0;
  int mesh_offset = 0;
  int matrix_size = 0;
  int translation_size = 0;
};

/// A triangle soup whose palette need not come from a skeleton: it includes shears and mirrors.
class RandomRig {
 public:
  explicit RandomRig(const RigShape& shape) : shape_(shape), random_(shape.seed) {
    avatar.nodes.resize(1);
    avatar.node_order = {0};
    avatar.palette.resize(static_cast<std::size_t>(shape.entries));
    const glm::vec3 offset = vector(std::ldexp(1.0F, shape.mesh_offset));
    gltf::Report report("random");
    for (int i = 0; i < shape.triangles; ++i) {
      const auto first = static_cast<std::uint32_t>(avatar.position_bind.size());
      avatar.triangles.emplace_back(first, first + 1, first + 2);
      for (int corner = 0; corner < 3; ++corner) {
        avatar.position_bind.push_back(offset + vector(std::ldexp(1.0F, shape.mesh_size)));
        avatar.texture_coordinate.emplace_back(0, 0);
        avatar.influences.push_back(influences(report));
      }
    }
    avatar.influence_count = static_cast<std::size_t>(shape.influences);
  }

  std::vector<SkinMatrix> palette() {
    std::vector<SkinMatrix> palette(avatar.palette.size());
    for (SkinMatrix& matrix : palette)
      for (std::size_t column = 0; column < 4; ++column) {
        const int size = column == 3 ? shape_.translation_size : shape_.matrix_size;
        matrix.column[column] = glm::vec4(vector(std::ldexp(1.0F, size)), 0);
      }
    return palette;
  }

  glm::vec3 vector(float size) {
    std::uniform_real_distribution<float> number(-size, size);
    const float x = number(random_);
    const float y = number(random_);
    return {x, y, number(random_)};
  }

  Avatar avatar;

 private:
  Influences influences(gltf::Report& report) {
    std::uniform_int_distribution<int> entry(0, shape_.entries - 1);
    std::uniform_real_distribution<double> weight(0, 1);
    std::vector<gltf::Influence> influences;
    for (int k = 0; k < shape_.influences; ++k)
      influences.push_back({static_cast<std::uint16_t>(entry(random_)), weight(random_)});
    return gltf::combine_influences(influences, 0, "random", report);
  }

  RigShape shape_;
  std::mt19937_64 random_;
};

}  // namespace vestige::test
