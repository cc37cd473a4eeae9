#include "detector/output/contacts_hash.hpp"

#include <algorithm>
#include <bit>

namespace vestige {

namespace {

template <typename Unsigned>
void append_little_endian(std::vector<std::byte>& out, Unsigned value) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

}  // namespace

void ContactsHash::add(std::uint64_t frame, const ContactRow& row, std::span<const std::uint32_t> ids) {
  hits_.clear();
  for (std::size_t column = 0; column < row.size(); ++column)
    if (row[column].hit()) hits_.emplace_back(ids[column], column);
  std::ranges::sort(hits_);
  bytes_.clear();
  for (const auto& [id, column] : hits_) {
    const Contact& contact = row[column];
    append_little_endian(bytes_, frame);
    append_little_endian(bytes_, id);
    append_little_endian(bytes_, contact.triangle);
    append_little_endian(bytes_, std::bit_cast<std::uint32_t>(contact.t));
    append_little_endian(bytes_, contact.actuator);
  }
  sha_.update(bytes_);
}

}  // namespace vestige
