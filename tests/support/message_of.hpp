#pragma once

#include <functional>
#include <string>

#include "traces/base/error.hpp"

namespace vestige::test {

/// What the `Error` that `call` throws says.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace vestige::test
