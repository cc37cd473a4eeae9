#pragma once

#include <span>
#include <string_view>

namespace vestige::cli {

/// Which of `names` was probably meant by `word`: the first that is fewest changes of a letter away, two at most and
/// fewer than half of its letters. Empty where there is none.
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names);

}  // namespace vestige::cli
