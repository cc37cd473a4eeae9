#pragma once

#include <string_view>

/// The GLSL sources, without the #version line and the defines. The caller that compiles them puts those first.
namespace vestige::shaders {

extern const std::string_view kConstantsH;
extern const std::string_view kPaperVert;
extern const std::string_view kPaperGeom;
extern const std::string_view kPaperFrag;
extern const std::string_view kGeometryVert;
extern const std::string_view kGeometryGeom;
extern const std::string_view kCandidatesGlsl;
extern const std::string_view kCandidatesVert;
extern const std::string_view kCandidatesGeom;
extern const std::string_view kCandidatesComp;
extern const std::string_view kCullComp;
extern const std::string_view kSceneVert;
extern const std::string_view kSceneFrag;
extern const std::string_view kProbeGlsl;

}  // namespace vestige::shaders
