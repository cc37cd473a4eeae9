#include "analysis/view/page_data.hpp"

#include <libdeflate.h>
#include <nettle/base64.h>

#include <memory>
#include <new>

namespace vestige {

void PageArrays::note(const std::string& name, const std::string& type, std::size_t count, std::size_t delta) {
  nlohmann::ordered_json entry = {{"type", type}, {"count", count}, {"at", bytes_.size()}};
  if (delta > 0) entry["delta"] = delta;
  table_[name] = std::move(entry);
}

void PageArrays::append(std::span<const std::byte> bytes, std::size_t size) {
  const std::size_t count = bytes.size() / size;
  bytes_.reserve(bytes_.size() + bytes.size());
  for (std::size_t place = 0; place < size; ++place)
    for (std::size_t i = 0; i < count; ++i) bytes_.push_back(bytes[i * size + place]);
}

std::string PageArrays::packed() const {
  constexpr int kLevel = 9;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::vector<std::uint8_t> deflated(libdeflate_zlib_compress_bound(compressor.get(), bytes_.size()));
  deflated.resize(
      libdeflate_zlib_compress(compressor.get(), bytes_.data(), bytes_.size(), deflated.data(), deflated.size()));
  std::string text(BASE64_ENCODE_RAW_LENGTH(deflated.size()), '\0');
  base64_encode_raw(text.data(), deflated.size(), deflated.data());
  return text;
}

}  // namespace vestige
