#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/actuators/posed_places.hpp"
#include "detector/contact.hpp"

namespace vestige {

/// For each contact of a recording, the actuators of one map whose places its sphere covers
/// (`LocatedContact::covered`).
struct CoveredPlaces {
  std::vector<std::size_t> first = {0};  ///< contacts + 1: those of contact i are [first[i], first[i + 1])
  std::vector<CoveredPlace> places;

  std::span<const CoveredPlace> of(std::size_t contact) const {
    return std::span(places).subspan(first[contact], first[contact + 1] - first[contact]);
  }
};

/// All contacts of one trace, and nothing else of the trace. They are computed once and judged under every map and law.
struct ContactRecording {
  std::vector<double> time_s;         ///< one for each frame, ascending
  std::vector<std::size_t> first;     ///< frames + 1: the contacts of frame k are [first[k], first[k + 1])
  std::vector<std::uint32_t> column;  ///< for each contact, its collider's rank; ascending within a frame
  std::vector<Contact> contacts;      ///< with `kRecordedPlanes`; `actuator` is looked up under each map

  std::size_t frames() const { return time_s.size(); }

  /// Adds a frame, and the contacts of its row. Times must ascend.
  void add(double frame_time_s, std::span<const Contact> row);
};

/// The planes that the rows must carry.
inline constexpr PlaneSet kRecordedPlanes =
    kHashedPlanes | Plane::kBarycentric | Plane::kTextureCoordinate | Plane::kSpeed | Plane::kSide | Plane::kDepth;

}  // namespace vestige
