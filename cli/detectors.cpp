#include "cli/detectors.hpp"

namespace vestige::cli {

void add_detector_options(CLI::App& verb, DetectorChoice& choice) {
  const auto add = [&](const char* name, auto& value, const char* description) {
    return verb.add_option(name, value, description)->group(kDetectorGroup);
  };
  add("--device", choice.device, "EGL device, as 'vestige devices' counts them [default: the first GPU, else software]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("K");
  add("--method", choice.method, "static: each segment against the triangle as it is now, as the paper does")
      ->capture_default_str()
      ->check(CLI::IsMember({"static"}));
  add("--skip", choice.skip, "off: every segment meets every triangle")
      ->capture_default_str()
      ->check(CLI::IsMember({"off"}));
  add("--surface", choice.surface,
      "all: skin without an actuator hides what lies behind it; mapped: it is passed through")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "mapped"}));
}

ContextKind context_kind(const std::string& context) {
  if (context == "egl") return ContextKind::kEgl;
  if (context == "osmesa") return ContextKind::kOsMesa;
  return ContextKind::kAuto;
}

std::unique_ptr<Detector> make_detector(const std::string& name, const std::string& context,
                                        const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                        PlaneSet planes) {
  const DetectorOptions options = {choice.surface_kind(), planes};
  if (name != "paper") return make_cpu_detector(avatar, map, options);
  return make_paper_detector(make_gl_context(context_kind(context), choice.device), avatar, map, options);
}

}  // namespace vestige::cli
