#pragma once

#include <nettle/sha2.h>

#include <cstddef>
#include <span>
#include <string>

namespace vestige {

/// SHA-256 (FIPS 180-4) of bytes that arrive piece by piece.
class Sha256 {
 public:
  Sha256();
  void update(std::span<const std::byte> bytes);
  /// Returns the hash of all bytes so far as 64 lower-case hexadecimal digits. More bytes may follow.
  std::string hex() const;

 private:
  sha256_ctx context_;
};

/// SHA-256 of bytes that are all present.
std::string sha256_hex(std::span<const std::byte> bytes);

}  // namespace vestige
