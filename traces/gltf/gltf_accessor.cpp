#include "traces/gltf/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace vestige::gltf {

namespace {

struct ComponentType {
  std::size_t bytes;
  Component plain;
  Component normalized;
  std::string_view name;
};

/// Indexed by number, from 5120 (GL_BYTE) on; glTF 2.0 omits 5124.
constexpr std::array<ComponentType, 7> kComponentTypes = {
    ComponentType{1, kInt8, kNormalizedInt8, "int8"},
    ComponentType{1, kUint8, kNormalizedUint8, "uint8"},
    ComponentType{2, kInt16, kNormalizedInt16, "int16"},
    ComponentType{2, kUint16, kNormalizedUint16, "uint16"},
    ComponentType{0, kFloat, kFloat, ""},
    ComponentType{4, kUint32, kUint32, "uint32"},
    ComponentType{4, kFloat, kFloat, "float"},
};

/// Precondition: the number is 5120 … 5126, as the schema ensures.
const ComponentType& component_type(int number) {
  return kComponentTypes[static_cast<std::size_t>(number - TINYGLTF_COMPONENT_TYPE_BYTE)];
}

std::string_view type_name(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    case TINYGLTF_TYPE_VEC4:
      return "VEC4";
    case TINYGLTF_TYPE_MAT2:
      return "MAT2";
    case TINYGLTF_TYPE_MAT3:
      return "MAT3";
    default:
      return "MAT4";
  }
}

std::string format_name(int type, unsigned components) {
  std::string names;
  for (const ComponentType& known : kComponentTypes) {
    if (known.bytes == 0) continue;
    if ((components & known.plain) != 0) names += fmt::format("{}{}", names.empty() ? "" : " or ", known.name);
    if ((components & known.normalized & ~known.plain) != 0)
      names += fmt::format("{}normalised {}", names.empty() ? "" : " or ", known.name);
  }
  return fmt::format("{} of {}", type_name(type), names);
}

std::size_t component_count(int type) {
  return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
}

/// The columns of a matrix start at multiples of 4 bytes (glTF 2.0 §3.6.2.4).
std::size_t element_bytes(int type, std::size_t bytes) {
  const auto matrix = [&](std::size_t size) { return size * ((size * bytes + 3) / 4 * 4); };
  if (type == TINYGLTF_TYPE_MAT2) return matrix(2);
  if (type == TINYGLTF_TYPE_MAT3) return matrix(3);
  if (type == TINYGLTF_TYPE_MAT4) return matrix(4);
  return component_count(type) * bytes;
}

std::string accessor_path(std::size_t index, std::string_view property = {}) {
  return fmt::format("accessors[{}]{}", index, property);
}

/// The place of elements in a view, in bytes.
struct Elements {
  std::uint64_t offset;
  std::uint64_t count;
  std::uint64_t stride;
  std::uint64_t size;
};

/// Checks that the elements lie inside the view, and the view inside its buffer. All numbers are below 2³³, so no
/// product or sum here can overflow 64 bits.
void check_range(const Document& document, int view_index, const Elements& elements, const std::string& path,
                 const Report& report) {
  const auto& [offset, count, stride, size] = elements;
  const auto index = static_cast<std::size_t>(view_index);
  const BufferView& view = document.views[index];
  check_inside_buffer(view.offset, view.length, view.buffer, document.buffers[view.buffer].size(),
                      fmt::format("bufferViews[{}]", index), report);
  if (offset + (count - 1) * stride + size > view.length)
    report.fail(path, fmt::format("{} elements of {} bytes from byte {} on, {} bytes apart, do not lie inside "
                                  "bufferViews[{}] of {} bytes",
                                  count, size, offset, stride, index, view.length));
}

/// glTF 2.0 §3.6.2.4: `offset` and the resulting offset in the buffer are multiples of the component's size. Numbers
/// elsewhere are read just as well.
void check_alignment(const Document& document, int view, std::uint64_t offset, std::uint64_t component_bytes,
                     const std::string& path, Report& report) {
  const std::uint64_t start = document.views[static_cast<std::size_t>(view)].offset + offset;
  if (offset % component_bytes != 0 || start % component_bytes != 0)
    report.warn(path, "does not start at a multiple of its component's size");
}

/// Only vertex attributes may be interleaved (glTF 2.0 §3.6.2.1). A byteStride of `size` interleaves nothing.
void refuse_interleaving(const Document& document, int view, std::size_t size, std::string_view use, Report& report) {
  const std::uint64_t stride = document.views[static_cast<std::size_t>(view)].stride;
  if (stride == 0) return;
  const std::string path = fmt::format("bufferViews[{}].byteStride", view);
  if (stride != size)
    report.fail(path, fmt::format("is {}, but only vertex attributes may be interleaved, not {}", stride, use));
  report.warn(path, "is meant for vertex attributes only; as it is the size of an element, it changes nothing");
}

