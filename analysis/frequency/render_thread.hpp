#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "detector/gl/gl_context.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Draws a scene at 90 Hz in a thread and an OpenGL context of its own, as an application does beside detection (HAVE
/// 2010 §IV). A frame that comes late delays those after it; none are made up for.
class RenderThread {
 public:
  static constexpr double kRate_hz = 90;

  using MakeContext = std::function<std::unique_ptr<GlContext>()>;

  /// Shows `frames` one after the other, again and again; references to them and the avatar are kept. Returns paused,
  /// once a first frame has been drawn. `make_context` is called in the thread. Throws `Error` where that or the
  /// drawing fails.
  RenderThread(MakeContext make_context, const Avatar& avatar, std::vector<const TraceFrame*> frames);
  /// Stops after the frame in hand.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  const GlInfo& gl_info() const { return gl_info_; }

  /// Frames are due half a period after `resume`, and then once a period.
  void resume();

  /// Returns once nothing is drawn any more: the frames begun since `resume`. Throws what the thread failed with.
  std::uint64_t pause();

 private:
  enum class State { kPaused, kRunning, kFailed };

  void run(const std::stop_token& stop, const MakeContext& make_context);
  void fail(std::exception_ptr failure);

  const Avatar& avatar_;
  std::vector<const TraceFrame*> frames_;
  GlInfo gl_info_;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  State state_ = State::kRunning;  // the first frame
  bool drawing_ = true;
  std::uint64_t begun_ = 0;
  std::exception_ptr failure_;

  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace vestige
