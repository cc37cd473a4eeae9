#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vestige {

/// What the system grants to a thread that must not wait for others.
struct RealTime {
  std::optional<int> priority = {};  ///< of SCHED_FIFO; nothing: refused
  bool memory_locked = false;        ///< no page of this program leaves memory
  std::optional<int> core = {};      ///< of the processor, to which the thread is bound; nothing: refused
  /// What was refused, one sentence each, with what to grant.
  std::vector<std::string> refused = {};
};

/// Schedules the calling thread by SCHED_FIFO, with priority 20 or what the limit `rtprio` allows, and locks the
/// program's memory unless the limit `memlock` is finite: with that, later allocations would fail. Threads that the
/// calling thread starts from now on are scheduled so, too.
RealTime take_real_time();

/// Binds the calling thread to the last core that it may use, if there are several. Threads that it starts from now on
/// are bound, too.
void take_core(RealTime& real_time);

}  // namespace vestige
