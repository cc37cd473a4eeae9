#include "detector/gl/gl_context.hpp"

#include <fmt/format.h>

#include <utility>

#include "traces/error.hpp"

namespace vestige {

namespace {

thread_local GlContext* current_context = nullptr;

constexpr const char* kRemedy =
    "install a software renderer (apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6), or the GPU's "
    "driver; "
    "'vestige devices' lists what this machine offers. --detector cpu needs no OpenGL";

std::string text_of(const GLubyte* text) {
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

}  // namespace

void GlContext::make_current() {
  if (current_context == this) return;
  if (current_context != nullptr) current_context->unbind();
  current_context = nullptr;
  bind();
  current_context = this;
}

void GlContext::leave() {
  if (current_context != this) return;
  unbind();
  current_context = nullptr;
}

void GlContext::load(std::string name, const std::function<void*(const char*)>& address_of) {
#define VESTIGE_GL_LOAD(type, function)                                     \
  functions_.function = reinterpret_cast<type>(address_of("gl" #function)); \
  if (functions_.function == nullptr)                                       \
    throw Error(name, "the driver has no gl" #function, "OpenGL 4.5 is needed: use a newer driver");
  VESTIGE_GL_FUNCTIONS(VESTIGE_GL_LOAD)
#undef VESTIGE_GL_LOAD
  info_ = {std::move(name), text_of(functions_.GetString(GL_RENDERER)), text_of(functions_.GetString(GL_VERSION))};
  GLint major = 0;
  GLint minor = 0;
  functions_.GetIntegerv(GL_MAJOR_VERSION, &major);
  functions_.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45)
    throw Error(info_.context, fmt::format("offers OpenGL {}.{} ({}); 4.5 is needed", major, minor, info_.renderer),
                "use a newer driver, or another --context");
}

std::unique_ptr<GlContext> make_gl_context(ContextKind kind, int device) {
  if (kind == ContextKind::kOsMesa) return make_osmesa_context();
  if (device >= 0) return make_egl_device_context(device);

  const std::vector<EglDevice> devices = list_egl_devices();
  std::vector<std::function<std::unique_ptr<GlContext>()>> attempts;
  const auto add_devices = [&](bool software) {
    for (int i = 0; i < static_cast<int>(devices.size()); ++i)
      if (devices[static_cast<std::size_t>(i)].software == software)
        attempts.emplace_back([i] { return make_egl_device_context(i); });
  };
  add_devices(false);
  attempts.emplace_back(make_egl_surfaceless_context);
  add_devices(true);
  if (kind == ContextKind::kAuto) attempts.emplace_back(make_osmesa_context);

  std::string failures;
  for (const auto& attempt : attempts) {
    try {
      return attempt();
    } catch (const Error& error) {
      std::string_view line = error.what();
      failures += fmt::format("\n  tried {}", line.substr(0, line.find('\n')));
    }
  }
  throw Error("--context", "no OpenGL 4.5 context is to be had on this machine" + failures, kRemedy);
}

}  // namespace vestige
