#pragma once

#include <cstdint>
#include <functional>

namespace vestige {

/// Runs `work` in a child process, for libraries that crash or hang on damaged files. Returns 0 if it finished,
/// otherwise the number of the signal that killed it: SIGXCPU after `most_s` seconds of processor time. Exceptions and
/// output of `work` are ignored. Precondition: no threads have been started. Throws `Error` if the process cannot be
/// created.
int signal_that_ends(const std::function<void()>& work, std::uint64_t most_s);

}  // namespace vestige
