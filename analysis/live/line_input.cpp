#include "analysis/live/line_input.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kReadBytes = std::size_t{64} << 10;

bool is_readable(int descriptor) {
  pollfd place = {.fd = descriptor, .events = POLLIN, .revents = 0};
  return ::poll(&place, 1, 0) > 0;
}

}  // namespace

LineInput::LineInput(const Avatar& avatar, int descriptor)
    : lines_(avatar), descriptor_(descriptor), buffer_(kReadBytes, '\0') {}

void LineInput::take(TraceFrame frame) {
  teleported_.insert(frame.teleported.begin(), frame.teleported.end());
  if (frames_ != frames_shown_) {
    // Whoever was not in the frame before, which nobody saw, moved no way that leads to this one.
    std::set<std::uint32_t> before;
    for (const ColliderSample& collider : newest_.colliders) before.insert(collider.id);
    for (const ColliderSample& collider : frame.colliders)
      if (!before.contains(collider.id)) teleported_.insert(collider.id);
  }
  newest_ = std::move(frame);
  ++frames_;
}

void LineInput::receive() {
  const Clock::time_point until = Clock::now() + kLongestTurn;
  while (!has_ended_ && is_readable(descriptor_) && Clock::now() < until) {
    const ssize_t count = ::read(descriptor_, buffer_.data(), buffer_.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (count < 0) throw Error("standard input", std::string("could not be read: ") + std::strerror(errno), "");
    const Clock::time_point now = Clock::now();
    const std::int64_t now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now - start_).count();
    const std::uint64_t before = frames_;
    const auto taken = [this](TraceFrame frame) { take(std::move(frame)); };
    if (count == 0) {
      lines_.finish(now_ns, taken);
      has_ended_ = true;
    } else {
      lines_.push(std::string_view(buffer_).substr(0, static_cast<std::size_t>(count)), now_ns, taken);
    }
    if (frames_ != before) arrived_ = now;
  }
}

void LineInput::show(Clock::time_point /*time*/, LiveFrame& out) {
  if (frames_ > frames_shown_) superseded_ += frames_ - frames_shown_ - 1;
  frames_shown_ = frames_;
  out.frame = newest_;
  out.frame.teleported.assign(teleported_.begin(), teleported_.end());
  teleported_.clear();
  out.arrived = arrived_;
  out.begins = false;
  out.pose_delay_s = 0;
  out.decoded = Clock::now();
}

std::vector<std::string> LineInput::take_problems() {
  std::vector<std::string> told;
  for (; problems_told_ < lines_.problems().size(); ++problems_told_)
    told.push_back(fmt::format("standard input: {}", lines_.problems()[problems_told_]));
  return told;
}

LiveLosses LineInput::losses() const {
  LiveLosses losses;
  losses.malformed = lines_.malformed();
  return losses;
}

}  // namespace vestige
