#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vestige {

/// Reads a whole regular file ("-": standard input). Throws `Error`: missing, unreadable, a folder, or larger than
/// `limit_bytes`.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t limit_bytes = std::uint64_t{1} << 32);

/// `read_file`, as text.
std::string read_text_file(const std::filesystem::path& path, std::uint64_t limit_bytes = std::uint64_t{1} << 32);

}  // namespace vestige
