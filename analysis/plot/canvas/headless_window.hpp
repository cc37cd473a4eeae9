#pragma once

#include <memory>
#include <stdexcept>
#include <string>

class vtkRenderWindow;

namespace vestige::plot {

/// No OpenGL context can be had here: no EGL library, or no driver behind it. `what()` says which step failed.
class GlUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A VTK render window without a screen, X or Wayland: it draws into its own buffers through an EGL context of our own
/// (surfaceless where the driver has it). Debian's VTK has no window class for that.
class HeadlessWindow {
 public:
  /// Throws `GlUnavailable`.
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
