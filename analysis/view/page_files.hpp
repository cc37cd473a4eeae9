#pragma once

#include <string_view>

/// The files of the page, embedded at build time by embed.cmake: those of analysis/view/page, and three.js of Debian's
/// package libjs-three.
namespace vestige::page_files {

extern const std::string_view kPageHtml;
extern const std::string_view kStyleCss;
extern const std::string_view kLicenceTxt;  ///< of three.js
extern const std::string_view kThreeMinJs;
extern const std::string_view kOrbitControlsJs;
extern const std::string_view kDataJs;
extern const std::string_view kTraceJs;
extern const std::string_view kBodyJs;
extern const std::string_view kSceneJs;
extern const std::string_view kStillJs;
extern const std::string_view kRasterJs;
extern const std::string_view kPlayerJs;

}  // namespace vestige::page_files