void check_sparse(const Document& document, const Accessor& accessor, std::size_t index, std::size_t size,
                  Report& report) {
  const Accessor::Sparse& sparse = *accessor.sparse;
  if (sparse.count > accessor.count)
    report.fail(accessor_path(index, ".sparse.count"),
                fmt::format("{} is more than the accessor's {} elements", sparse.count, accessor.count));
  const ComponentType& type = component_type(sparse.indices_component_type);
  if ((type.plain & (kUint8 | kUint16 | kUint32)) == 0)
    report.fail(accessor_path(index, ".sparse.indices.componentType"), "is not an unsigned integer type");
  const std::string indices = accessor_path(index, ".sparse.indices");
  const std::string values = accessor_path(index, ".sparse.values");
  check_range(document, sparse.indices_view, {sparse.indices_offset, sparse.count, type.bytes, type.bytes}, indices,
              report);
  check_range(document, sparse.values_view, {sparse.values_offset, sparse.count, size, size}, values, report);
  check_alignment(document, sparse.indices_view, sparse.indices_offset, type.bytes, indices, report);
  check_alignment(document, sparse.values_view, sparse.values_offset, component_type(accessor.component_type).bytes,
                  values, report);
  refuse_interleaving(document, sparse.indices_view, type.bytes, indices, report);
  refuse_interleaving(document, sparse.values_view, size, values, report);
}

std::uint32_t read_unsigned(const std::byte* bytes, std::size_t size) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, size);  // little-endian: the low bytes come first
  return value;
}

