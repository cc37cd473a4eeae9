#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "detector/detector.hpp"
#include "detector/gl/gl_functions.hpp"

namespace vestige {

/// A headless OpenGL 4.5 core context, with its own function table. Several may live in one thread: `make_current` lets
/// go of the one before, which Mesa's EGL and OSMesa, sharing one dispatch table, need.
class GlContext {
 public:
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  void make_current();
  const GlFunctions& gl() const { return functions_; }
  const GlInfo& info() const { return info_; }

 protected:
  GlContext() = default;
  /// Loads all functions and reads the driver's names; throws `Error` when one is missing or the version is below 4.5.
  void load(std::string name, const std::function<void*(const char*)>& address_of);
  /// For destructors: lets go of the context if it is current.
  void leave();

  virtual void bind() = 0;
  virtual void unbind() = 0;

 private:
  GlFunctions functions_;
  GlInfo info_;
};

enum class ContextKind {
  kAuto,  ///< the first that works of: EGL device with hardware, EGL surfaceless, EGL software device, OSMesa
  kEgl,   ///< the same without OSMesa
  kOsMesa,
};

/// `device`: -1, or the number of an EGL device (EGL_EXT_device_enumeration) as `list_egl_devices` counts them. Throws
/// `Error` saying what was tried, what each answered, and what to install.
std::unique_ptr<GlContext> make_gl_context(ContextKind kind, int device);

struct EglDevice {
  bool software = false;
  std::string name;  ///< what the driver calls it; may be empty
};

/// The EGL devices of this machine; empty where EGL is missing or cannot enumerate.
std::vector<EglDevice> list_egl_devices();

/// One attempt each; throw `Error` on failure.
std::unique_ptr<GlContext> make_egl_surfaceless_context();
std::unique_ptr<GlContext> make_egl_device_context(int device);
std::unique_ptr<GlContext> make_osmesa_context();

}  // namespace vestige
