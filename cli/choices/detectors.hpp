#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/terminal.hpp"
#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/method.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::cli {

/// What each method does, for the help of --method.
inline constexpr const char* kMethodHelp =
    "static: test each segment against the triangle as it is in this frame, as the paper does; carried: first move the "
    "segment's start along with the triangle; ccd: segment and triangle both move, and the first time at which they "
    "meet counts";

/// The help of --context, for a verb that runs in one context.
inline constexpr const char* kContextHelp = "OpenGL context that paper, geometry and compute run in";

/// The flags for the detector and the place where it runs.
struct DetectorChoice {
  std::string detector = "auto";
  std::string context = "auto";
  int device = -1;
  std::string surface = "all";
  std::string method = "static";
  std::string skip = "on";
  double keep = 0.1;

  Method method_kind() const { return method_named(method); }
  Surface surface_kind() const { return surface == "mapped" ? Surface::kMapped : Surface::kAll; }
  Skip skip_kind() const { return skip == "on" ? Skip::kOn : Skip::kOff; }
};

/// The help group of these flags, together with --detector and --context.
inline constexpr const char* kDetectorGroup = "Detector";

/// Adds --detector and --context, for a verb that runs one detector.
void add_detector_and_context(CLI::App& verb, DetectorChoice& choice);

/// Adds --device, --method, --keep, --skip and --surface, which mean the same in every verb.
void add_detector_options(CLI::App& verb, DetectorChoice& choice);

/// As above, for a verb that compares several settings of --skip: `skips` is their list.
void add_detector_options(CLI::App& verb, DetectorChoice& choice, std::string& skips);

/// The values of --skip, or of its list.
inline const std::vector<std::string> kSkipNames = {"on", "off"};

/// Returns whether --skip affects the detector of this name.
bool knows_skip(const std::string& detector);

/// `context` is "auto", "egl" or "osmesa".
ContextKind context_kind(const std::string& context);

/// The names that `make_detector` knows, except "auto".
const std::vector<std::string>& detector_names();
/// Whether a detector puts simpler shapes in place of the avatar's skin.
bool is_approximate(const std::string& detector);
bool needs_opengl(const std::string& detector);
/// Whether a detector tests spheres. The others test the paths of their centres.
bool takes_radii(const std::string& detector);
/// Warns of detectors that ignore the radii of colliders, of which `spheres` have one. `scene` is the name of what they
/// are in.
void warn_of_radii(const std::vector<std::string>& detectors, std::size_t spheres, std::size_t colliders,
                   const std::string& scene, Verbosity verbosity);
/// The same for the colliders of a trace. `file` is its name.
void warn_of_radii(const std::vector<std::string>& detectors, TraceReader& trace, const std::string& file,
                   Verbosity verbosity);
/// Those that test the avatar's skin itself, and no simpler shape in its place.
std::vector<std::string> skin_detector_names();
bool is_detector(const std::string& name);

inline constexpr const char* kDeviceHelp =
    "EGL device, by its number in 'vestige devices' [default: the first GPU, otherwise software]";

/// Returns the help of a list of detectors. `verb` is what is done to them: "measure".
std::string describe_detectors(const char* verb, const std::vector<std::string>& names);

/// Returns the help of a list of methods. `verb` is what is done with them: "measure".
std::string describe_methods(const char* verb);

/// Makes a detector: one of `detector_names`, or "auto", which is "cpu". `context` is "auto", "egl" or "osmesa". Throws
/// `std::logic_error` for any other name of a detector. The detector finds depths only if `planes` has them.
std::unique_ptr<Detector> make_detector(const std::string& name, const std::string& context,
                                        const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                        PlaneSet planes);
/// The OpenGL context that several detectors of a thread share. The first that needs it makes it.
class SharedContext {
 public:
  /// `context` is "auto", "egl" or "osmesa".
  SharedContext(const std::string& context, int device) : kind_(context_kind(context)), device_(device) {}
  std::shared_ptr<GlContext> get();

 private:
  ContextKind kind_;
  int device_;
  std::shared_ptr<GlContext> made_;
};

/// As above, in a shared context.
std::unique_ptr<Detector> make_detector(const std::string& name, SharedContext& context, const DetectorChoice& choice,
                                        const Avatar& avatar, const ActuatorMap& map, PlaneSet planes);

/// Makes a detector for each person of a trace, in one context.
std::vector<std::unique_ptr<Detector>> make_detectors(const std::string& name, const DetectorChoice& choice,
                                                      std::span<const TracedPerson> people, PlaneSet planes);

}  // namespace vestige::cli
