#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>

#include "detector/gl/debug_messages.hpp"
#include "detector/gl/gl_context.hpp"
#include "traces/base/error.hpp"
#include "traces/base/shared_library.hpp"

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

namespace vestige {

namespace {

struct EglFunctions {
  PFNEGLGETPROCADDRESSPROC GetProcAddress = nullptr;
  PFNEGLGETERRORPROC GetError = nullptr;
  PFNEGLQUERYSTRINGPROC QueryString = nullptr;
  PFNEGLINITIALIZEPROC Initialize = nullptr;
  PFNEGLBINDAPIPROC BindAPI = nullptr;
  PFNEGLCREATECONTEXTPROC CreateContext = nullptr;
  PFNEGLDESTROYCONTEXTPROC DestroyContext = nullptr;
  PFNEGLMAKECURRENTPROC MakeCurrent = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;            // null without EGL_EXT_device_enumeration
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;  // likewise
  PFNEGLQUERYDEVICEATTRIBEXTPROC QueryDeviceAttrib = nullptr;  // likewise

  EglFunctions() {
    const SharedLibrary library("libEGL.so.1");
    library.find("eglGetProcAddress", GetProcAddress);
    library.find("eglGetError", GetError);
    library.find("eglQueryString", QueryString);
    library.find("eglInitialize", Initialize);
    library.find("eglBindAPI", BindAPI);
    library.find("eglCreateContext", CreateContext);
    library.find("eglDestroyContext", DestroyContext);
    library.find("eglMakeCurrent", MakeCurrent);
    GetPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(GetProcAddress("eglGetPlatformDisplayEXT"));
    if (GetPlatformDisplay == nullptr)
      throw Error("libEGL.so.1", "has no eglGetPlatformDisplayEXT", "use a newer version of it");
    QueryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(GetProcAddress("eglQueryDevicesEXT"));
    QueryDeviceString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(GetProcAddress("eglQueryDeviceStringEXT"));
    QueryDeviceAttrib = reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(GetProcAddress("eglQueryDeviceAttribEXT"));
  }
};

/// Opened once, at first use. If that fails, every use throws again.
const EglFunctions& egl() {
  static const EglFunctions functions;
  return functions;
}

Error egl_error(const std::string& context, std::string_view what) {
  return Error(context, fmt::format("{} failed (EGL error {:#06x})", what, egl().GetError()), "");
}

std::vector<EGLDeviceEXT> query_devices() {
  if (egl().QueryDevices == nullptr || egl().QueryDeviceString == nullptr) return {};
  std::array<EGLDeviceEXT, 64> devices = {};
  EGLint count = 0;
  if (egl().QueryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) return {};
  // Not with braces: iterators are pointers here, and would become a list of two devices.
  return std::vector<EGLDeviceEXT>(devices.begin(), devices.begin() + count);
}

std::string device_string(EGLDeviceEXT device, EGLint name) {
  const char* text = egl().QueryDeviceString(device, name);
  return text == nullptr ? "" : text;
}

/// Queries only what the driver's extensions promise: some drivers crash on other names.
EglDevice describe_device(EGLDeviceEXT device) {
  EglDevice found;
  found.extensions = device_string(device, EGL_EXTENSIONS);
  const std::string padded = " " + found.extensions + " ";
  const auto offers = [&](const std::string& extension) {
    return padded.find(" " + extension + " ") != std::string::npos;
  };
  found.software = offers("EGL_MESA_device_software");
  if (offers("EGL_EXT_device_query_name")) found.vendor = device_string(device, EGL_VENDOR);
  if (offers("EGL_EXT_device_drm")) found.drm_node = device_string(device, EGL_DRM_DEVICE_FILE_EXT);
  if (offers("EGL_EXT_device_drm_render_node")) found.render_node = device_string(device, EGL_DRM_RENDER_NODE_FILE_EXT);
  EGLAttrib cuda = 0;
  if (offers("EGL_NV_device_cuda") && egl().QueryDeviceAttrib != nullptr &&
      egl().QueryDeviceAttrib(device, EGL_CUDA_DEVICE_NV, &cuda) == EGL_TRUE)
    found.cuda_device = static_cast<int>(cuda);
  return found;
}

class EglContext final : public GlContext {
 public:
  EglContext(const std::string& name, EGLenum platform, void* native) {
    display_ = egl().GetPlatformDisplay(platform, native, nullptr);
    if (display_ == EGL_NO_DISPLAY) throw egl_error(name, "eglGetPlatformDisplay");
    // The process shares displays, and may initialise one several times. Displays are never terminated, because another
    // context may still use the same one.
    if (egl().Initialize(display_, nullptr, nullptr) != EGL_TRUE) throw egl_error(name, "eglInitialize");
    if (egl().BindAPI(EGL_OPENGL_API) != EGL_TRUE) throw egl_error(name, "eglBindAPI(EGL_OPENGL_API)");
    // A driver promises messages in a debug context only, and an old EGL makes none.
    if (gl_messages_wanted()) create(EGL_CONTEXT_OPENGL_DEBUG);
    if (context_ == EGL_NO_CONTEXT) create(EGL_NONE);
    if (context_ == EGL_NO_CONTEXT) throw egl_error(name, "eglCreateContext for OpenGL 4.5 core");
  }
  ~EglContext() override {
    leave();
    egl().DestroyContext(display_, context_);
  }
  static std::unique_ptr<GlContext> make(const std::string& name, EGLenum platform, void* native) {
    return loaded(std::make_unique<EglContext>(name, platform, native), name);
  }

 private:
  /// `last` is one more attribute to set, or EGL_NONE.
  void create(EGLint last) {
    const std::array<EGLint, 9> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              4,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              5,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              last,
                                              EGL_TRUE,
                                              EGL_NONE};
    context_ = egl().CreateContext(display_, EGLConfig(nullptr), EGL_NO_CONTEXT, attributes.data());
  }
  void bind() override {
    // The bound API is kept per thread, and others may have changed it.
    egl().BindAPI(EGL_OPENGL_API);
    if (egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE)
      throw egl_error("EGL", "eglMakeCurrent without a surface");
  }
  void unbind() override { egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  void* address_of(const char* function) const override {
    return reinterpret_cast<void*>(egl().GetProcAddress(function));
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::vector<EglDevice> list_egl_devices() {
  std::vector<EglDevice> found;
  try {
    for (EGLDeviceEXT device : query_devices()) found.push_back(describe_device(device));
  } catch (const Error&) {
    found.clear();  // without EGL there are no devices
  }
  return found;
}

std::unique_ptr<GlContext> make_egl_surfaceless_context() {
  return EglContext::make("egl-surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
}

std::unique_ptr<GlContext> make_egl_device_context(int device) {
  const std::vector<EGLDeviceEXT> devices = query_devices();
  if (device < 0 || static_cast<std::size_t>(device) >= devices.size())
    throw Error(fmt::format("--device {}", device),
                fmt::format("this machine has {} EGL device{}", devices.size(), devices.size() == 1 ? "" : "s"),
                "'vestige devices' lists them");
  return EglContext::make(fmt::format("egl-device-{}", device), EGL_PLATFORM_DEVICE_EXT,
                          devices[static_cast<std::size_t>(device)]);
}

}  // namespace vestige
