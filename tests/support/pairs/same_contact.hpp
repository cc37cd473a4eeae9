#pragma once

#include <bit>
#include <cstdint>

#include "detector/contact.hpp"

namespace vestige::test {

/// Whether two contacts agree in everything, t to the bit.
inline bool same(const Contact& a, const Contact& b) {
  return a.triangle == b.triangle && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t) &&
         a.actuator == b.actuator && a.side == b.side && a.barycentric == b.barycentric &&
         a.texture_coordinate == b.texture_coordinate && a.position == b.position && a.speed_m_per_s == b.speed_m_per_s;
}

}  // namespace vestige::test
