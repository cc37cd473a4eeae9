#pragma once

#include <cstddef>
#include <cstdint>

namespace vestige {

/// Bytes of one state on the serial line: letter, sequence, ttl, count and a level for each actuator; two of CRC-16;
/// COBS, one in 254; and the zero at the end (README, the vest's frames).
std::size_t state_bytes(std::size_t actuator_count);

/// A line to the vest, as a model: a mailbox of one slot, in which the latest state wins. A changed state leaves when
/// the one before is out and 5 ms have passed since that began; an unchanged one is sent again every 20 ms.
class LinkLoad {
 public:
  LinkLoad(std::size_t frame_bytes, double line_bytes_per_s);

  /// A changed state. Times ascend.
  void post(double time_s);
  /// Up to the end of the trace: what the line was used for since `start`.
  void finish(double end_s) { run_to(end_s); }

  std::uint64_t changes() const { return changes_; }
  /// Changes whose place a newer one took before they could leave.
  std::uint64_t superseded() const { return superseded_; }
  double bytes_sent() const { return static_cast<double>(sent_) * frame_bytes_; }

 private:
  void run_to(double time_s);
  void send(double time_s);

  double frame_bytes_;
  double pause_s_;    ///< from the beginning of one frame to that of the next, at least
  double refresh_s_;  ///< the same for an unchanged state
  bool linked_ = false;
  bool waiting_ = false;
  double last_sent_s_ = 0;
  std::uint64_t changes_ = 0;
  std::uint64_t superseded_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace vestige
