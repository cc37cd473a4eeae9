#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "cli/options.hpp"

namespace vestige::cli {

/// Writes `bytes` to `path`, unless `path` is empty.
void write_bytes(const std::string& path, std::span<const std::byte> bytes, const CommonOptions& options);

/// The same for several files, none of which takes its name before all are written.
void write_together(std::initializer_list<std::pair<std::string, std::span<const std::byte>>> files,
                    const CommonOptions& options);

/// Refuses an output that is named as what it is not: `path` ("-" and empty apart) must end in `extension`. `what` is
/// what is written, for the error, which names `flag`.
void check_extension(const char* flag, const std::string& path, std::string_view extension, std::string_view what);

}  // namespace vestige::cli
