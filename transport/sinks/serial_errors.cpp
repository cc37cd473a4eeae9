#include "transport/sinks/serial_errors.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "transport/sinks/serial_port.hpp"

namespace vestige {

namespace {

std::string list_candidates() {
  const std::vector<std::string> candidates = serial_candidates();
  if (candidates.empty()) return "this machine has no serial port; plug the vest in";
  return fmt::format("serial ports here: {}", fmt::join(candidates, ", "));
}

std::string group_name(gid_t id) {
  group entry{};
  group* found = nullptr;
  std::array<char, 4096> text{};
  if (::getgrgid_r(id, &entry, text.data(), text.size(), &found) == 0 && found != nullptr) return found->gr_name;
  return std::to_string(id);
}

Error permission_error(const std::string& path) {
  constexpr mode_t kGroupMay = S_IRGRP | S_IWGRP;
  struct stat status {};
  const bool known = ::stat(path.c_str(), &status) == 0;
  // A user should not join the group root for a serial port.
  if (!known || (status.st_mode & kGroupMay) != kGroupMay || status.st_gid == 0)
    return {path, "you have no permission to open this port",
            fmt::format("make yourself the owner: sudo chown $USER {}", path)};
  const std::string group = group_name(status.st_gid);
  return {path, fmt::format("you have no permission to open this port: it belongs to the group {}", group),
          fmt::format("join the group, then log out and in again: sudo usermod -aG {} $USER", group)};
}

}  // namespace

Error serial_open_error(const std::string& path, int number) {
  switch (number) {
    case EACCES:
    case EPERM:
      return permission_error(path);
    case EBUSY:
      return serial_busy_error(path);
    case ENOENT:
    case ENOTDIR:
      return {path, "there is no such device", list_candidates()};
    case ENODEV:
    case ENXIO:
    case EIO:
      return {path, "has no device behind it", list_candidates()};
    default:
      return {path, fmt::format("could not be opened: {}", std::generic_category().message(number)), ""};
  }
}

Error not_serial_error(const std::string& path) {
  return {path, "this is not a serial device", list_candidates()};
}

Error serial_busy_error(const std::string& path) {
  return {path, "busy: another program has it open",
          fmt::format("close that program (fuser -v {} names it), or use another port", path)};
}

}  // namespace vestige
