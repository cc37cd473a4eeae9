#pragma once

#include <sys/resource.h>

namespace vestige::test {

/// Measures how far the peak memory of this process has grown since this object was made.
class MemoryGrowth {
 public:
  long kibibytes() const { return peak_kibibytes() - before_; }

 private:
  static long peak_kibibytes() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  }

  long before_ = peak_kibibytes();
};

}  // namespace vestige::test
