#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"

namespace vestige::cli {

/// What --method takes.
inline const std::vector<std::string> kMethodNames = {"static", "carried", "ccd"};

/// One of `kMethodNames`.
Method method_named(const std::string& name);

/// The flags that choose a detector and where it runs.
struct DetectorChoice {
  std::string detector = "auto";
  std::string context = "auto";
  int device = -1;
  std::string surface = "all";
  std::string method = "static";
  std::string skip = "on";

  Method method_kind() const { return method_named(method); }
  Surface surface_kind() const { return surface == "mapped" ? Surface::kMapped : Surface::kAll; }
  Skip skip_kind() const { return skip == "on" ? Skip::kOn : Skip::kOff; }
};

/// The group of help that they stand in, with --detector and --context.
inline constexpr const char* kDetectorGroup = "Detector";

/// Adds --detector and --context, for a verb that runs one detector.
void add_detector_and_context(CLI::App& verb, DetectorChoice& choice);

/// Adds --device, --method, --skip and --surface, which mean the same in every verb.
void add_detector_options(CLI::App& verb, DetectorChoice& choice);

/// The same, for a verb that measures several settings of --skip against each other: `skips` is their list.
void add_detector_options(CLI::App& verb, DetectorChoice& choice, std::string& skips);

/// What --skip takes, or lists.
inline const std::vector<std::string> kSkipNames = {"on", "off"};

/// Whether --skip makes a difference to the detector of this name.
bool knows_skip(const std::string& detector);

/// "auto", "egl" or "osmesa".
ContextKind context_kind(const std::string& context);

/// What `make_detector` knows, "auto" apart.
const std::vector<std::string>& detector_names();
bool is_detector(const std::string& name);

/// Makes a detector: "cpu" (also "auto"), "exact", "geometry", "embree", "embree_default" or "paper". `context`:
/// "auto", "egl" or "osmesa".
std::unique_ptr<Detector> make_detector(const std::string& name, const std::string& context,
                                        const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                        PlaneSet planes);

}  // namespace vestige::cli
