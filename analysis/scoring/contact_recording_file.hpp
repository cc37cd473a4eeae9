#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/scoring/contact_recording.hpp"

namespace vestige {

/// A trace's contacts, and whose they are.
struct RecordedTrace {
  ContactRecording contacts;
  std::vector<std::uint32_t> collider_ids;  ///< ascending; a contact's column is the rank of its collider in it
};

/// Writes `frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s`: a row for each contact, and
/// one for each frame without any, whose fields from `collider` on are empty, so that all times are there. Frames count
/// from 0 as they stand in the recording; floats in the shortest form that reads back to the same bits. An existing
/// file is replaced.
void write_contact_recording(const std::string& path, const RecordedTrace& trace);

/// Reads it back: equal contacts and times; `collider_ids` are those that touched something. Throws `Error` naming file
/// and line.
RecordedTrace read_contact_recording(const std::string& path);

}  // namespace vestige
