#pragma once

#include <string>

#include "traces/base/error.hpp"

namespace vestige {

/// Why a serial port could not be opened, and what to do, from the `errno` that `open` left.
Error serial_open_error(const std::string& path, int number);
Error not_serial_error(const std::string& path);
Error serial_busy_error(const std::string& path);

}  // namespace vestige
