#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "detector/gl/gl_context.hpp"

namespace vestige {

/// A limit of the driver that the detectors meet.
struct GlLimit {
  const char* name;     ///< in JSON
  const char* meaning;  ///< for people
  std::int64_t value;
  std::int64_t needed;  ///< by `paper`; 0: a smaller one costs speed or size, and works
};

/// The limits of a context, which is made current.
std::vector<GlLimit> gl_limits(GlContext& context);

}  // namespace vestige
