#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace vestige {

// XBee modules in API mode: what goes to the module and comes from it is wrapped into frames that name the other radio
// and are answered with whether they arrived. Source: Digi, XBee/XBee-PRO 802.15.4 and ZigBee user guides, "API
// frames". On the line: 7E, length (two bytes, high first), data, checksum 0xFF - sum of the data.

/// The module's setting AP.
enum class XbeeEscaping : std::uint8_t {
  kNone,     ///< AP = 1
  kEscaped,  ///< AP = 2: after the 7E that opens a frame 7E, 7D, 11 and 13 are sent as 7D and the byte xor 20
};

/// The kind of frame that the module understands.
enum class XbeeRequest : std::uint8_t {
  kTransmit,  ///< 0x10, 64-bit addresses: ZigBee, DigiMesh, and 802.15.4 modules of today. Adds 18 bytes
  kTx16,      ///< 0x01, 16-bit addresses: 802.15.4, the first series too. Adds 9 bytes
};

struct XbeeOptions {
  XbeeRequest request = XbeeRequest::kTransmit;
  XbeeEscaping escaping = XbeeEscaping::kNone;
  /// Of the radio at the vest; 0xFFFF is all that listen. `kTx16` takes 16 bits.
  std::uint64_t address = 0xFFFF;
};

/// One packet over the air; a module may be set to less, and then answers that it was not sent.
inline constexpr std::size_t kXbeePayload_bytes = 100;

/// `frame_number` comes back with whether the frame arrived; 0: no answer is wanted. Throws `Error` for more than
/// `kXbeePayload_bytes`, `UsageError` for an address that does not fit.
std::vector<std::uint8_t> xbee_wrap(const XbeeOptions& options, std::uint8_t frame_number,
                                    std::span<const std::uint8_t> payload);

/// In words, of a delivery status other than 0.
std::string_view xbee_failure(std::uint8_t status);

/// Unwraps what comes from the module, in whatever pieces. Damaged frames cost nothing but themselves: the next is
/// looked for right behind the byte that seemed to open them.
class XbeeUnwrapper {
 public:
  explicit XbeeUnwrapper(XbeeEscaping escaping) : escaping_(escaping) {}

  /// What other radios sent and these bytes complete (frames 0x90, 0x80, 0x81), put together.
  std::vector<std::uint8_t> push(std::span<const std::uint8_t> bytes);

  std::uint64_t delivered() const { return delivered_; }       ///< frames that arrived (0x8B, 0x89)
  std::uint64_t undelivered() const { return undelivered_; }   ///< frames that did not
  std::uint8_t last_failure() const { return last_failure_; }  ///< status of the last one that did not; 0: none yet
  std::uint64_t damaged() const { return damaged_; }           ///< openings that no whole frame stood behind

 private:
  void take(std::span<const std::uint8_t> data, std::vector<std::uint8_t>& received);

  XbeeEscaping escaping_;
  std::vector<std::uint8_t> pending_;  // empty, or a frame that is not whole yet, from its 7E
  std::uint64_t delivered_ = 0;
  std::uint64_t undelivered_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint8_t last_failure_ = 0;
};

}  // namespace vestige
