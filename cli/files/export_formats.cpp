#include "cli/files/export_formats.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "traces/base/error.hpp"

namespace vestige::cli {

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> all = {{"csv", {".csv"}},
                                                {"ndjson", {".ndjson", ".jsonl"}},
                                                {"hdf5", {".h5", ".hdf5"}},
                                                {"gltf", {".glb"}},
                                                {"paraview", {".pvd"}}};
  return all;
}

void check_trace_name(const std::string& path) {
  std::vector<std::string_view> others = {".bvh", ".exr", ".gltf", ".html", ".json", ".png", ".svg", ".txt", ".zip"};
  for (const ExportFormat& format : export_formats())
    others.insert(others.end(), format.ends.begin(), format.ends.end());
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  for (const std::string_view other : others)
    if (extension == other)
      throw UsageError("-o", fmt::format("'{}' ends in {}, and a trace is an MCAP file", path, extension),
                       "end the name in .mcap; 'vestige export' turns a trace into other formats");
}

}  // namespace vestige::cli
