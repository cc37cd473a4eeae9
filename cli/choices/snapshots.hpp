#pragma once

#include <filesystem>
#include <functional>

#include "cli/terminal.hpp"

namespace vestige::cli {

enum class Snapshots { kWanted, kIgnored };

/// From now on, SIGUSR1 requests a snapshot or does nothing. Without this call it would end the program.
void catch_snapshots(Snapshots snapshots);

/// Returns whether a snapshot was requested since the last call.
bool snapshot_wanted();

/// Returns what says on standard error which snapshot was written, and how many seconds it holds. With kQuiet, returns
/// nothing. It may be called in any thread.
std::function<void(const std::filesystem::path&, double)> snapshot_teller(Verbosity verbosity);

}  // namespace vestige::cli
