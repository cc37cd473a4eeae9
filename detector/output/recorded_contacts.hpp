#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

namespace vestige {

/// One contact of a file, with all that the file says of it.
struct RecordedContact {
  std::uint64_t frame = 0;
  double time_s = 0;
  std::uint32_t collider = 0;  ///< its id
  std::uint32_t triangle = 0;
  float t = 0;
  glm::dvec2 barycentric = glm::dvec2(0);         ///< weights of the triangle's second and third vertex
  glm::dvec2 texture_coordinate = glm::dvec2(0);  ///< not wrapped into [0, 1]
  std::uint16_t actuator = 0;
  std::int8_t side = 0;
  glm::dvec3 position_m = glm::dvec3(0);  ///< in the world
  std::optional<double> depth_m = {};     ///< of a sphere; empty if the file has no depths
  std::uint16_t avatar = 1;               ///< the person who was touched, from 1 on; 1 if the file does not say
};

/// The numbers of triangles and actuators that the contacts on a person can refer to.
struct PersonLimits {
  std::size_t triangles = std::numeric_limits<std::uint32_t>::max();
  std::size_t actuators = std::numeric_limits<std::uint16_t>::max();
};

/// The people and the number of frames that the contacts of a file can refer to.
struct ContactLimits {
  std::vector<PersonLimits> people = {PersonLimits()};
  std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
};

/// Reads a file of `ContactsFile`, CSV or HDF5 by its content, with rows in any order, and returns the contacts ordered
/// by frame, avatar and collider. Throws `Error` with file and line, or table and row, also if a contact refers to
/// something that does not exist, or if the limits name several people and the file does not say who was touched.
/// Precondition: no threads have been started, because HDF5 is first read in a child process.
std::vector<RecordedContact> read_contacts(const std::filesystem::path& path, const ContactLimits& limits = {});

}  // namespace vestige
