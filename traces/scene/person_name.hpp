#pragma once

#include <string>
#include <string_view>

namespace vestige {

/// The longest name of a person, in bytes.
inline constexpr std::size_t kMostNameBytes = 100;

/// Returns what is wrong with a person's name; empty if nothing is. A name is one line of UTF-8, of at most
/// `kMostNameBytes`. An empty one is no name, and right.
std::string name_fault(std::string_view name);

/// Returns a name without such faults, for a trace that another program wrote.
std::string readable_name(std::string_view name);

}  // namespace vestige
