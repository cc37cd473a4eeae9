#pragma once

#include <chrono>

namespace vestige {

inline double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// That the calling thread has computed for, however many run beside it.
double thread_cpu_s();

}  // namespace vestige
