#pragma once

#include <memory>
#include <string>

#include "detector/contact.hpp"
#include "traces/base/sha256.hpp"

namespace vestige {

/// SHA-256 of a run's collision textures: per frame, then per column, little-endian u32 triangle (0xFFFFFFFF none), u32
/// bits of t (+inf none), u16 actuator. Rows must carry `kHashedPlanes`.
class TextureHash {
 public:
  void add(const ContactRow& row);
  /// Lower-case hexadecimal. Ends the hash: call once.
  std::string hex() { return sha_.hex(); }

 private:
  Sha256 sha_;
  std::string bytes_;
};

}  // namespace vestige
