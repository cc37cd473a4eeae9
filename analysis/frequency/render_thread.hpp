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

/// Draws a scene at 90 Hz in its own thread and its own OpenGL context, as an application does beside detection (HAVE
/// 2010 §IV). A late frame delays the frames after it. Lost frames are not made up for.
class RenderThread {
 public:
  static constexpr double kRate_hz = 90;

  using MakeContext = std::function<std::unique_ptr<GlContext>()>;

  /// Draws `frames` in a loop. Keeps references to the frames and to the avatar. The constructor returns paused, after
  /// the first frame has been drawn. `make_context` is called in the new thread. Throws `Error` if making the context
  /// or drawing fails.
  RenderThread(MakeContext make_context, const Avatar& avatar, std::vector<const TraceFrame*> frames);
  /// Stops after the current frame.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  const GlInfo& gl_info() const { return gl_info_; }

  /// Starts drawing. The first frame is due half a period after `resume`, and then one each period.
  void resume();

  /// Pauses, and returns once drawing has stopped. Returns the number of frames begun since `resume`. Throws the
  /// failure of the thread, if any.
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
  State state_ = State::kRunning;  // while the first frame is drawn
  bool drawing_ = true;
  std::uint64_t begun_ = 0;
  std::exception_ptr failure_;

  std::jthread thread_;  // last, since it uses all members above
};

}  // namespace vestige
