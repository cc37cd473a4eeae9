#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// An actuator that vibrates when another one's region is touched.
struct Fired {
  std::uint32_t actuator = 0;  ///< from 0
  double gain = 1;             ///< of the amplitude that the region's own actuator would have: above 0, at most 1

  friend bool operator==(const Fired&, const Fired&) = default;
};

/// Which actuators vibrate for a region: its own, unless the map says otherwise (HAVE 2010 §III.B: "one can easily
/// imagine a mapping that would give haptic feedback on a different location").
class Firing {
 public:
  /// Every region fires its own actuator.
  Firing() = default;

  /// Reads "fires" of a map's sidecar: {"chest left": {"back left": 1, "back right": 0.5}}. Actuators are named, or
  /// numbered from 1; a name wins over a number. A region that is not listed fires its own actuator, and one with {}
  /// fires none. Throws `Error`, which quotes `where`, for unknown or ambiguous names, and gains that are not above 0
  /// and at most 1.
  Firing(const nlohmann::json& fires, std::span<const std::string> names, const std::string& where);

  bool is_own() const { return elsewhere_.empty(); }
  bool is_own(std::uint32_t region) const { return !elsewhere_.contains(region); }
  /// Returns what a region (from 0) fires.
  std::vector<Fired> of(std::uint32_t region) const;
  /// Calls `take(Fired)` for each of these.
  template <typename Take>
  void for_each(std::uint32_t region, Take&& take) const {
    const auto found = elsewhere_.find(region);
    if (found == elsewhere_.end()) return take(Fired{region, 1});
    for (const Fired& fired : found->second) take(fired);
  }
  /// Returns, for each region, the first one that fires the same actuators, whatever the gains: they feel alike.
  std::vector<std::uint32_t> first_alike(std::size_t regions) const;
  /// Returns the amplitudes of the actuators. `asked` has one for each region. Where several regions fire an actuator,
  /// the strongest counts. Returns `asked` itself if every region fires its own actuator, otherwise `room`.
  const std::vector<double>& apply(const std::vector<double>& asked, std::vector<double>& room) const;

  friend bool operator==(const Firing&, const Firing&) = default;

 private:
  std::map<std::uint32_t, std::vector<Fired>> elsewhere_;  ///< by region
};

/// "back left, back right (0.5)"; "nothing" if there is none. Of many, the first six.
std::string describe(std::span<const Fired> fired, std::span<const std::string> names);

}  // namespace vestige
