#include "cli/detectors.hpp"

#include <fmt/format.h>

#include "detector/embree_detector.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

void add_detector_options(CLI::App& verb, DetectorChoice& choice) {
  const auto add = [&](const char* name, auto& value, const char* description) {
    return verb.add_option(name, value, description)->group(kDetectorGroup);
  };
  add("--device", choice.device, "EGL device, as 'vestige devices' counts them [default: the first GPU, else software]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("K");
  add("--method", choice.method,
      "static: each segment against the triangle as it is now, as the paper does; carried: its start moves along with "
      "the triangle; ccd: both move, the first time they meet")
      ->capture_default_str()
      ->check(CLI::IsMember({"static", "carried", "ccd"}));
  add("--skip", choice.skip, "off: every segment meets every triangle")
      ->capture_default_str()
      ->check(CLI::IsMember({"off"}));
  add("--surface", choice.surface,
      "all: skin without an actuator hides what lies behind it; mapped: it is passed through")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "mapped"}));
}

Method DetectorChoice::method_kind() const {
  if (method == "carried") return Method::kCarried;
  return method == "ccd" ? Method::kCcd : Method::kStatic;
}

bool is_detector(const std::string& name) {
  return name == "paper" || name == "geometry" || name == "cpu" || name == "exact" || name == "embree" ||
         name == "embree_default";
}

ContextKind context_kind(const std::string& context) {
  if (context == "egl") return ContextKind::kEgl;
  if (context == "osmesa") return ContextKind::kOsMesa;
  return ContextKind::kAuto;
}

std::unique_ptr<Detector> make_detector(const std::string& name, const std::string& context,
                                        const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                        PlaneSet planes) {
  const DetectorOptions options = {choice.surface_kind(), planes, choice.method_kind()};
  if (name == "exact") return make_exact_detector(avatar, map, options);
  if (name == "embree") return make_embree_detector(EmbreeMode::kRobust, avatar, map, options);
  if (name == "embree_default") return make_embree_detector(EmbreeMode::kDefault, avatar, map, options);
  if (name == "geometry")
    return make_geometry_detector(make_gl_context(context_kind(context), choice.device), avatar, map, options);
  if (name != "paper") return make_cpu_detector(avatar, map, options);
  if (options.method != Method::kStatic)
    throw UsageError("--method", fmt::format("the published method knows no '{}'", choice.method),
                     "choose --detector geometry or cpu, or --method static");
  return make_paper_detector(make_gl_context(context_kind(context), choice.device), avatar, map, options);
}

}  // namespace vestige::cli
