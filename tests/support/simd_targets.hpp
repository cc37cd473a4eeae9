#pragma once

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <cstdint>

namespace vestige::test {

/// Calls `run(name)` once for each instruction set that this machine has and the program was compiled for, including
/// plain scalar code. During the call, all code that chooses an instruction set at run time chooses that one.
template <typename Run>
void on_every_simd_target(Run&& run) {
  const std::int64_t supported = hwy::SupportedTargets();
  for (std::int64_t rest = supported; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    hwy::GetChosenTarget().Update(target);
    run(hwy::TargetName(target));
  }
  hwy::GetChosenTarget().Update(supported);
}

}  // namespace vestige::test
