#include "detector/gl/gl_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <utility>

#include "detector/gl/arithmetic_probe.hpp"
#include "detector/gl/debug_messages.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

thread_local GlContext* current_context = nullptr;

constexpr const char* kContextRemedy =
    "install a software renderer (apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6), or the GPU's "
    "driver; 'vestige devices' lists what this machine offers. --detector cpu needs no OpenGL";

std::string text_of(const GLubyte* text) {
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

/// Returns the start of a driver's message on one line.
std::string one_line(std::string_view message) {
  constexpr std::size_t kMostBytes = 300;
  std::string line;
  for (const char c : message) {
    const bool is_blank = static_cast<unsigned char>(c) <= ' ';
    if (!is_blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  if (line.ends_with(' ')) line.pop_back();
  if (line.size() > kMostBytes) line.replace(kMostBytes - 3, std::string::npos, "...");
  return line;
}

/// Mesa may serve a GPU's device with its software renderer. That renderer must not win over another device's GPU.
std::unique_ptr<GlContext> make_hardware_context(int device) {
  if (list_egl_devices()[static_cast<std::size_t>(device)].software)
    throw Error(fmt::format("egl-device-{}", device), "is a software renderer", "");
  auto context = make_egl_device_context(device);
  if (context->info().software) throw Error(context->info().context, "uses a software renderer", "");
  return context;
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

std::unique_ptr<GlContext> GlContext::loaded(std::unique_ptr<GlContext> context, std::string name) {
  context->make_current();
  GlFunctions& functions = context->functions_;
#define VESTIGE_GL_LOAD(type, function)                                             \
  functions.function = reinterpret_cast<type>(context->address_of("gl" #function)); \
  if (functions.function == nullptr)                                                \
    throw Error(name, "the driver has no gl" #function, "use a newer driver: OpenGL 4.5 is needed");
  VESTIGE_GL_FUNCTIONS(VESTIGE_GL_LOAD)
#undef VESTIGE_GL_LOAD
  const std::string renderer = text_of(functions.GetString(GL_RENDERER));
  context->info_ = {std::move(name),
                    renderer,
                    text_of(functions.GetString(GL_VERSION)),
                    text_of(functions.GetString(GL_VENDOR)),
                    is_software_renderer(renderer),
                    {},
                    {}};
  GLint major = 0;
  GLint minor = 0;
  functions.GetIntegerv(GL_MAJOR_VERSION, &major);
  functions.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45)
    throw Error(context->info_.context, fmt::format("offers OpenGL {}.{} ({}); 4.5 is needed", major, minor, renderer),
                "use a newer driver, or another --context");
  if (gl_messages_wanted()) print_gl_messages(functions, context->info_.context);
  try {
    context->info_.arithmetic = probe_arithmetic(functions);
  } catch (const Error& error) {
    // What is not measured stays empty, and `geometry` refuses it.
    context->info_.probe_refusal = one_line(error.fault());
  }
  return context;
}

const GlFunctions& current_gl(GlContext& context) {
  context.make_current();
  return context.gl();
}

bool is_software_renderer(std::string_view renderer) {
  std::string name(renderer);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // "llvmpipe" also stands in lavapipe's name, and "Software Rasterizer" is what swrast calls itself.
  return std::ranges::any_of(
      std::array{"llvmpipe", "softpipe", "swrast", "software rasterizer", "openswr", "lavapipe", "swiftshader"},
      [&](const char* known) { return name.find(known) != std::string::npos; });
}

std::unique_ptr<GlContext> make_gl_context(ContextKind kind, int device) {
  if (kind == ContextKind::kOsMesa) return make_osmesa_context();
  if (device >= 0) return make_egl_device_context(device);

  const auto device_count = static_cast<int>(list_egl_devices().size());
  std::vector<std::function<std::unique_ptr<GlContext>()>> attempts;
  const auto add_devices = [&](auto make) {
    for (int i = 0; i < device_count; ++i) attempts.emplace_back([i, make] { return make(i); });
  };
  add_devices(make_hardware_context);
  attempts.emplace_back(make_egl_surfaceless_context);
  add_devices(make_egl_device_context);
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
  throw Error("--context", "this machine offers no OpenGL 4.5 context" + failures, kContextRemedy);
}

}  // namespace vestige
