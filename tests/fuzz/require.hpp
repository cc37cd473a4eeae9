#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <span>
#include <string>

namespace vestige::fuzz {

inline void require(bool condition, const char* promise) {
  if (condition) return;
  std::cerr << "broken promise: " << promise << '\n';
  std::abort();
}

/// One file, never on disk, for what reads files by name.
inline std::filesystem::path in_a_file(std::span<const std::byte> bytes) {
  static const int descriptor = ::memfd_create("fuzz", MFD_CLOEXEC);
  require(::ftruncate(descriptor, 0) == 0, "a file can be emptied");
  require(::pwrite(descriptor, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
          "a file can be written");
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace vestige::fuzz
