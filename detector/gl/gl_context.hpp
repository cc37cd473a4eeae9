#pragma once

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
  /// Makes a new context current, loads all functions and reads the driver's names; throws `Error` when one is missing
  /// or the version is below 4.5. Called once the object is whole, so that its destructor lets go after a failure.
  static std::unique_ptr<GlContext> loaded(std::unique_ptr<GlContext> context, std::string name);
  /// For destructors: lets go of the context if it is current.
  void leave();

  virtual void bind() = 0;
  virtual void unbind() = 0;
  virtual void* address_of(const char* function) const = 0;

 private:
  GlFunctions functions_;
  GlInfo info_;
};

/// The functions of a context that it makes current: for members that are made with them.
const GlFunctions& current_gl(GlContext& context);

enum class ContextKind {
  kAuto,  ///< the first that works of: EGL device with hardware, EGL surfaceless, EGL software device, OSMesa
  kEgl,   ///< the same without OSMesa
  kOsMesa,
};

/// `device`: -1, or the number of an EGL device (EGL_EXT_device_enumeration) as `list_egl_devices` counts them. Throws
/// `Error` saying what was tried, what each answered, and what to install.
std::unique_ptr<GlContext> make_gl_context(ContextKind kind, int device);

/// An EGL device, as far as its driver speaks of it: what it does not say is empty.
struct EglDevice {
  bool software = false;
  std::string vendor;
  std::string drm_node;     ///< "/dev/dri/card0"
  std::string render_node;  ///< "/dev/dri/renderD128"
  int cuda_device = -1;     ///< its number in CUDA, or -1
  std::string extensions;   ///< EGL_EXTENSIONS of the device
};

/// The EGL devices of this machine; empty where EGL is missing or cannot enumerate.
std::vector<EglDevice> list_egl_devices();

/// Whether a renderer of this name draws on the processor: llvmpipe, softpipe, swrast, SWR, lavapipe, SwiftShader.
bool is_software_renderer(std::string_view renderer);

/// One attempt each; throw `Error` on failure.
std::unique_ptr<GlContext> make_egl_surfaceless_context();
std::unique_ptr<GlContext> make_egl_device_context(int device);
std::unique_ptr<GlContext> make_osmesa_context();

}  // namespace vestige
