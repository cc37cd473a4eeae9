#pragma once

#include <string>

#include "traces/base/error.hpp"

namespace vestige {

/// Returns an error with the reason why a serial port could not be opened, and a remedy. `number` is the `errno` of
/// `open`.
Error serial_open_error(const std::string& path, int number);
Error not_serial_error(const std::string& path);
Error serial_busy_error(const std::string& path);

}  // namespace vestige
