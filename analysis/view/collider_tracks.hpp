#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <span>
#include <vector>

#include "analysis/view/page_data.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Thins the ways of colliders for the eye. A key is kept where a straight, even motion from the key before would miss
/// a sample between by more than `kTolerance_m` along an axis. So a collider that flies straight has two keys. Where a
/// collider appears, jumps (teleport), or the trace has a gap, a new way begins.
class ColliderTracks {
 public:
  static constexpr double kTolerance_m = 0.25e-3;
  /// How far a drawn collider can be from its place in the trace: tolerance and rounding along three axes.
  static constexpr double kError_m = 1.7320508 * (kTolerance_m + kPageUnit_m / 2);

  /// `ids`: all colliders of the trace, ascending.
  explicit ColliderTracks(std::span<const std::uint32_t> ids);

  /// Takes the colliders of the next frame, of which those with other ids are ignored.
  void add(const PageRow& at, const TraceFrame& frame, const glm::dvec3& origin_m);
  /// How many places of colliders cannot be drawn: not finite, or out of the page's reach.
  std::size_t left_out() const { return left_out_; }
  /// Ends all ways and adds the arrays of `PageArrays`.
  void finish(PageArrays& arrays);

 private:
  struct Sample {
    PageRow at;
    glm::dvec4 place = glm::dvec4(0);  ///< x, y, z and radius, in metres
  };
  struct Key {
    std::uint32_t row = 0;
    std::array<std::int32_t, 4> place = {};
    bool begins = false;
  };
  struct Track {
    std::vector<Key> keys;
    Sample anchor;  ///< of the last key
    Sample last;
    /// The velocities from the anchor that miss no sample since.
    glm::dvec4 low = glm::dvec4(-std::numeric_limits<double>::infinity());
    glm::dvec4 high = glm::dvec4(std::numeric_limits<double>::infinity());
  };

  static void keep(Track& track, const Sample& sample, bool begins);
  static void extend(Track& track, const Sample& sample);
  static void end(Track& track);

  std::vector<std::uint32_t> ids_;
  std::vector<Track> tracks_;
  std::size_t left_out_ = 0;
};

}  // namespace vestige
