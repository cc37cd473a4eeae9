#pragma once

#include <cstddef>
#include <string>

#include "analysis/view/page_packer.hpp"

namespace vestige {

/// Browsers open larger pages slowly.
inline constexpr std::size_t kLargePage_bytes = 25'000'000;

/// Returns a whole HTML page that shows `content` and needs nothing beside it: scripts, style and data are in it, and
/// it forbids the browser any request. The head must also have `about` (texts). Names in the
/// head and `title` may hold anything; they stay text.
std::string make_page(const std::string& title, const PageContent& content);

}  // namespace vestige
