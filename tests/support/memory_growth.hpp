#pragma once

#include <sys/resource.h>

namespace vestige::test {

/// How much more memory this process has needed at its peak than when this was made.
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
