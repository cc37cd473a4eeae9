#include "detector/output/texture_hash.hpp"

#include <bit>

namespace vestige {

namespace {

template <typename Unsigned>
void append_little_endian(std::string& out, Unsigned value) {
  for (std::size_t byte = 0; byte < sizeof(Unsigned); ++byte)
    out.push_back(static_cast<char>(static_cast<std::uint32_t>(value) >> (8 * byte)));
}

}  // namespace

void TextureHash::add(const ContactRow& row) {
  bytes_.clear();
  for (const Contact& contact : row) {
    append_little_endian(bytes_, contact.triangle);
    append_little_endian(bytes_, std::bit_cast<std::uint32_t>(contact.t));
    append_little_endian(bytes_, contact.actuator);
  }
  sha_.update(std::as_bytes(std::span(bytes_)));
}

std::string texture_hash_of(std::span<const std::string> people) {
  if (people.size() == 1) return people.front();
  Sha256 sha;
  for (const std::string& hash : people) sha.update(std::as_bytes(std::span(hash)));
  return sha.hex();
}

}  // namespace vestige
