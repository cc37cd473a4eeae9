#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "traces/gltf/gltf_document.hpp"

namespace vestige::gltf {

/// Component types, to be combined into a set. kNormalized… types represent [0, 1] or [-1, 1] (glTF 2.0 §3.11).
enum Component : unsigned {
  kFloat = 1U << 0,
  kInt8 = 1U << 1,
  kUint8 = 1U << 2,
  kInt16 = 1U << 3,
  kUint16 = 1U << 4,
  kUint32 = 1U << 5,
  kNormalizedInt8 = 1U << 6,
  kNormalizedUint8 = 1U << 7,
  kNormalizedInt16 = 1U << 8,
  kNormalizedUint16 = 1U << 9,
};

/// The format that a use of an accessor requires.
struct Format {
  int type = 0;             ///< TINYGLTF_TYPE_…
  unsigned components = 0;  ///< a set of `Component`
};

/// Returns the format of vertex positions, and of displacements of morph targets: VEC3 of float, or also of small
/// integers if KHR_mesh_quantization allows them.
Format position_format(const Document& document);

/// Checks, without reading data, that all accessors lie inside their buffer views and all buffer views inside their
/// buffers, including sparse ones. Fails with the name of the accessor.
void check_accessors(const Document& document, Report& report);

/// Fails, with the name `use`, if the accessor's elements are interleaved with others, as only those of vertex
/// attributes may be (glTF 2.0 §3.6.2.1). Warns of a byteStride that equals the element's size.
void refuse_stride(const Document& document, int accessor, std::string_view use, Report& report);

/// Random access to the elements of an accessor. Handles strides, sparse substitution, missing data (zeros) and
/// normalisation. Keeps a reference to the document's buffers.
class AccessorReader {
 public:
  /// `use` names the accessor's purpose in errors. Fails if the accessor does not have `format`, or if its sparse
  /// indices are not strictly increasing or exceed its count.
  AccessorReader(const Document& document, int accessor, const Format& format, std::string_view use,
                 const Report& report);

  std::size_t count() const { return count_; }

  /// Returns component `c` of element `i`, normalised if the accessor is. Components of matrices count column by
  /// column.
  double number(std::size_t i, std::size_t c) const;
  /// Like `number`, but rounded once. Fails at `use` if the result is not finite.
  float finite(std::size_t i, std::size_t c) const;
  /// Like `number`, but for kUint8, kUint16 and kUint32.
  std::uint32_t integer(std::size_t i, std::size_t c) const;

  /// Warns if elements do not start at multiples of 4 bytes, as vertex attributes must (glTF 2.0 §3.6.2.4).
  void check_vertex_alignment(Report& report) const;

  /// Warns if the file's min or max is missing or differs from the data. That is wrong but harmless, because nothing
  /// relies on these values.
  void compare_bounds(Report& report) const;

 private:
  const std::byte* at(std::size_t i, std::size_t c) const { return first_ + i * stride_ + c * component_bytes_; }
  double stored(std::size_t i, std::size_t c) const;
  void substitute_sparse(const Document& document, const Report& report);

  const Accessor& accessor_;
  int index_ = 0;
  std::string use_;
  const Report& report_;
  const std::byte* first_ = nullptr;
  std::size_t stride_ = 0;
  std::uint64_t start_ = 0;  ///< offset of the accessor in its buffer
  std::size_t count_ = 0;
  std::size_t component_bytes_ = 0;
  Component component_ = kFloat;
  std::vector<std::byte> dense_;  ///< the elements after sparse substitution
};

}  // namespace vestige::gltf
