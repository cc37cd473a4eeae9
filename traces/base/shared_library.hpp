#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "traces/base/error.hpp"

namespace vestige {

/// A library opened at run time and never closed: drivers leave threads and exit handlers behind. RTLD_LOCAL keeps the
/// symbols of two GL libraries apart.
class SharedLibrary {
 public:
  /// Throws `Error` with the linker's words when the library cannot be opened.
  explicit SharedLibrary(const char* name) : name_(name), handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw Error(name_, fmt::format("cannot be opened: {}", ::dlerror()), "");
  }

  /// Throws `Error` when the library has no such function, or variable.
  template <typename Function>
  void find(const char* symbol, Function& function) const {
    function = reinterpret_cast<Function>(::dlsym(handle_, symbol));
    if (function == nullptr) throw Error(name_, fmt::format("has no {}", symbol), "use a newer version of it");
  }

 private:
  std::string name_;
  void* handle_;
};

}  // namespace vestige
