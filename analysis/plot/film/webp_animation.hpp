#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Makes an animated WebP image (RFC 9649) that repeats for ever. Each picture is compressed when it comes, with or
/// without loss, whichever is smaller; only compressed pictures are kept. The same pictures give the same bytes.
///
/// Functions throw `Error` if libwebp fails, for want of memory, or if it is of another version.
class WebpAnimation {
 public:
  /// All pictures have this size, at most 16383 each.
  WebpAnimation(std::size_t width, std::size_t height);
  ~WebpAnimation();
  WebpAnimation(const WebpAnimation&) = delete;
  WebpAnimation& operator=(const WebpAnimation&) = delete;

  /// Adds a picture that is shown from `time_ms` until the next one. Times begin with 0 and rise.
  void add(const Raster& picture, int time_ms);
  /// Returns the file. `end_ms` is the end of the last picture. Nothing may be added afterwards.
  std::string finish(int end_ms);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vestige::plot
