#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "detector/contact.hpp"
#include "traces/base/sha256.hpp"

namespace vestige {

/// SHA-256 of a run's contacts alone: per frame, then by ascending id of the collider, in little-endian: u64 number of
/// the frame, u32 id, u32 triangle, u32 bits of t, u16 actuator. Unlike `TextureHash`, it does not depend on colliders
/// that touch nothing. So it needs no ids beforehand, and what is felt live has the hash that its recording has.
class ContactsHash {
 public:
  /// `row` carries `kHashedPlanes`. Its column c belongs to the collider `ids[c]`, in any order.
  void add(std::uint64_t frame, const ContactRow& row, std::span<const std::uint32_t> ids);
  /// Returns the hash in lower-case hexadecimal. This ends the hash: call it once.
  std::string hex() { return sha_.hex(); }

 private:
  Sha256 sha_;
  std::vector<std::pair<std::uint32_t, std::size_t>> hits_;  ///< of one row: ids and columns
  std::vector<std::byte> bytes_;                             ///< of one row
};

}  // namespace vestige
