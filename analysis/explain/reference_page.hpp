#pragma once

#include <string>

namespace vestige {

/// Returns the page about all kinds of files, as Markdown: docs/reference/files.md.
std::string reference_page();

}  // namespace vestige