template <typename T>
double read_as(const std::byte* bytes) {
  T value = {};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

Format position_format(const Document& document) {
  constexpr unsigned kQuantized =
      kInt8 | kUint8 | kInt16 | kUint16 | kNormalizedInt8 | kNormalizedUint8 | kNormalizedInt16 | kNormalizedUint16;
  return {TINYGLTF_TYPE_VEC3, kFloat | (document.quantized ? kQuantized : 0U)};
}

void check_accessors(const Document& document, Report& report) {
  for (std::size_t i = 0; i < document.accessors.size(); ++i) {
    const Accessor& accessor = document.accessors[i];
    const ComponentType& type = component_type(accessor.component_type);
    if (type.bytes == 0)
      report.fail(accessor_path(i, ".componentType"), fmt::format("{} does not exist", accessor.component_type));
    if (accessor.normalized && type.normalized == type.plain)
      report.warn(accessor_path(i, ".normalized"), fmt::format("has no meaning for {}", type.name));
    // An accessor without data of its own is all zeros, and nothing else would limit its length.
    if (accessor.count > document.data_bytes)
      report.fail(accessor_path(i, ".count"),
                  fmt::format("{} elements do not fit into a file of {} bytes", accessor.count, document.data_bytes));
    const std::size_t size = element_bytes(accessor.type, type.bytes);
    if (accessor.view >= 0) {
      const BufferView& view = document.views[static_cast<std::size_t>(accessor.view)];
      const std::uint64_t stride = view.stride != 0 ? view.stride : size;
      if (stride < size)
        report.fail(accessor_path(i),
                    fmt::format("elements of {} bytes overlap at a byteStride of {}", size, view.stride));
      if (stride % 4 != 0 && stride != size)
        report.fail(fmt::format("bufferViews[{}].byteStride", accessor.view),
                    fmt::format("{} is not a multiple of 4", stride));
      check_range(document, accessor.view, {accessor.offset, accessor.count, stride, size}, accessor_path(i), report);
      check_alignment(document, accessor.view, accessor.offset, type.bytes, accessor_path(i), report);
    } else if (accessor.offset != 0) {
      report.warn(accessor_path(i, ".byteOffset"), "has no meaning without a bufferView");
    }
    if (accessor.sparse) check_sparse(document, accessor, i, size, report);
  }
}

void refuse_stride(const Document& document, int accessor, std::string_view use, Report& report) {
  const Accessor& source = document.accessors[static_cast<std::size_t>(accessor)];
  if (source.view < 0) return;
  const std::size_t size = element_bytes(source.type, component_type(source.component_type).bytes);
  refuse_interleaving(document, source.view, size, use, report);
}

AccessorReader::AccessorReader(const Document& document, int accessor, const Format& format, std::string_view use,
                               const Report& report)
    : accessor_(document.accessors[static_cast<std::size_t>(accessor)]),
      index_(accessor),
      use_(use),
      report_(report),
      count_(accessor_.count) {
  const ComponentType& type = component_type(accessor_.component_type);
  component_ = accessor_.normalized ? type.normalized : type.plain;
  component_bytes_ = type.bytes;
  const auto index = static_cast<std::size_t>(accessor);
  if (accessor_.type != format.type || (component_ & format.components) == 0)
    report.fail(accessor_path(index), fmt::format("is {}, but {} needs {}", format_name(accessor_.type, component_),
                                                  use, format_name(format.type, format.components)));
  const std::size_t size = element_bytes(accessor_.type, component_bytes_);
  if (accessor_.view >= 0) {
    const BufferView& view = document.views[static_cast<std::size_t>(accessor_.view)];
    first_ = document.buffers[view.buffer].data() + view.offset + accessor_.offset;
    start_ = view.offset + accessor_.offset;
    stride_ = view.stride != 0 ? view.stride : size;
  } else {
    static constexpr std::array<std::byte, 64> kZeros = {};
    first_ = kZeros.data();
  }
  if (accessor_.sparse) substitute_sparse(document, report);
}

void AccessorReader::substitute_sparse(const Document& document, const Report& report) {
  const std::size_t size = element_bytes(accessor_.type, component_bytes_);
  dense_.resize(count_ * size);
  for (std::size_t i = 0; i < count_; ++i) std::memcpy(dense_.data() + i * size, first_ + i * stride_, size);
  first_ = dense_.data();
  stride_ = size;

  const auto bytes_at = [&](int view_index, std::uint32_t offset) {
    const BufferView& view = document.views[static_cast<std::size_t>(view_index)];
    return document.buffers[view.buffer].data() + view.offset + offset;
  };
  const Accessor::Sparse& sparse = *accessor_.sparse;
  const std::byte* indices = bytes_at(sparse.indices_view, sparse.indices_offset);
  const std::byte* values = bytes_at(sparse.values_view, sparse.values_offset);
  const std::size_t index_bytes = component_type(sparse.indices_component_type).bytes;
  std::uint64_t next = 0;
  for (std::size_t i = 0; i < sparse.count; ++i) {
    const std::uint32_t target = read_unsigned(indices + i * index_bytes, index_bytes);
    if (target < next || target >= count_)
      report.fail(
          accessor_path(static_cast<std::size_t>(index_), ".sparse.indices"),
          fmt::format("index {} is {}, which is not above the index before or not below {}", i, target, count_));
    next = std::uint64_t{target} + 1;
    std::memcpy(dense_.data() + target * size, values + i * size, size);
  }
}

double AccessorReader::stored(std::size_t i, std::size_t c) const {
  const std::byte* bytes = at(i, c);
  switch (component_) {
    case kFloat:
      return read_as<float>(bytes);
    case kInt8:
    case kNormalizedInt8:
      return read_as<std::int8_t>(bytes);
    case kUint8:
    case kNormalizedUint8:
      return read_as<std::uint8_t>(bytes);
    case kInt16:
    case kNormalizedInt16:
      return read_as<std::int16_t>(bytes);
    case kUint16:
    case kNormalizedUint16:
      return read_as<std::uint16_t>(bytes);
    case kUint32:
      return read_as<std::uint32_t>(bytes);
  }
  return 0;
}

double AccessorReader::number(std::size_t i, std::size_t c) const {
  const double value = stored(i, c);
  switch (component_) {
    case kNormalizedInt8:
      return std::max(value / 127, -1.0);
    case kNormalizedUint8:
      return value / 255;
    case kNormalizedInt16:
      return std::max(value / 32767, -1.0);
    case kNormalizedUint16:
      return value / 65535;
    default:
      return value;
  }
}

float AccessorReader::finite(std::size_t i, std::size_t c) const {
  const auto value = static_cast<float>(number(i, c));
  if (!std::isfinite(value))
    report_.fail(accessor_path(static_cast<std::size_t>(index_)),
                 fmt::format("element {} of {} is not finite", i, use_));
  return value;
}

std::uint32_t AccessorReader::integer(std::size_t i, std::size_t c) const {
  return read_unsigned(at(i, c), component_bytes_);
}

void AccessorReader::check_vertex_alignment(Report& report) const {
  if (accessor_.view >= 0 && (start_ % 4 != 0 || (stride_ % 4 != 0 && !accessor_.sparse)))
    report.warn(accessor_path(static_cast<std::size_t>(index_)),
                "has vertices that do not start at multiples of 4 bytes");
}

void AccessorReader::compare_bounds(Report& report) const {
  // Exporters write these numbers with six digits.
  const auto differs = [](double said, double found) {
    return !(std::abs(said - found) <= 1e-5 * std::max(1.0, std::abs(found)));
  };
  const auto index = static_cast<std::size_t>(index_);
  if (!accessor_.min || !accessor_.max) report.warn(accessor_path(index), "has no min or no max");
  for (std::size_t c = 0; c < std::min<std::size_t>(component_count(accessor_.type), 3); ++c) {
    double least = stored(0, c);
    double most = least;
    for (std::size_t i = 1; i < count_; ++i) {
      least = std::min(least, stored(i, c));
      most = std::max(most, stored(i, c));
    }
    if (accessor_.min && differs((*accessor_.min)[c], least))
      report.warn(accessor_path(index, ".min"), "is not the minimum of the data");
    if (accessor_.max && differs((*accessor_.max)[c], most))
      report.warn(accessor_path(index, ".max"), "is not the maximum of the data");
  }
}

}  // namespace vestige::gltf
