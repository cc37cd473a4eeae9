#include "cli/output_bytes.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/files/output_file.hpp"

namespace vestige::cli {

void write_bytes(const std::string& path, std::span<const std::byte> bytes, const CommonOptions& options) {
  if (path.empty()) return;
  OutputFile file(path, options.overwrite());
  file.write(bytes);
  file.commit();
}

void write_together(std::initializer_list<std::pair<std::string, std::span<const std::byte>>> files,
                    const CommonOptions& options) {
  std::vector<std::unique_ptr<OutputFile>> written;
  for (const auto& [path, bytes] : files) {
    if (path.empty()) continue;
    written.push_back(std::make_unique<OutputFile>(path, options.overwrite()));
    written.back()->write(bytes);
    written.back()->flush();
  }
  for (const auto& file : written) file->commit();
}

void check_extension(const char* flag, const std::string& path, std::string_view extension, std::string_view what) {
  if (path.empty() || path == "-" || std::filesystem::path(path).extension() == extension) return;
  throw UsageError(flag, fmt::format("'{}' does not end in {}", path, extension),
                   fmt::format("the output is {}: end the name in {}", what, extension));
}

}  // namespace vestige::cli
