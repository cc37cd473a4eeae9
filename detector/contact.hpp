#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <limits>
#include <vector>

namespace vestige {

inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// The first contact of one collider's segment with the skin in one frame: one texel of the collision texture (HAVE
/// 2010 §III). `triangle == kNoTriangle` means no contact. Then t is +inf and all other members have no meaning.
struct Contact {
  std::uint32_t triangle = kNoTriangle;
  float t = std::numeric_limits<float>::infinity();  ///< 0 at the segment's start … 1 at its end
  std::uint16_t actuator = 0;                        ///< 0 if no actuator covers the skin here
  std::int8_t side = 0;                           ///< +1 entering (from the triangle's front), -1 leaving, 0 coplanar
  glm::dvec2 barycentric = glm::dvec2(0);         ///< u, v: weights of the triangle's second and third vertex
  glm::dvec2 texture_coordinate = glm::dvec2(0);  ///< as in the file: not wrapped into [0, 1]
  glm::dvec3 position = glm::dvec3(0);            ///< metres, relative to the frame's origin
  double speed_m_per_s = 0;                       ///< speed of the collider along the triangle's normal, never negative
  double depth_m = 0;                             ///< how deep a sphere is in the body at the frame's end; 0 … 2 r

  bool hit() const { return triangle != kNoTriangle; }
};

/// One row of the collision texture: one texel for each collider of the trace, in the order of the collider ids.
/// It remembers which texels may hold a contact, so that clearing a row costs what was touched and not what exists.
class ContactRow {
 public:
  ContactRow() = default;
  explicit ContactRow(std::size_t columns) : contacts_(columns) {}
  ContactRow(std::initializer_list<Contact> contacts) : contacts_(contacts), all_touched_(true) {}

  /// Makes this a row without contacts. References to its contacts must not be written to afterwards.
  void clear(std::size_t columns) {
    if (all_touched_ || columns != contacts_.size()) {
      contacts_.assign(columns, Contact());
    } else {
      for (const std::size_t column : touched_) contacts_[column] = Contact();
    }
    touched_.clear();
    all_touched_ = false;
  }

  std::size_t size() const { return contacts_.size(); }
  bool empty() const { return contacts_.empty(); }
  std::size_t hits() const { return static_cast<std::size_t>(std::ranges::count_if(contacts_, &Contact::hit)); }
  const Contact& operator[](std::size_t column) const { return contacts_[column]; }
  Contact& operator[](std::size_t column) {
    if (!touched_.empty() && touched_.back() == column) return contacts_[column];
    const std::size_t most = std::max<std::size_t>(16, contacts_.size() / 16);  // beyond, it is as well to clear all
    if (touched_.size() >= most) {
      all_touched_ = true;
    } else {
      touched_.push_back(column);
    }
    return contacts_[column];
  }
  auto begin() const { return contacts_.begin(); }
  auto end() const { return contacts_.end(); }
  auto begin() {
    all_touched_ = true;
    return contacts_.begin();
  }
  auto end() { return contacts_.end(); }

 private:
  std::vector<Contact> contacts_;
  std::vector<std::size_t> touched_;  ///< columns that were given out to be written to
  bool all_touched_ = false;          ///< then any texel may hold a contact
};

/// The values that a row can carry. A detector may leave the members of planes that were not requested at their
/// defaults.
enum class Plane : unsigned {
  kActuator = 1U << 0,  ///< the paper's texture; always present
  kTime = 1U << 1,
  kTriangle = 1U << 2,
  kBarycentric = 1U << 3,
  kTextureCoordinate = 1U << 4,
  kPosition = 1U << 5,
  kSpeed = 1U << 6,
  kSide = 1U << 7,
  kPressure = 1U << 8,  ///< pressure for a pneumatic cell, derived from the speed (`pressure_of`)
  kDepth = 1U << 9,     ///< of spheres (`with_depth`)
};

class PlaneSet {
 public:
  constexpr PlaneSet() = default;
  constexpr PlaneSet(Plane plane) : bits_(static_cast<unsigned>(plane) | 1U) {}
  constexpr bool has(Plane plane) const { return (bits_ & static_cast<unsigned>(plane)) != 0; }
  constexpr unsigned bits() const { return bits_; }
  constexpr unsigned count() const { return static_cast<unsigned>(std::popcount(bits_)); }
  friend constexpr PlaneSet operator|(PlaneSet a, PlaneSet b) {
    PlaneSet both;
    both.bits_ = a.bits_ | b.bits_;
    return both;
  }
  /// The first `count` planes in the order of `Plane`. Precondition: 1 <= count <= 10.
  static constexpr PlaneSet first(unsigned count) {
    PlaneSet set;
    set.bits_ = (1U << count) - 1;
    return set;
  }
  static constexpr PlaneSet all() { return first(10); }
  /// All of these planes but one, which is not `kActuator`.
  constexpr PlaneSet without(Plane plane) const {
    PlaneSet set;
    set.bits_ = bits_ & ~static_cast<unsigned>(plane);
    return set;
  }
  friend constexpr bool operator==(PlaneSet, PlaneSet) = default;

 private:
  unsigned bits_ = 1;
};

constexpr PlaneSet operator|(Plane a, Plane b) {
  return PlaneSet(a) | PlaneSet(b);
}

/// The planes that `texture_hash` reads.
inline constexpr PlaneSet kHashedPlanes = Plane::kTime | Plane::kTriangle;

}  // namespace vestige
