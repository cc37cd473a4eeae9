#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace vestige {

// XBee modules in API mode. All bytes to and from the module are wrapped into frames. A frame names the other radio,
// and is answered with its delivery status. Source: Digi, XBee/XBee-PRO 802.15.4 and ZigBee user guides, "API frames".
// On the line: 7E, length (two bytes, high first), data, checksum 0xFF - sum of the data.

/// The module's setting AP.
enum class XbeeEscaping : std::uint8_t {
  kNone,     ///< AP = 1
  kEscaped,  ///< AP = 2: after the opening 7E, the bytes 7E, 7D, 11 and 13 are sent as 7D and the byte xor 20
};

/// The kind of frame that the module understands.
enum class XbeeRequest : std::uint8_t {
  kTransmit,  ///< 0x10, 64-bit addresses: ZigBee, DigiMesh, and present 802.15.4 modules. Adds 18 bytes
  kTx16,      ///< 0x01, 16-bit addresses: 802.15.4, including the first series. Adds 9 bytes
};

struct XbeeOptions {
  XbeeRequest request = XbeeRequest::kTransmit;
  XbeeEscaping escaping = XbeeEscaping::kNone;
  /// Address of the radio at the vest; 0xFFFF is every radio that listens. `kTx16` takes 16 bits.
  std::uint64_t address = 0xFFFF;
};

/// The payload of one packet over the air. A module may be set to less, and then answers that it did not send the
/// packet.
inline constexpr std::size_t kXbeePayload_bytes = 100;

/// Wraps a payload into a frame. The delivery report repeats `frame_number`; 0 requests no report. Throws `Error` for
/// more than `kXbeePayload_bytes`, and `UsageError` if the address does not fit.
std::vector<std::uint8_t> xbee_wrap(const XbeeOptions& options, std::uint8_t frame_number,
                                    std::span<const std::uint8_t> payload);

/// Returns a delivery status other than 0 in words.
std::string_view xbee_failure(std::uint8_t status);

/// Unwraps bytes from the module, in pieces of any size. A damaged frame loses only itself: the search for the next one
/// continues right after the byte that seemed to open it.
class XbeeUnwrapper {
 public:
  explicit XbeeUnwrapper(XbeeEscaping escaping) : escaping_(escaping) {}

  /// Returns the payloads from other radios that these bytes complete (frames 0x90, 0x80, 0x81), concatenated.
  std::vector<std::uint8_t> push(std::span<const std::uint8_t> bytes);

  std::uint64_t delivered() const { return delivered_; }       ///< frames that arrived (0x8B, 0x89)
  std::uint64_t undelivered() const { return undelivered_; }   ///< frames that did not
  std::uint8_t last_failure() const { return last_failure_; }  ///< status of the last undelivered frame; 0: none yet
  std::uint64_t damaged() const { return damaged_; }           ///< opening bytes without a whole frame after them

 private:
  void take(std::span<const std::uint8_t> data, std::vector<std::uint8_t>& received);

  XbeeEscaping escaping_;
  std::vector<std::uint8_t> pending_;  // empty, or an incomplete frame from its 7E on
  std::uint64_t delivered_ = 0;
  std::uint64_t undelivered_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint8_t last_failure_ = 0;
};

}  // namespace vestige
