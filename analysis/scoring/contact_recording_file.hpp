#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/scoring/contact_recording.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// A trace's contacts and colliders.
struct RecordedTrace {
  ContactRecording contacts;
  std::vector<std::uint32_t> collider_ids;  ///< ascending; a contact's column is the rank of its collider in this list
  ColliderShape shape = ColliderShape::kPoints;
  /// By the map's name. Not empty if a law needs it; then all contacts are of spheres or points among spheres.
  std::map<std::string, CoveredPlaces> covered;
};

/// Writes `frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s`, a row for each contact; if the
/// colliders are spheres, also `depth_m`, and `covered` if that was asked for: MAP:ACTUATOR:DEPTH for each actuator,
/// from 1 on, whose place on the skin the sphere covers, with blanks between. A frame without contacts also gets a row,
/// so that all times are in the file. The row's fields from `collider` on are empty. Frames count from 0 in the order
/// of the recording. Floats have the shortest form that reads back to the same bits. An existing file is replaced.
void write_contact_recording(const std::string& path, const RecordedTrace& trace);

/// Reads the file back with equal contacts and times. `collider_ids` holds only the colliders that touched something.
/// Throws `Error` with file and line.
RecordedTrace read_contact_recording(const std::string& path);

}  // namespace vestige
