#pragma once

#include <cstdlib>
#include <string_view>

namespace vestige::test {

/// Returns true if long tests take all of their steps (VESTIGE_LONG=1, as .ci/thorough sets it). Otherwise a test whose
/// steps are alike takes a part of them.
inline bool is_long() {
  const char* text = std::getenv("VESTIGE_LONG");
  return text != nullptr && std::string_view(text) == "1";
}

}  // namespace vestige::test
