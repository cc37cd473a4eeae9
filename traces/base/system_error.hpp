#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "traces/base/error.hpp"

namespace vestige {

/// Returns the name of `path` for messages: "standard output" if it is "-".
std::string shown_name(const std::filesystem::path& path);

/// Returns the error of a failed system call on `path`. `doing` says what failed ("could not write"), `error_number` is
/// errno. The error has a remedy for: no permission, disk full, no such folder, a folder in place of a file.
Error system_error(const std::filesystem::path& path, std::string_view doing, int error_number);

}  // namespace vestige
