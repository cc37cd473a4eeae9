#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "detector/detector.hpp"
#include "detector/gl/gl_functions.hpp"

namespace vestige {

/// A headless OpenGL 4.5 core context with its own function table. Several contexts may live in one thread.
/// `make_current` first releases the previous context: Mesa's EGL and OSMesa need this because they share one dispatch
/// table.
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
  /// Makes a new context current, loads all functions, reads the driver's names and measures the shaders' arithmetic.
  /// Throws `Error` if a function is missing or the version is below 4.5. Call it when the object is complete, so that
  /// its destructor releases the context after a failure.
  static std::unique_ptr<GlContext> loaded(std::unique_ptr<GlContext> context, std::string name);
  /// For destructors: releases the context if it is current.
  void leave();

  virtual void bind() = 0;
  virtual void unbind() = 0;
  virtual void* address_of(const char* function) const = 0;

 private:
  GlFunctions functions_;
  GlInfo info_;
};

/// Makes a context current and returns its functions: for members whose constructors need them.
const GlFunctions& current_gl(GlContext& context);

enum class ContextKind {
  kAuto,  ///< the first that works of: EGL device with hardware, EGL surfaceless, EGL software device, OSMesa
  kEgl,   ///< the same list without OSMesa
  kOsMesa,
};

/// `device` is -1, or the number of an EGL device (EGL_EXT_device_enumeration) in the order of `list_egl_devices`.
/// Throws `Error` if no context can be made. The error lists each attempt, its failure, and the packages to install.
std::unique_ptr<GlContext> make_gl_context(ContextKind kind, int device);

/// An EGL device, as its driver describes it. Values that the driver does not report are empty.
struct EglDevice {
  bool software = false;
  std::string vendor;
  std::string drm_node;     ///< "/dev/dri/card0"
  std::string render_node;  ///< "/dev/dri/renderD128"
  int cuda_device = -1;     ///< its number in CUDA, or -1
  std::string extensions;   ///< EGL_EXTENSIONS of the device
};

/// Returns the EGL devices of this machine; empty if EGL is missing or cannot enumerate devices.
std::vector<EglDevice> list_egl_devices();

/// Returns whether a renderer with this name runs on the CPU: llvmpipe, softpipe, swrast, SWR, lavapipe, SwiftShader.
bool is_software_renderer(std::string_view renderer);

/// Each function makes one attempt and throws `Error` on failure.
std::unique_ptr<GlContext> make_egl_surfaceless_context();
std::unique_ptr<GlContext> make_egl_device_context(int device);
std::unique_ptr<GlContext> make_osmesa_context();

}  // namespace vestige
