#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "detector/gl/gl_context.hpp"

namespace vestige {

/// A limit of the driver that affects the detectors.
struct GlLimit {
  const char* name;     ///< in JSON
  const char* meaning;  ///< for people
  std::int64_t value;
  std::int64_t needed;  ///< minimum for `paper`; 0 if a smaller value works but costs speed or size
};

/// Makes the context current and returns its limits.
std::vector<GlLimit> gl_limits(GlContext& context);

}  // namespace vestige
