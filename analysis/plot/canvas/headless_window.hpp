#pragma once

#include <memory>
#include <stdexcept>
#include <string>

class vtkRenderWindow;

namespace vestige::plot {

/// An OpenGL context is not available: the EGL library or a driver behind it is missing. `what()` says which step
/// failed.
class GlUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A VTK render window without a screen, X or Wayland. It draws into its own buffers through its own EGL context
/// (surfaceless if the driver supports that). Debian's VTK has no window class for that.
class HeadlessWindow {
 public:
  /// Throws `GlUnavailable` if there is no OpenGL context.
  HeadlessWindow();
  ~HeadlessWindow();
  HeadlessWindow(const HeadlessWindow&) = delete;
  HeadlessWindow& operator=(const HeadlessWindow&) = delete;

  vtkRenderWindow& window() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vestige::plot
