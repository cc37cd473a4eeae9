#include "transport/wire/xbee_api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::uint8_t kStart = 0x7E;
constexpr std::uint8_t kEscape = 0x7D;
constexpr std::uint8_t kEscapeMask = 0x20;
/// Start, length and checksum.
constexpr std::size_t kHeader_bytes = 3;
constexpr std::size_t kChecksum_bytes = 1;
/// Longer than any frame that a module sends; a greater length is a damaged one.
constexpr std::size_t kLongestData_bytes = 320;

bool must_be_escaped(std::uint8_t byte) {
  return byte == kStart || byte == kEscape || byte == 0x11 || byte == 0x13;
}

std::uint8_t sum(std::span<const std::uint8_t> bytes) {
  unsigned total = 0;
  for (const std::uint8_t byte : bytes) total += byte;
  return static_cast<std::uint8_t>(total & 0xFFU);
}

void append_number(std::vector<std::uint8_t>& data, std::uint64_t number, unsigned bytes) {
  for (unsigned i = bytes; i-- > 0;) data.push_back(static_cast<std::uint8_t>(number >> (8 * i) & 0xFFU));
}

std::vector<std::uint8_t> request_header(const XbeeOptions& options, std::uint8_t frame_number) {
  std::vector<std::uint8_t> data;
  data.reserve(kXbeePayload_bytes + 14);
  if (options.request == XbeeRequest::kTx16) {
    if (options.address > 0xFFFF)
      throw UsageError("XBee", fmt::format("address {:X} does not fit into a TX16 frame", options.address),
                       "name the 16-bit address (the setting MY of the vest's module), or use Transmit Request frames");
    data = {0x01, frame_number};
    append_number(data, options.address, 2);
  } else {
    data = {0x10, frame_number};
    append_number(data, options.address, 8);
    append_number(data, 0xFFFE, 2);  // 16-bit address: unknown
    data.push_back(0);               // any number of hops
  }
  data.push_back(0);  // no options
  return data;
}

enum class Found : std::uint8_t { kWhole, kNotYet, kDamaged };

struct Candidate {
  Found found = Found::kNotYet;
  std::size_t bytes_on_line = 0;   ///< of a whole frame
  std::vector<std::uint8_t> data;  ///< of a whole frame
};

/// Reads the frame that begins at `bytes[0]`, which is 7E.
Candidate look(std::span<const std::uint8_t> bytes, XbeeEscaping escaping) {
  std::vector<std::uint8_t> plain{kStart};
  plain.reserve(bytes.size());
  std::size_t wanted = kHeader_bytes;
  bool escaped = false;
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    std::uint8_t byte = bytes[i];
    if (escaping == XbeeEscaping::kEscaped) {
      if (byte == kStart) return {.found = Found::kDamaged, .bytes_on_line = 0, .data = {}};
      if (!escaped && byte == kEscape) {
        escaped = true;
        continue;
      }
      if (std::exchange(escaped, false)) byte ^= kEscapeMask;
    }
    plain.push_back(byte);
    if (plain.size() == kHeader_bytes) {
      const std::size_t length = static_cast<std::size_t>(plain[1]) << 8U | plain[2];
      if (length == 0 || length > kLongestData_bytes) return {.found = Found::kDamaged, .bytes_on_line = 0, .data = {}};
      wanted = kHeader_bytes + length + kChecksum_bytes;
    }
    if (plain.size() == wanted && wanted > kHeader_bytes) {
      const std::span<const std::uint8_t> content = std::span(plain).subspan(kHeader_bytes);
      if (sum(content) != 0xFF) return {.found = Found::kDamaged, .bytes_on_line = 0, .data = {}};
      const auto data = content.first(content.size() - kChecksum_bytes);
      return {.found = Found::kWhole, .bytes_on_line = i + 1, .data = {data.begin(), data.end()}};
    }
  }
  return {};
}

}  // namespace

