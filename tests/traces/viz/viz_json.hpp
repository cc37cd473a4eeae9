// What Foxglove's messages say, as JSON.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace vestige::test {

inline glm::dvec3 vector_of(const nlohmann::json& v) {
  return {v["x"].get<double>(), v["y"].get<double>(), v["z"].get<double>()};
}

inline glm::dmat4 matrix_of(const nlohmann::json& transform) {
  const nlohmann::json& q = transform["rotation"];
  const glm::dquat rotation(q["w"].get<double>(), q["x"].get<double>(), q["y"].get<double>(), q["z"].get<double>());
  glm::dmat4 matrix = glm::mat4_cast(rotation);
  matrix[3] = glm::dvec4(vector_of(transform["translation"]), 1);
  return matrix;
}

}  // namespace vestige::test
