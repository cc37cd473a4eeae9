#include "detector/output/texture_hash.hpp"

#include <bit>

namespace vestige {

namespace {

constexpr std::size_t kContactBytes = 10;

template <typename Unsigned>
std::byte* put_little_endian(std::byte* out, Unsigned value) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) *out++ = static_cast<std::byte>(value >> (8 * i));
  return out;
}

}  // namespace

void TextureHash::add(const ContactRow& row) {
  bytes_.resize(kContactBytes * row.size());
  std::byte* out = bytes_.data();
  for (const Contact& contact : row) {
    out = put_little_endian(out, contact.triangle);
    out = put_little_endian(out, std::bit_cast<std::uint32_t>(contact.t));
    out = put_little_endian(out, contact.actuator);
  }
  sha_.update(bytes_);
}

std::string texture_hash_of(std::span<const std::string> people) {
  if (people.size() == 1) return people.front();
  Sha256 sha;
  for (const std::string& hash : people) sha.update(std::as_bytes(std::span(hash)));
  return sha.hex();
}

}  // namespace vestige