std::vector<std::uint8_t> xbee_wrap(const XbeeOptions& options, std::uint8_t frame_number,
                                    std::span<const std::uint8_t> payload) {
  if (payload.size() > kXbeePayload_bytes)
    throw Error(
        "XBee",
        fmt::format("a frame of {} bytes does not fit into one packet of {}", payload.size(), kXbeePayload_bytes),
        "use a map with fewer actuators, or the modules' transparent mode (AP = 0)");
  std::vector<std::uint8_t> data = request_header(options, frame_number);
  data.insert(data.end(), payload.begin(), payload.end());
  std::vector<std::uint8_t> plain;
  plain.reserve(kHeader_bytes + data.size() + kChecksum_bytes);
  append_number(plain, data.size(), 2);
  plain.insert(plain.end(), data.begin(), data.end());
  plain.push_back(static_cast<std::uint8_t>(0xFFU - sum(data)));

  std::vector<std::uint8_t> frame{kStart};
  frame.reserve(2 * plain.size() + 1);
  for (const std::uint8_t byte : plain) {
    if (options.escaping == XbeeEscaping::kEscaped && must_be_escaped(byte)) {
      frame.push_back(kEscape);
      frame.push_back(byte ^ kEscapeMask);
    } else {
      frame.push_back(byte);
    }
  }
  return frame;
}

std::string_view xbee_failure(std::uint8_t status) {
  switch (status) {
    case 0x01:
      return "the other radio did not acknowledge";
    case 0x02:
      return "the channel was never free";
    case 0x03:
      return "the packet was dropped before it was fetched";
    case 0x21:
      return "the network did not acknowledge";
    case 0x22:
      return "this radio has not joined a network";
    case 0x24:
      return "there is no radio with that address";
    case 0x25:
      return "there is no route to that address";
    case 0x74:
      return "the packet is too long for the radio's settings";
    default:
      return "the radio gave a reason that its manual lists";
  }
}

std::vector<std::uint8_t> XbeeUnwrapper::push(std::span<const std::uint8_t> bytes) {
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  std::vector<std::uint8_t> received;
  std::span<const std::uint8_t> rest(pending_);
  while (true) {
    const auto start = std::find(rest.begin(), rest.end(), kStart);
    rest = rest.subspan(static_cast<std::size_t>(start - rest.begin()));
    if (rest.empty()) break;
    const Candidate candidate = look(rest, escaping_);
    if (candidate.found == Found::kNotYet) break;
    if (candidate.found == Found::kWhole) {
      take(candidate.data, received);
      rest = rest.subspan(candidate.bytes_on_line);
    } else {
      ++damaged_;
      rest = rest.subspan(1);
    }
  }
  pending_.erase(pending_.begin(), pending_.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return received;
}

void XbeeUnwrapper::take(std::span<const std::uint8_t> data, std::vector<std::uint8_t>& received) {
  const auto payload_from = [&](std::size_t header) {
    if (data.size() > header)
      received.insert(received.end(), data.begin() + static_cast<std::ptrdiff_t>(header), data.end());
  };
  const auto status_at = [&](std::size_t place) {
    if (data.size() <= place) return;
    if (data[place] == 0) {
      ++delivered_;
    } else {
      ++undelivered_;
      last_failure_ = data[place];
    }
  };
  switch (data.front()) {
    case 0x90:
      payload_from(12);
      break;  // type, addresses of 64 and 16 bits, options
    case 0x80:
      payload_from(11);
      break;  // type, 64-bit address, signal strength, options
    case 0x81:
      payload_from(5);
      break;  // type, 16-bit address, signal strength, options
    case 0x8B:
      status_at(5);
      break;  // type, frame, 16-bit address, retries, status, discovery
    case 0x89:
      status_at(2);
      break;  // type, frame, status
    default:
      break;  // the module reports about itself
  }
}

}  // namespace vestige
