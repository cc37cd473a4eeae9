#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

/// The collision textures of a run as one OpenEXR image: a row for each frame, a column for each collider, and the
/// channels of each plane requested. Of several people, each has such an image as a part of the file, with the person's
/// name. Rows run top-down; the compression is ZIPS. Without contact, float channels have
/// +inf and uint channels have 0xFFFFFFFF.
///
/// Channels: actuator, t, triangle (uint), u, v, texture_u, texture_v, x, y, z (world metres, rounded to float), speed
/// (m/s), side, pressure (0 … 1, `pressure_of`), depth (m).
class TextureExr {
 public:
  /// `attributes` become strings in the header of each part. `people` are different names.
  TextureExr(PlaneSet planes, std::size_t columns, std::map<std::string, std::string> attributes,
             const std::vector<std::string>& people);

  /// Adds a row to a person's image; people count from 0. Only contacts are stored, so memory grows with the number of
  /// contacts, not with frames times colliders. All people get as many rows.
  void add(std::size_t person, const DetectorFrame& frame, const ContactRow& row);

  /// Writes the whole image. Throws `Error` for a run without frames or without colliders, which has no image.
  void write(OutputFile& file) const;

 private:
  struct Texel {
    std::uint32_t row;
    std::uint32_t column;
    Contact contact;  // position in world metres
  };

  struct PersonImage {
    std::string name;
    std::uint32_t rows = 0;
    std::vector<Texel> texels = {};
  };

  template <typename Image>
  void write_rows(const PersonImage& person, Image& image) const;

  PlaneSet planes_;
  std::size_t columns_;
  std::map<std::string, std::string> attributes_;
  std::vector<PersonImage> people_;
};

}  // namespace vestige
