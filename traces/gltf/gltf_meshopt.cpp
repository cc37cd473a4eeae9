#include "traces/gltf/gltf_meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace vestige::gltf {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> kModes = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::array<std::string_view, 4> kFilters = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};

/// Reads the properties of the extension one by one.
class Reader {
 public:
  Reader(const json& extension, std::string path, const Report& report)
      : extension_(extension), path_(std::move(path)), report_(report) {
    if (!extension.is_object()) report.fail(path_, "is not an object");
  }

  std::uint64_t number(const char* name, std::uint64_t at_most) const {
    const auto found = extension_.find(name);
    if (found == extension_.end()) fail("", fmt::format("'{}' is missing", name));
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > at_most)
      fail(name, fmt::format("{} is not a whole number from 0 to {}", found->dump(), at_most));
    return found->get<std::uint64_t>();
  }

  std::uint64_t number_or_zero(const char* name, std::uint64_t at_most) const {
    return extension_.contains(name) ? number(name, at_most) : 0;
  }

  template <std::size_t N>
  std::size_t word(const char* name, const std::array<std::string_view, N>& words) const {
    const auto found = extension_.find(name);
    if (found == extension_.end()) return 0;
    const auto word =
        found->is_string() ? std::find(words.begin(), words.end(), found->get_ref<const std::string&>()) : words.end();
    if (word == words.end()) fail(name, fmt::format("is not one of {}", fmt::join(words, ", ")));
    return static_cast<std::size_t>(word - words.begin());
  }

  [[noreturn]] void fail(std::string_view property, std::string_view cause) const {
    report_.fail(property.empty() ? path_ : fmt::format("{}.{}", path_, property), cause);
  }

 private:
  const json& extension_;
  std::string path_;
  const Report& report_;
};

bool is_stride_possible(const PackedView& view) {
  if (view.mode != PackedView::Mode::kAttributes) return view.stride == 2 || view.stride == 4;
  if (view.filter == PackedView::Filter::kOctahedral) return view.stride == 4 || view.stride == 8;
  if (view.filter == PackedView::Filter::kQuaternion) return view.stride == 8;
  return view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0;
}

}  // namespace

std::optional<PackedView> read_packed_view(const json& view, const std::string& path, std::size_t buffer_count,
                                           const Report& report) {
  const auto extensions = view.find("extensions");
  if (extensions == view.end() || !extensions->is_object() || !extensions->contains(kMeshopt)) return std::nullopt;
  constexpr std::uint64_t kMost = 0xFFFFFFFF;
  const Reader reader((*extensions)[kMeshopt], fmt::format("{}.extensions.{}", path, kMeshopt), report);
  PackedView packed;
  packed.buffer = reader.number("buffer", kMost);
  if (packed.buffer >= buffer_count)
    reader.fail("buffer", fmt::format("{} does not exist: the number of buffers is {}", packed.buffer, buffer_count));
  packed.offset = reader.number_or_zero("byteOffset", kMost);
  packed.length = reader.number("byteLength", kMost);
  packed.count = reader.number("count", kMost);
  packed.stride = reader.number("byteStride", kMost);
  if (!(*extensions)[kMeshopt].contains("mode")) reader.fail("", "'mode' is missing");
  packed.mode = static_cast<PackedView::Mode>(reader.word("mode", kModes));
  packed.filter = static_cast<PackedView::Filter>(reader.word("filter", kFilters));
  if (!is_stride_possible(packed)) reader.fail("byteStride", fmt::format("cannot be {} here", packed.stride));
  if (packed.mode == PackedView::Mode::kTriangles && packed.count % 3 != 0)
    reader.fail("count", fmt::format("{} is not a multiple of 3, but the view holds triangles", packed.count));
  if (packed.mode != PackedView::Mode::kAttributes && packed.filter != PackedView::Filter::kNone)
    reader.fail("filter", "is not allowed for indices");
  if (packed.count * packed.stride != view["byteLength"].get<std::uint64_t>())
    reader.fail("count", fmt::format("{} elements of {} bytes are not the view's {} bytes", packed.count, packed.stride,
                                     view["byteLength"].get<std::uint64_t>()));
  if (view.contains("byteStride") && view["byteStride"].get<std::uint64_t>() != packed.stride)
    reader.fail("byteStride", "differs from the view's byteStride");
  return packed;
}

std::vector<std::byte> unpack(const PackedView& view, std::span<const std::byte> packed, const std::string& path,
                              const Report& report) {
  std::vector<std::byte> content(view.count * view.stride);
  const auto* bytes = reinterpret_cast<const unsigned char*>(packed.data());
  int failure = 0;
  switch (view.mode) {
    case PackedView::Mode::kAttributes:
      failure = meshopt_decodeVertexBuffer(content.data(), view.count, view.stride, bytes, packed.size());
      break;
    case PackedView::Mode::kTriangles:
      failure = meshopt_decodeIndexBuffer(content.data(), view.count, view.stride, bytes, packed.size());
      break;
    case PackedView::Mode::kIndices:
      failure = meshopt_decodeIndexSequence(content.data(), view.count, view.stride, bytes, packed.size());
      break;
  }
  if (failure != 0) report.fail(path, fmt::format("cannot be unpacked to {} elements by {}", view.count, kMeshopt));
  switch (view.filter) {
    case PackedView::Filter::kNone:
      break;
    case PackedView::Filter::kOctahedral:
      meshopt_decodeFilterOct(content.data(), view.count, view.stride);
      break;
    case PackedView::Filter::kQuaternion:
      meshopt_decodeFilterQuat(content.data(), view.count, view.stride);
      break;
    case PackedView::Filter::kExponential:
      meshopt_decodeFilterExp(content.data(), view.count, view.stride);
      break;
  }
  return content;
}

}  // namespace vestige::gltf
