#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "cli/options.hpp"

namespace vestige::cli {

/// Writes `bytes` to `path`, unless `path` is empty.
void write_bytes(const std::string& path, std::span<const std::byte> bytes, const CommonOptions& options);

/// Refuses an output that is named as what it is not: `path` ("-" and empty apart) must end in `extension`. `what` is
/// what is written, for the error, which names `flag`.
void check_extension(const char* flag, const std::string& path, std::string_view extension, std::string_view what);

}  // namespace vestige::cli
