#include "analysis/live/realtime.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace vestige {

namespace {

constexpr int kPriority = 20;

/// Returns the limit of a resource, or `most` if it has none.
rlim_t limit_of(__rlimit_resource resource, rlim_t most) {
  rlimit limit = {};
  if (::getrlimit(resource, &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? most : std::min(limit.rlim_cur, most);
}

/// Returns 0, or the number of the error.
int schedule_by_fifo(int priority) {
  sched_param parameters = {};
  parameters.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

RealTime take_real_time() {
  RealTime taken;
  const auto allowed = static_cast<int>(limit_of(RLIMIT_RTPRIO, kPriority));
  if (schedule_by_fifo(kPriority) == 0) {
    taken.priority = kPriority;
  } else if (allowed > 0 && schedule_by_fifo(allowed) == 0) {
    taken.priority = allowed;
  } else {
    taken.refused.emplace_back(
        "the system does not allow real-time scheduling; grant it by 'USER - rtprio 20' in "
        "/etc/security/limits.conf, and log in again");
  }
  const bool is_unlimited = ::geteuid() == 0 || limit_of(RLIMIT_MEMLOCK, RLIM_INFINITY) == RLIM_INFINITY;
  if (is_unlimited && ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
    taken.memory_locked = true;
  } else {
    taken.refused.emplace_back(
        "the system does not allow to lock all memory; grant it by 'USER - memlock unlimited' in "
        "/etc/security/limits.conf, and log in again");
  }
  return taken;
}

void take_core(RealTime& real_time) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (::sched_getaffinity(0, sizeof cores, &cores) != 0 || CPU_COUNT(&cores) < 2) {
    real_time.refused.emplace_back("there is no second core, so none is set apart");
    return;
  }
  std::size_t last = CPU_SETSIZE - 1;
  while (!CPU_ISSET(last, &cores)) --last;
  cpu_set_t own;
  CPU_ZERO(&own);
  CPU_SET(last, &own);
  if (const int error = ::pthread_setaffinity_np(::pthread_self(), sizeof own, &own); error != 0) {
    real_time.refused.push_back(fmt::format("core {} could not be taken: {}", last, std::strerror(error)));
    return;
  }
  real_time.core = static_cast<int>(last);
}

}  // namespace vestige
