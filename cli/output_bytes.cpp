#include "cli/output_bytes.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace vestige::cli {

void write_bytes(const std::string& path, std::span<const std::byte> bytes, const CommonOptions& options) {
  if (path.empty()) return;
  OutputFile file(path, options.overwrite());
  file.write(bytes);
  file.commit();
}

void check_extension(const char* flag, const std::string& path, std::string_view extension, std::string_view what) {
  if (path.empty() || path == "-" || std::filesystem::path(path).extension() == extension) return;
  throw UsageError(flag, fmt::format("'{}' does not end in {}", path, extension),
                   fmt::format("what is written is {}", what));
}

}  // namespace vestige::cli
