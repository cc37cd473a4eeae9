// GL/glcorearb.h must come before GL/osmesa.h. Otherwise the GL/gl.h of GL/osmesa.h hides half of it.
// clang-format off
#include "detector/gl/gl_context.hpp"
#include <GL/osmesa.h>
// clang-format on

#include <array>

#include "traces/base/error.hpp"
#include "traces/base/shared_library.hpp"

namespace vestige {

namespace {

constexpr int kSide = 4;  // of the colour buffer that OSMesa requires; the program draws into its own framebuffer

struct OsMesaFunctions {
  decltype(&OSMesaCreateContextAttribs) CreateContextAttribs = nullptr;
  decltype(&OSMesaDestroyContext) DestroyContext = nullptr;
  decltype(&OSMesaMakeCurrent) MakeCurrent = nullptr;
  decltype(&OSMesaGetProcAddress) GetProcAddress = nullptr;

  OsMesaFunctions() {
    const SharedLibrary library("libOSMesa.so.8");
    library.find("OSMesaCreateContextAttribs", CreateContextAttribs);
    library.find("OSMesaDestroyContext", DestroyContext);
    library.find("OSMesaMakeCurrent", MakeCurrent);
    library.find("OSMesaGetProcAddress", GetProcAddress);
  }
};

const OsMesaFunctions& osmesa() {
  static const OsMesaFunctions functions;
  return functions;
}

class OsMesaGlContext final : public GlContext {
 public:
  OsMesaGlContext() {
    constexpr std::array<int, 9> kAttributes = {OSMESA_FORMAT,
                                                OSMESA_RGBA,
                                                OSMESA_PROFILE,
                                                OSMESA_CORE_PROFILE,
                                                OSMESA_CONTEXT_MAJOR_VERSION,
                                                4,
                                                OSMESA_CONTEXT_MINOR_VERSION,
                                                5,
                                                0};
    context_ = osmesa().CreateContextAttribs(kAttributes.data(), nullptr);
    if (context_ == nullptr) throw Error("osmesa", "offers no OpenGL 4.5 core context", "use a newer Mesa");
  }
  ~OsMesaGlContext() override {
    leave();
    osmesa().DestroyContext(context_);
  }
  static std::unique_ptr<GlContext> make() { return loaded(std::make_unique<OsMesaGlContext>(), "osmesa"); }

 private:
  void bind() override {
    if (osmesa().MakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE)
      throw Error("osmesa", "OSMesaMakeCurrent failed", "");
  }
  void unbind() override { osmesa().MakeCurrent(nullptr, nullptr, 0, 0, 0); }
  void* address_of(const char* function) const override {
    return reinterpret_cast<void*>(osmesa().GetProcAddress(function));
  }

  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4 * kSide* kSide> buffer_ = {};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() {
  return OsMesaGlContext::make();
}

}  // namespace vestige
