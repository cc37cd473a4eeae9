#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "detector/contact.hpp"
#include "traces/base/sha256.hpp"

namespace vestige {

/// SHA-256 of a run's collision textures: per frame, then per column, in little-endian: u32 triangle (0xFFFFFFFF
/// without contact), u32 bits of t (+inf without contact), u16 actuator. Rows must carry `kHashedPlanes`.
class TextureHash {
 public:
  void add(const ContactRow& row);
  /// Returns the hash in lower-case hexadecimal. This ends the hash: call it once.
  std::string hex() { return sha_.hex(); }

 private:
  Sha256 sha_;
  std::vector<std::byte> bytes_;  ///< of one row
};

/// Returns the hash of a run with the hashes of its people, in their order: of one person the same, of several SHA-256
/// over the characters of theirs.
std::string texture_hash_of(std::span<const std::string> people);

}  // namespace vestige
