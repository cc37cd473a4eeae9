#include "transport/sender.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <utility>

#include "traces/base/system_error.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

namespace {

using namespace std::chrono_literals;

constexpr auto kIdle = 100ms;
constexpr auto kLineBusy = 500us;  ///< time until a busy line is checked again
constexpr auto kBetweenTries = 250ms;
constexpr auto kPatience = 250ms;     ///< for sending the last state, and for the answer to a state
constexpr auto kPatienceForOff = 1s;  ///< for the answer of a board that has answered before

double seconds(Sender::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

SenderStatistics& SenderStatistics::operator+=(const SenderStatistics& other) {
  sent += other.sent;
  changes += other.changes;
  superseded += other.superseded;
  acknowledged += other.acknowledged;
  fail_safes += other.fail_safes;
  output_failures += other.output_failures;
  overruns += other.overruns;
  receive_errors += other.receive_errors;
  links_lost += other.links_lost;
  bytes += other.bytes;
  most_unanswered = std::max(most_unanswered, other.most_unanswered);
  written += other.written;
  acknowledged_after += other.acknowledged_after;
  off_sent = off_sent && other.off_sent;
  off_acknowledged = off_acknowledged && other.off_acknowledged;
  zeros_acknowledged = zeros_acknowledged && other.zeros_acknowledged;
  return *this;
}

Sender::Sender(ActuatorSink& sink, const SenderOptions& options, std::function<void(const std::string&)> on_event)
    : sink_(sink),
      options_(options),
      on_event_(std::move(on_event)),
      wake_descriptor_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_descriptor_ < 0) throw system_error("event", "could not be made", errno);
  thread_ = std::thread([this] { run(); });
}

Sender::~Sender() {
  try {
    if (thread_.joinable()) finish();
  } catch (const std::exception&) {
    // The exception being handled, if any, tells more.
  }
  ::close(wake_descriptor_);
}

void Sender::post(const ActuatorFrame& frame, Clock::time_point since) {
  if (failed_) std::rethrow_exception(failure_);
  still_here();
  if (posted_before_ == frame.duty) return;
  posted_before_ = frame.duty;
  {
    const std::lock_guard lock(mutex_);
    if (mailbox_) supersede();
    mailbox_ = {frame, since, ++posted_};
  }
  wake();
}

std::vector<SentState> Sender::take_log() {
  const std::lock_guard lock(mutex_);
  if (!in_flight_) return std::exchange(log_, {});
  const auto known = log_.begin() + static_cast<std::ptrdiff_t>(in_flight_->place);
  std::vector<SentState> told(log_.begin(), known);
  log_.erase(log_.begin(), known);
  in_flight_->place = 0;
  return told;
}

void Sender::supersede() {
  ++superseded_;
  if (options_.keep_log) log_.push_back({mailbox_->frame, SentState::Fate::kSuperseded, 0});
  mailbox_.reset();
}

void Sender::stop() {
  stopping_ = true;
  wake();
}

SenderStatistics Sender::finish() {
  stop();
  thread_.join();
  if (mailbox_) supersede();  // it was replaced by the switching off only
  if (failed_) std::rethrow_exception(failure_);
  statistics_.superseded = superseded_;
  statistics_.bytes = sink_.bytes_sent();
  return statistics_;
}

void Sender::wake() {
  // Fails only if the counter is full; then the thread wakes as well.
  [[maybe_unused]] const int written = ::eventfd_write(wake_descriptor_, 1);
}

void Sender::run() {
  try {
    loop();
    switch_off();
  } catch (...) {
    failure_ = std::current_exception();
    try {
      send_all_off();
    } catch (const std::exception&) {
      // The first failure tells more.
    }
    failed_ = true;
  }
}

void Sender::loop() {
  while (!stopping_) {
    const auto now = Clock::now();
    try {
      if (!linked_ && now >= next_try_) try_reconnecting();
      look_for_life(now);
      if (may_send(now)) {
        send_state();
      } else {
        wait(next_chance(now));
      }
      receive();
    } catch (const LinkLost& lost) {
      lose_link(lost);
    }
  }
}

