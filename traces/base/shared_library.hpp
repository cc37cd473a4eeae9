#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "traces/base/error.hpp"

namespace vestige {

/// A library opened at run time and never closed, because drivers leave threads and exit handlers behind. RTLD_LOCAL
/// keeps the symbols of two GL libraries apart.
class SharedLibrary {
 public:
  /// Throws `Error` with the linker's message if the library cannot be opened.
  explicit SharedLibrary(const char* name) : name_(name), handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw Error(name_, fmt::format("cannot be opened: {}", ::dlerror()), "");
  }

  /// Throws `Error` if the library has no function or variable of this name.
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
