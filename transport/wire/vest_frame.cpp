#include "transport/wire/vest_frame.hpp"

#include <fmt/format.h>

#include <optional>

#include "transport/wire/cobs.hpp"
#include "transport/wire/crc16.hpp"

namespace vestige {

namespace {

constexpr std::size_t kCrc_bytes = 2;
constexpr std::size_t kAcknowledgement_bytes = 4;
constexpr std::size_t kGreeting_bytes = 5;
/// Length on the line, without the zero; COBS adds one byte to such short payloads.
constexpr std::size_t kLongestAnswer_bytes = 1 + kGreeting_bytes + kCrc_bytes;

constexpr std::uint8_t kInFailSafe = 1U << 0U;
constexpr std::uint8_t kOverrun = 1U << 1U;
constexpr std::uint8_t kOutputsFailed = 1U << 2U;

std::vector<std::uint8_t> seal(std::vector<std::uint8_t> payload) {
  const std::uint16_t crc = crc16(payload);
  payload.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  payload.push_back(static_cast<std::uint8_t>(crc >> 8U));
  std::vector<std::uint8_t> frame = cobs_encode(payload);
  frame.push_back(kFrameEnd);
  return frame;
}

std::optional<VestAnswer> decode(std::span<const std::uint8_t> frame) {
  const std::optional<std::vector<std::uint8_t>> payload = cobs_decode(frame);
  if (!payload || payload->size() < kCrc_bytes) return std::nullopt;
  const std::size_t length = payload->size() - kCrc_bytes;
  const std::vector<std::uint8_t>& byte = *payload;
  if (crc16(std::span(byte).first(length)) != (byte[length] | byte[length + 1] << 8U)) return std::nullopt;
  if (length == kAcknowledgement_bytes && byte[0] == 'A')
    return Acknowledgement{.sequence = byte[1],
                           .was_in_fail_safe = (byte[2] & kInFailSafe) != 0,
                           .overrun = (byte[2] & kOverrun) != 0,
                           .receive_errors = byte[3],
                           .outputs_failed = (byte[2] & kOutputsFailed) != 0};
  if (length == kGreeting_bytes && byte[0] == 'H')
    return Greeting{.sequence = byte[1],
                    .version = byte[2],
                    .actuator_count = byte[3],
                    .was_in_fail_safe = (byte[4] & kInFailSafe) != 0,
                    .overrun = (byte[4] & kOverrun) != 0,
                    .outputs_failed = (byte[4] & kOutputsFailed) != 0};
  return std::nullopt;
}

}  // namespace

std::uint8_t ttl_units(int ttl_ms) {
  constexpr int kMost_ms = 255 * kTtlUnit_ms;
  if (ttl_ms < kTtlUnit_ms || ttl_ms > kMost_ms || ttl_ms % kTtlUnit_ms != 0)
    throw UsageError("--ttl", fmt::format("a vest frame cannot hold {} ms", ttl_ms),
                     fmt::format("choose a multiple of {} from {} to {}", kTtlUnit_ms, kTtlUnit_ms, kMost_ms));
  return static_cast<std::uint8_t>(ttl_ms / kTtlUnit_ms);
}

std::size_t chips_of(std::size_t actuators) {
  constexpr std::size_t kChannels = 16;
  return (actuators + kChannels - 1) / kChannels;
}

std::chrono::microseconds board_time(std::size_t actuators) {
  // 66 bytes at 400 kHz are 1.5 ms; the firmware's interrupts make it 1.9 on the simulated board.
  constexpr std::chrono::microseconds kChip(2000);
  return kChip * chips_of(actuators);
}

std::vector<std::uint8_t> encode_state(Quantity quantity, std::span<const std::uint8_t> level, std::uint8_t sequence,
                                       std::uint8_t ttl) {
  if (level.size() > kMaxActuators)
    throw Error("vest",
                fmt::format("a frame holds at most {} actuators, and there are {}", kMaxActuators, level.size()),
                "use a map with fewer actuators");
  const std::uint8_t type = quantity == Quantity::kDuty ? 'S' : 'P';
  std::vector<std::uint8_t> payload{type, sequence, ttl, static_cast<std::uint8_t>(level.size())};
  payload.insert(payload.end(), level.begin(), level.end());
  return seal(std::move(payload));
}

std::vector<std::uint8_t> encode_off(std::uint8_t sequence) {
  return seal({'X', sequence, 0, 0});
}

std::vector<std::uint8_t> encode_hello(std::uint8_t sequence) {
  return seal({'H', sequence});
}

std::vector<VestAnswer> VestAnswerDecoder::push(std::span<const std::uint8_t> bytes) {
  std::vector<VestAnswer> answers;
  for (const std::uint8_t byte : bytes) {
    if (byte != kFrameEnd) {
      if (frame_.size() <= kLongestAnswer_bytes) frame_.push_back(byte);
      continue;
    }
    if (frame_.empty()) continue;
    const std::optional<VestAnswer> answer =
        frame_.size() <= kLongestAnswer_bytes ? decode(frame_) : std::optional<VestAnswer>();
    frame_.clear();
    if (answer)
      answers.push_back(*answer);
    else
      ++damaged_;
  }
  return answers;
}

}  // namespace vestige
