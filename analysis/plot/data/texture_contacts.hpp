#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// One texel of the collision textures that holds a contact.
struct TextureContact {
  std::uint32_t frame = 0;
  std::uint32_t collider = 0;  ///< rank of the collider's id
  std::uint16_t actuator = 0;  ///< 0: skin without an actuator
};

struct TextureContacts {
  std::uint32_t frames = 0;
  std::uint32_t colliders = 0;
  std::vector<TextureContact> contacts;  ///< by frame, then collider
  std::vector<std::string> names;        ///< names of actuators 1, 2, …; not filled from the file
};

/// Returns the number of people in an OpenEXR file that 'vestige replay --textures' wrote: a part for each. Throws
/// `Error` if the file is missing, is not OpenEXR, or is cut off.
std::size_t people_in_textures(const std::filesystem::path& path);

/// Reads the plane `actuator` of a person, counted from 0: width = colliders, height = frames, +inf where there is no
/// contact. Throws `Error` as above, or if the file lacks the plane, or has a value that is not an actuator number.
TextureContacts read_texture_contacts(const std::filesystem::path& path, std::size_t person);

}  // namespace vestige::plot
