#pragma once

#include <cstdint>
#include <functional>

namespace vestige {

/// Runs `work` in a copy of this process, of which nothing is left but this: 0 where it ended, else the signal that
/// ended it: SIGXCPU after `most_s` of processor time. For libraries that crash on damaged files, or never come to an
/// end. What it throws is no matter, nor what it prints. To be called before threads are started. Throws `Error` where
/// no process can be made.
int signal_that_ends(const std::function<void()>& work, std::uint64_t most_s);

}  // namespace vestige
