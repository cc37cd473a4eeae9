#pragma once

#include <string>

#include "traces/mcap/record.hpp"

namespace vestige {

/// Describes the metadata record `recovered` of a file as one clause: "was recovered from a damaged file: 12 messages
/// lost, 3 not verified by a CRC".
std::string describe_recovered(const mcap::StringMap& metadata);

}  // namespace vestige
