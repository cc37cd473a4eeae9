#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace vestige {

/// Places on a page are whole numbers of this length.
inline constexpr double kPageUnit_m = 1e-4;
/// The page leaves out what is farther than this from its origin along an axis.
inline constexpr double kPageReach_m = 2e5;

/// Where a frame stands: among the frames of the page, among those of the trace, and in time.
struct PageRow {
  std::uint32_t row = 0;
  std::uint64_t index = 0;
  double time_s = 0;
};

/// The arrays of a page, as analysis/view/page/data.js reads them. The bytes of all arrays lie one after the other, in
/// the order of `add`, and are deflated together.
///
/// An array of n numbers begins with the n lowest bytes, followed by the n bytes after them, and so on: bytes of one
/// weight are alike, so they deflate well. With `delta` = d, each number but the first d is stored as its difference to
/// the number d places before. Differences of integers wrap around.
///
/// Arrays of the trace. A row is a frame's place among the frames of the page, from 0 on.
///   frame_index         u32  the frame's number in the trace
///   time_ns             f64  whole nanoseconds
///   collider_id         u32  one for each column, ascending
///   track_first         u32  columns + 1: where the keys of each column begin in the arrays key_…
///   key_row             u32  ascending within a column
///   key_position        i32  x, y, z in `unit_m` of the head, from `origin_m`
///   key_radius          i32  in `unit_m`; 0 is a point
///   key_begins          u8   1: the collider appears or jumps here, and did not move here from the key before
/// Arrays of body i, counted from 1, after "body_i/".
///   position_bind       f32  x, y, z of each vertex
///   texture_coordinate  f32  u, v of each vertex
///   joint, weight       u16  four of each vertex: places in the palette, and shares of 65535
///   triangle            u32  three vertices
///   pose_row            u32  the rows of the poses kept
///   pose_begins         u8   1: there was no motion here from the pose kept before
///   pose_root           i32  x, y, z as key_position
///   pose_matrix         i16  for each entry of the palette four columns of three numbers, relative to the root.
///                            Of entry j, the first three columns are in steps of the head's matrix_step[2 j], the
///                            fourth in steps of matrix_step[2 j + 1]
/// Arrays of person i, counted from 1, after "person_i/". The person's `body` of the head counts from 0.
///   map_actuator        u16  the map's texels, row 0 at the top; 0: no actuator
///   contact_row, contact_collider, contact_triangle u32, contact_t f32, contact_barycentric f64 (u, v),
///   contact_position_m f64 (x, y, z in the world), contact_actuator u16, contact_side i8: every contact, exactly
///   duty_row u32, duty_actuator u16 (from 0), duty u8: every change of a duty, from 0 at the start
class PageArrays {
 public:
  template <typename Number>
  void add(const std::string& name, std::span<const Number> values, std::size_t delta = 0) {
    std::vector<Number> stored(values.begin(), values.end());
    for (std::size_t i = stored.size(); delta > 0 && i-- > delta;) stored[i] = difference(values[i], values[i - delta]);
    note(name, type_name<Number>(), stored.size(), delta);
    append(std::as_bytes(std::span(stored)), sizeof(Number));
  }
  template <typename Number>
  void add(const std::string& name, const std::vector<Number>& values, std::size_t delta = 0) {
    add(name, std::span<const Number>(values), delta);
  }

  /// What the head says about the arrays.
  const nlohmann::ordered_json& table() const { return table_; }
  std::size_t byte_count() const { return bytes_.size(); }
  /// Returns all bytes, deflated (RFC 1950) and as base64 (RFC 4648, section 4).
  std::string packed() const;

 private:
  template <typename Number>
  static Number difference(Number a, Number b) {
    if constexpr (std::is_integral_v<Number>) {
      using Bits = std::make_unsigned_t<Number>;
      return static_cast<Number>(static_cast<Bits>(static_cast<Bits>(a) - static_cast<Bits>(b)));
    } else {
      return a - b;
    }
  }
  template <typename Number>
  static std::string type_name() {
    const char kind = std::is_floating_point_v<Number> ? 'f' : std::is_signed_v<Number> ? 'i' : 'u';
    return kind + std::to_string(8 * sizeof(Number));
  }
  void note(const std::string& name, const std::string& type, std::size_t count, std::size_t delta);
  void append(std::span<const std::byte> bytes, std::size_t size);

  nlohmann::ordered_json table_ = nlohmann::ordered_json::object();
  std::vector<std::byte> bytes_;
};

}  // namespace vestige
