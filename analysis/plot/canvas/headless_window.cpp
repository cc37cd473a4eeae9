#include "analysis/plot/canvas/headless_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtk_glew.h>  // before every other header that declares OpenGL

#include <array>

namespace vestige::plot {

namespace {

/// EGL is opened at run time, so that the program also starts, and writes SVG, without EGL.
class EglContext {
 public:
  EglContext() : library_(::dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) throw GlUnavailable("libEGL.so.1 could not be opened");
    load(get_proc_address_, "eglGetProcAddress");
    load(make_current_, "eglMakeCurrent");
    load(get_current_, "eglGetCurrentContext");
    load(destroy_context_, "eglDestroyContext");
    load(terminate_, "eglTerminate");
    open_display();
    create_context();
  }
  ~EglContext() {
    // The library stays open: Mesa's drivers leave exit handlers behind that point into it.
    if (display_ == EGL_NO_DISPLAY) return;
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) destroy_context_(display_, context_);
    terminate_(display_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  bool make_current() const { return make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE; }
  bool is_current() const { return get_current_() == context_; }

 private:
  template <typename Function>
  void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(::dlsym(library_, name));
    if (function == nullptr) throw GlUnavailable(fmt::format("libEGL.so.1 has no {}", name));
  }

  void open_display() {
    decltype(&eglInitialize) initialize = nullptr;
    load(initialize, "eglInitialize");
    const auto get_platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get_proc_address_("eglGetPlatformDisplayEXT"));
    if (get_platform_display != nullptr)
      display_ = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY) {
      decltype(&eglGetDisplay) get_display = nullptr;
      load(get_display, "eglGetDisplay");
      display_ = get_display(EGL_DEFAULT_DISPLAY);
    }
    if (display_ == EGL_NO_DISPLAY) throw GlUnavailable("EGL offers no display that works without a screen");
    if (initialize(display_, nullptr, nullptr) != EGL_TRUE) {
      display_ = EGL_NO_DISPLAY;
      throw GlUnavailable("EGL could not be initialised (no driver?)");
    }
  }

  void create_context() {
    decltype(&eglBindAPI) bind_api = nullptr;
    decltype(&eglChooseConfig) choose_config = nullptr;
    decltype(&eglCreateContext) create = nullptr;
    load(bind_api, "eglBindAPI");
    load(choose_config, "eglChooseConfig");
    load(create, "eglCreateContext");
    if (bind_api(EGL_OPENGL_API) != EGL_TRUE) throw GlUnavailable("this EGL has no desktop OpenGL");
    constexpr std::array<EGLint, 5> kConfig = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (choose_config(display_, kConfig.data(), &config, 1, &count) != EGL_TRUE || count == 0) config = nullptr;
    // VTK 9.1 draws with OpenGL 3.2.
    constexpr std::array<EGLint, 7> kVersion = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = create(display_, config, EGL_NO_CONTEXT, kVersion.data());
    if (context_ == EGL_NO_CONTEXT) throw GlUnavailable("EGL gave no OpenGL 3.2 context");
    if (!make_current()) throw GlUnavailable("EGL could not make a context current without a surface");
  }

  void* library_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  decltype(&eglGetProcAddress) get_proc_address_ = nullptr;
  decltype(&eglMakeCurrent) make_current_ = nullptr;
  decltype(&eglGetCurrentContext) get_current_ = nullptr;
  decltype(&eglDestroyContext) destroy_context_ = nullptr;
  decltype(&eglTerminate) terminate_ = nullptr;
};

class EglRenderWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglRenderWindow* New();  // NOLINT(readability-identifier-naming): VTK's factory
  vtkTypeMacro(EglRenderWindow, vtkGenericOpenGLRenderWindow)

      void use(const EglContext* context) {
    context_ = context;
  }

  void OpenGLInitContext() override {
    if (Initialized || context_ == nullptr) return;
    MakeCurrent();
    glewExperimental = GL_TRUE;
    // Debian's GLEW asks GLX last, which has no display here. By then, the entry points of OpenGL itself are loaded.
    const GLenum result = glewInit();
    if (result != GLEW_OK && result != GLEW_ERROR_NO_GLX_DISPLAY)
      throw GlUnavailable(fmt::format("GLEW found no OpenGL ({})", result));
    Initialized = true;
    MaximumHardwareLineWidth = 1;
    if (SupportsOpenGL() == 0) throw GlUnavailable("the OpenGL driver lacks version 3.2");
  }
  void MakeCurrent() override {
    if (context_ != nullptr) context_->make_current();
  }
  bool IsCurrent() override { return context_ != nullptr && context_->is_current(); }
  int SupportsOpenGL() override { return GLEW_VERSION_3_2 != 0 ? 1 : 0; }
  vtkTypeBool IsDirect() override { return 1; }
  void Finalize() override {
    if (context_ == nullptr) return;
    MakeCurrent();
    Superclass::Finalize();
    context_ = nullptr;
  }

 private:
  const EglContext* context_ = nullptr;
};

vtkStandardNewMacro(EglRenderWindow)

}  // namespace

struct HeadlessWindow::Parts {
  EglContext context;  // outlives the window, which frees its buffers in it
  vtkNew<EglRenderWindow> window;
};

HeadlessWindow::HeadlessWindow() : parts_(std::make_unique<Parts>()) {
  EglRenderWindow& window = *parts_->window;
  window.use(&parts_->context);
  window.SetOffScreenRendering(1);
  window.SetShowWindow(false);
  window.SetFrameBlitModeToNoBlit();
  window.OpenGLInit();
}

HeadlessWindow::~HeadlessWindow() {
  parts_->window->Finalize();
}

vtkRenderWindow& HeadlessWindow::window() const {
  return *parts_->window;
}

}  // namespace vestige::plot
