#pragma once

#include "detector/gl/gl_functions.hpp"
#include "detector/stages.hpp"

namespace vestige {

/// Times draws for a StageClock: by the driver's timer query (GL_TIME_ELAPSED), and by the CPU's clock until everything
/// is drawn. Without a timer, by the CPU's clock until the calls return: to wait for the end of a draw would cost what
/// no other frame pays. A software renderer's query is not asked. llvmpipe's counts only part of its rasterizer: it
/// answered 0.5 us for draws of `paper` that took 1200 us, and 0.04 us for those of `geometry`, which take 1500 us.
///
/// It belongs to the context whose functions it was made with. That context must be current at every call.
class DrawTimer {
 public:
  explicit DrawTimer(const GlFunctions& gl) : gl_(gl) {}
  ~DrawTimer();
  DrawTimer(const DrawTimer&) = delete;
  DrawTimer& operator=(const DrawTimer&) = delete;

  /// Calls `draw`. With a clock, charges it to Stage::kDraw. Without (null), only calls it.
  template <typename Draw>
  void time(StageClock* clock, Draw&& draw) {
    if (clock == nullptr) return draw();
    begin(*clock);
    draw();
    end(*clock);
  }

 private:
  void begin(StageClock& clock);
  void end(StageClock& clock);

  const GlFunctions& gl_;
  GLuint query_ = 0;
  bool has_timer_ = false;
};

}  // namespace vestige
