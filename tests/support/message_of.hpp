#pragma once

#include <functional>
#include <string>

#include "traces/base/error.hpp"

namespace vestige::test {

/// Returns the message of the `Error` that `call` throws, or "no error".
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace vestige::test
