#include <algorithm>

#include "tests/fuzz/require.hpp"
#include "transport/wire/cobs.hpp"
#include "transport/wire/vest_frame.hpp"
#include "transport/wire/xbee_api.hpp"

// Whatever comes over the line, through an XBee or not, reading it ends; and it is read the same in whatever pieces.
// The first byte of the input chooses the way and the length of the pieces.

using vestige::fuzz::require;

namespace vestige {
namespace {

enum class Way : std::uint8_t { kSerial, kXbee, kXbeeEscaped };

/// What is made of it, in numbers that can be compared.
struct Reading {
  std::vector<std::uint8_t> heard;  ///< sequence, then version of a greeting or errors of an acknowledgement
  std::uint64_t damaged = 0;
  std::uint64_t statuses = 0;
  bool operator==(const Reading&) const = default;
};

Reading read(std::span<const std::uint8_t> line, Way way, std::size_t piece) {
  XbeeUnwrapper unwrapper(way == Way::kXbeeEscaped ? XbeeEscaping::kEscaped : XbeeEscaping::kNone);
  VestAnswerDecoder decoder;
  Reading reading;
  while (!line.empty()) {
    const std::span<const std::uint8_t> now = line.first(std::min(piece, line.size()));
    line = line.subspan(now.size());
    std::vector<std::uint8_t> unwrapped;
    if (way != Way::kSerial) unwrapped = unwrapper.push(now);
    for (const VestAnswer& answer : decoder.push(way == Way::kSerial ? now : unwrapped)) {
      if (const auto* greeting = std::get_if<Greeting>(&answer)) {
        reading.heard.insert(reading.heard.end(), {greeting->sequence, greeting->version});
      } else {
        const auto& acknowledgement = std::get<Acknowledgement>(answer);
        reading.heard.insert(reading.heard.end(), {acknowledgement.sequence, acknowledgement.receive_errors});
      }
    }
  }
  reading.damaged = decoder.damaged() + unwrapper.damaged();
  reading.statuses = unwrapper.delivered() + unwrapper.undelivered();
  return reading;
}

}  // namespace
}  // namespace vestige

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  if (size == 0) return 0;
  const std::span<const std::uint8_t> line(data + 1, size - 1);
  const auto way = static_cast<Way>(data[0] % 3);
  const std::size_t piece = data[0] / 3 % 16 + 1;
  const Reading whole = read(line, way, line.size());
  require(whole == read(line, way, piece), "the same is read in whatever pieces");
  require(whole.damaged + whole.statuses + whole.heard.size() / 2 <= line.size(),
          "there are no more frames than bytes");

  require(cobs_decode(cobs_encode(line)) == std::vector<std::uint8_t>(line.begin(), line.end()),
          "what was stuffed comes back");
  static_cast<void>(cobs_decode(line));
  return 0;
}
