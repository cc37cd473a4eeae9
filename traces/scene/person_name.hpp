#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// The longest name of a person, in bytes.
inline constexpr std::size_t kMostNameBytes = 100;

/// Returns what is wrong with a person's name; empty if nothing is. A name is one line of UTF-8, of at most
/// `kMostNameBytes`, and not blank. An empty one is no name, and right.
std::string name_fault(std::string_view name);

/// Returns a name without such faults, for a trace that another program wrote.
std::string readable_name(std::string_view name);

/// Returns the names of a trace's people from the recorded ones, readable. Of several people each has another: one
/// without a name, or with the name of an earlier one, is "person 2".
std::vector<std::string> names_of_people(const std::vector<std::string>& recorded);

}  // namespace vestige
