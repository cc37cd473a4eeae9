#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>

namespace vestige {

/// SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014), eight bytes a generator. A
/// generator made from a seed, a collider and a turn number gives that turn's values independently of all turns before
/// it.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t collider = 0, std::uint64_t turn = 0)
      : state_(mix(mix(mix(seed) + collider) + turn)) {}

  std::uint64_t next() { return mix(state_ += kGamma); }

  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Returns a number below `count`. Precondition: `count` is not 0.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(next() % count); }

  /// Returns a uniformly distributed direction of length 1.
  glm::dvec3 direction() {
    const double z = uniform(-1, 1);
    const double angle = uniform(0, 2 * std::numbers::pi);
    const double around = std::sqrt(1 - z * z);
    return {around * std::cos(angle), z, around * std::sin(angle)};
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15;

  static std::uint64_t mix(std::uint64_t z) {
    z += kGamma;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace vestige