bool Sender::has_changed() {
  const std::lock_guard lock(mutex_);
  return mailbox_.has_value();
}

void Sender::look_for_life(Clock::time_point now) {
  const bool deserted = now > Clock::time_point(Clock::duration(alive_)) + options_.deserted;
  if (deserted && !deserted_ && linked_ && has_state_) {
    send_all_off();
    // Called last, because a stopped terminal would block here while the motors keep running.
    on_event_(fmt::format("{}: the playback has stopped; all actuators are off until it continues", sink_.name()));
  }
  deserted_ = deserted;
}

bool Sender::may_send(Clock::time_point now) {
  if (!linked_ || now < last_sent_ + options_.floor) return false;
  const bool due = has_changed() || (has_state_ && !deserted_ && now >= last_sent_ + options_.refresh);
  return due && sink_.ready();
}

Sender::Clock::time_point Sender::next_chance(Clock::time_point now) {
  if (!linked_) return next_try_;
  Clock::time_point due = now + kIdle;
  if (has_state_ && !deserted_) due = last_sent_ + std::max(options_.refresh, options_.floor);
  if (has_changed()) due = last_sent_ + options_.floor;
  return std::max(due, now + kLineBusy);
}

void Sender::send_state() {
  const Posted* changed = take_posted();
  if (changed != nullptr) {
    state_ = changed->frame;
    state_number_ = changed->number;
    has_state_ = true;
  }
  const std::uint8_t sequence = next_sequence(changed);
  outstanding_[sequence].number = state_number_;
  if (statistics_.acknowledged != 0)
    statistics_.most_unanswered =
        std::max<std::uint64_t>(statistics_.most_unanswered, static_cast<std::uint8_t>(sequence - answered_));
  sink_.send(state_, sequence);
  note_sent();
  if (!sink_.acknowledges()) heard_ = state_number_;
  if (changed != nullptr) note_written();
}

const Sender::Posted* Sender::take_posted() {
  const std::lock_guard lock(mutex_);
  if (!mailbox_) return nullptr;
  in_flight_ = {*std::exchange(mailbox_, std::nullopt), log_.size()};
  if (options_.keep_log) log_.push_back({in_flight_->posted.frame, SentState::Fate::kSent, 0});
  return &in_flight_->posted;
}

void Sender::note_written() {
  const double written_s = seconds(last_sent_ - in_flight_->posted.since);
  ++statistics_.changes;
  statistics_.written.add(written_s);
  const std::lock_guard lock(mutex_);
  if (options_.keep_log) log_[in_flight_->place].written_s = written_s;
  in_flight_.reset();
}

/// Returns a state that could not be written to the mailbox, unless there is a newer one. It is sent when the link is
/// back.
void Sender::give_back() {
  const std::lock_guard lock(mutex_);
  if (!in_flight_) return;
  if (mailbox_) {
    ++superseded_;
    if (options_.keep_log) log_[in_flight_->place].fate = SentState::Fate::kSuperseded;
  } else {
    mailbox_ = in_flight_->posted;
    if (options_.keep_log) log_.pop_back();
  }
  in_flight_.reset();
}

std::uint8_t Sender::next_sequence(const Posted* changed) {
  outstanding_[++sequence_] = {true, changed != nullptr, changed != nullptr ? changed->since : Clock::time_point(), 0};
  return sequence_;
}

void Sender::note_sent() {
  ++statistics_.sent;
  last_sent_ = Clock::now();
}

void Sender::wait(Clock::time_point until) {
  pollfd polled[2] = {{wake_descriptor_, POLLIN, 0}, {linked_ ? sink_.readable_descriptor() : -1, POLLIN, 0}};
  const auto left = std::max<std::chrono::nanoseconds>(until - Clock::now(), 0ns);
  const timespec timeout = {left / 1s, (left % 1s).count()};
  ::ppoll(polled, 2, &timeout, nullptr);
  eventfd_t ignored = 0;
  [[maybe_unused]] const int read = ::eventfd_read(wake_descriptor_, &ignored);
}

