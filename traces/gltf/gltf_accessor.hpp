#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "traces/gltf/gltf_document.hpp"

namespace vestige::gltf {

/// Component kinds, to be combined into a set. kNormalized… stand for [0, 1] or [-1, 1] (glTF 2.0 §3.11).
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

/// What a use of an accessor demands of it.
struct Format {
  int type = 0;             ///< TINYGLTF_TYPE_…
  unsigned components = 0;  ///< a set of `Component`
};

/// Checks, without touching their data, that all accessors lie inside their buffer views and those inside their
/// buffers, sparse ones included. Fails naming the accessor.
void check_accessors(const Document& document, Report& report);

/// Random access to the elements of an accessor: strides, sparse substitution, missing data (zeros) and normalisation
/// are dealt with. Refers to the document's buffers.
class AccessorReader {
 public:
  /// `use` says in errors what the accessor is read for. Fails when it is not of `format`, or when its sparse indices
  /// are not strictly increasing or beyond its end.
  AccessorReader(const Document& document, int accessor, const Format& format, std::string_view use,
                 const Report& report);

  std::size_t count() const { return count_; }

  /// Component `c` of element `i`, normalised where the accessor is. Matrices count column by column.
  double number(std::size_t i, std::size_t c) const;
  /// The same, rounded once. Fails at `use` when it is not finite.
  float finite(std::size_t i, std::size_t c) const;
  /// The same for kUint8, kUint16 and kUint32.
  std::uint32_t integer(std::size_t i, std::size_t c) const;

  /// Warns when elements do not start at multiples of 4 bytes, as vertex attributes must (glTF 2.0 §3.6.2.4).
  void check_vertex_alignment(Report& report) const;

  /// Warns when the file's min or max is not that of the data, or is missing: wrong, but nothing relies on it.
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
  std::uint64_t start_ = 0;  ///< where in its buffer the accessor starts
  std::size_t count_ = 0;
  std::size_t component_bytes_ = 0;
  Component component_ = kFloat;
  std::vector<std::byte> dense_;  ///< the elements after sparse substitution
};

}  // namespace vestige::gltf
