#include "traces/base/system_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

namespace vestige {

namespace {

std::string_view remedy_for(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "the disk is full: free some space, or write to another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to, or change its permissions";
    case ENOENT:
    case ENOTDIR:
      return "check the name, or create the folder first";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "";
  }
}

}  // namespace

std::string shown_name(const std::filesystem::path& path) {
  return path == "-" ? "standard output" : path.string();
}

Error system_error(const std::filesystem::path& path, std::string_view doing, int error_number) {
  return Error(shown_name(path), fmt::format("{}: {}", doing, std::strerror(error_number)), remedy_for(error_number));
}

}  // namespace vestige
