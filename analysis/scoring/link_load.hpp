#pragma once

#include <cstddef>
#include <cstdint>

namespace vestige {

/// Returns the bytes of one state on the serial line: letter, sequence, ttl, count and a level for each actuator; two
/// bytes of CRC-16; COBS overhead of one byte in 254; and the zero at the end (transport/firmware/README.md).
std::size_t state_bytes(std::size_t actuator_count);

/// A model of the line to the vest. The line has a mailbox of one slot, in which the latest state replaces the one
/// before. A changed state leaves once the previous state is out and 5 ms have passed since the previous one began. An
/// unchanged state is sent again every 20 ms.
class LinkLoad {
 public:
  LinkLoad(std::size_t frame_bytes, double line_bytes_per_s);

  /// Posts a changed state. Times must ascend.
  void post(double time_s);
  /// Runs the line up to the end of the trace.
  void finish(double end_s) { run_to(end_s); }

  std::uint64_t changes() const { return changes_; }
  /// Changes that a newer change replaced before they could leave.
  std::uint64_t superseded() const { return superseded_; }
  double bytes_sent() const { return static_cast<double>(sent_) * frame_bytes_; }

 private:
  void run_to(double time_s);
  void send(double time_s);

  double frame_bytes_;
  double pause_s_;    ///< least time from the beginning of one frame to that of the next
  double refresh_s_;  ///< least time before an unchanged state is sent again
  bool linked_ = false;
  bool waiting_ = false;
  double last_sent_s_ = 0;
  std::uint64_t changes_ = 0;
  std::uint64_t superseded_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace vestige
