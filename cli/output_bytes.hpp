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

/// Writes several files. The files get their final names only when all are written.
void write_together(std::initializer_list<std::pair<std::string, std::span<const std::byte>>> files,
                    const CommonOptions& options);

/// Throws `UsageError` if `path` does not end in `extension`, unless `path` is "-" or empty. The error names `flag`,
/// and describes the output as `what`.
void check_extension(const char* flag, const std::string& path, std::string_view extension, std::string_view what);

}  // namespace vestige::cli
