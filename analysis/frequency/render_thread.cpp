#include "analysis/frequency/render_thread.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "detector/gl/scene_renderer.hpp"

namespace vestige {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPeriod =
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / RenderThread::kRate_hz));

}  // namespace

RenderThread::RenderThread(MakeContext make_context, const Avatar& avatar, std::vector<const TraceFrame*> frames)
    : avatar_(avatar), frames_(std::move(frames)) {
  thread_ = std::jthread([this, make_context = std::move(make_context)](const std::stop_token& stop) {
    try {
      run(stop, make_context);
    } catch (...) {
      fail(std::current_exception());
    }
  });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !drawing_; });
  if (failure_ != nullptr) std::rethrow_exception(failure_);
}

RenderThread::~RenderThread() = default;  // jthread asks the thread to stop and joins it

void RenderThread::resume() {
  const std::scoped_lock lock(mutex_);
  if (state_ == State::kFailed) std::rethrow_exception(failure_);
  begun_ = 0;
  state_ = State::kRunning;
  changed_.notify_all();
}

std::uint64_t RenderThread::pause() {
  std::unique_lock lock(mutex_);
  if (state_ == State::kRunning) state_ = State::kPaused;
  changed_.notify_all();
  changed_.wait(lock, [this] { return !drawing_; });
  if (state_ == State::kFailed) std::rethrow_exception(failure_);
  return begun_;
}

void RenderThread::run(const std::stop_token& stop, const MakeContext& make_context) {
  SceneRenderer renderer(make_context(), avatar_);
  gl_info_ = renderer.gl_info();
  std::size_t next_frame = 0;
  const auto draw_next = [&] {
    renderer.draw(*frames_[next_frame]);
    next_frame = (next_frame + 1) % frames_.size();
  };
  draw_next();

  std::unique_lock lock(mutex_);
  state_ = State::kPaused;
  drawing_ = false;
  changed_.notify_all();
  while (changed_.wait(lock, stop, [this] { return state_ == State::kRunning; }) && !stop.stop_requested()) {
    auto due = Clock::now() + kPeriod / 2;
    while (!stop.stop_requested()) {
      if (changed_.wait_until(lock, stop, due, [this] { return state_ != State::kRunning; }) || stop.stop_requested())
        break;
      drawing_ = true;
      ++begun_;
      lock.unlock();
      draw_next();
      lock.lock();
      drawing_ = false;
      changed_.notify_all();
      due = std::max(due + kPeriod, Clock::now());
    }
  }
}

void RenderThread::fail(std::exception_ptr failure) {
  const std::scoped_lock lock(mutex_);
  failure_ = std::move(failure);
  state_ = State::kFailed;
  drawing_ = false;
  changed_.notify_all();
}

}  // namespace vestige