void Sender::receive() {
  if (!linked_) return;
  for (const Acknowledgement& answer : sink_.receive()) {
    count_faults(answer);
    Outstanding& place = outstanding_[answer.sequence];
    if (!place.waiting) continue;
    place.waiting = false;
    answered_ = answer.sequence;  // and all before it, because the line keeps their order
    heard_ = std::max<std::uint64_t>(heard_, place.number);
    ++statistics_.acknowledged;
    if (place.changed) statistics_.acknowledged_after.add(seconds(Clock::now() - place.since));
  }
}

void Sender::count_faults(const Acknowledgement& answer) {
  if (answer.overrun) ++statistics_.overruns;
  if (answer.outputs_failed) ++statistics_.output_failures;
  // The first answer of a link reports the time before the link.
  if (receive_errors_before_) {
    const bool restarted = answer.was_in_fail_safe && answer.receive_errors < *receive_errors_before_;
    const int before = restarted ? 0 : *receive_errors_before_;
    statistics_.receive_errors += static_cast<std::uint8_t>(answer.receive_errors - before);
    if (answer.was_in_fail_safe && !answer.outputs_failed && !deserted_) ++statistics_.fail_safes;
  }
  receive_errors_before_ = answer.receive_errors;
}

void Sender::lose_link(const LinkLost& lost) {
  give_back();
  linked_ = false;
  outstanding_.fill({});
  answered_ = sequence_;
  ++statistics_.links_lost;
  next_try_ = Clock::now() + kBetweenTries;
  on_event_(lost.what());
}

void Sender::try_reconnecting() {
  next_try_ = Clock::now() + kBetweenTries;
  if (!sink_.reconnect()) return;
  linked_ = true;
  last_sent_ = {};  // the board knows no state, so send it at once
  receive_errors_before_.reset();
  on_event_(fmt::format("{}: the link is back", sink_.name()));
}

void Sender::wait_for_last_answer(Clock::duration patience) {
  const auto until = Clock::now() + patience;
  receive();
  while (sink_.acknowledges() && outstanding_[sequence_].waiting && Clock::now() < until) {
    wait(until);
    receive();
  }
}

/// A board that knows only states stays off after the first of the two frames. The other frame also closes what is not
/// part of a state, such as actuators beyond it.
Sender::OffFrames Sender::send_all_off() {
  OffFrames frames;
  std::exception_ptr failure;
  if (has_state_) {
    try {
      ActuatorFrame zeros = state_;
      std::ranges::fill(zeros.duty, std::uint8_t{0});
      frames.zeros = next_sequence(nullptr);
      sink_.send(zeros, *frames.zeros);
      note_sent();
    } catch (...) {
      failure = std::current_exception();  // the other frame may still get through
    }
  }
  frames.off = next_sequence(nullptr);
  sink_.send_off(frames.off);
  note_sent();
  if (failure) std::rethrow_exception(failure);
  return frames;
}

void Sender::switch_off() try {
  if (!linked_ && !sink_.reconnect()) return;  // the ttl has switched it off
  linked_ = true;
  const auto until = Clock::now() + kPatience;
  while (has_changed()) {
    const auto now = Clock::now();
    if (may_send(now)) {
      send_state();
    } else if (now >= until) {
      break;
    } else {
      wait(next_chance(now));
    }
    receive();
  }
  wait_for_last_answer(kPatience);
  const Clock::duration patience = statistics_.acknowledged == 0 ? kPatience : kPatienceForOff;
  const auto is_answered = [&](std::uint8_t sequence) { return !outstanding_[sequence].waiting; };
  const OffFrames first = send_all_off();
  OffFrames last = first;
  statistics_.off_sent = true;
  if (!sink_.acknowledges()) return;
  wait_for_last_answer(patience);
  if (!is_answered(first.off)) {
    last = send_all_off();
    wait_for_last_answer(patience);
  }
  // The answer to a first frame may have come late.
  statistics_.off_acknowledged = is_answered(first.off) || is_answered(last.off);
  statistics_.zeros_acknowledged = first.zeros && last.zeros && (is_answered(*first.zeros) || is_answered(*last.zeros));
} catch (const LinkLost& lost) {
  lose_link(lost);
}

}  // namespace vestige
