#pragma once

#include <chrono>

namespace vestige {

inline double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Returns the CPU time of the calling thread. Other threads and processes do not count.
double thread_cpu_s();

/// Returns the CPU time of all threads of this process.
double process_cpu_s();

}  // namespace vestige
