#pragma once

#include <sha2.h>

#include <cstddef>
#include <span>
#include <string>

namespace vestige {

/// SHA-256 (FIPS 180-4) of bytes that come bit by bit.
class Sha256 {
 public:
  Sha256();
  void update(std::span<const std::byte> bytes);
  /// 64 lower-case hexadecimal digits of everything so far; more may follow.
  std::string hex() const;

 private:
  SHA2_CTX context_;
};

/// `Sha256` of bytes that are all here.
std::string sha256_hex(std::span<const std::byte> bytes);

}  // namespace vestige
