#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vestige {

/// The amplitude that a contact requests from one actuator.
struct Share {
  std::uint32_t actuator = 0;  ///< from 0
  double amplitude = 0;        ///< more than 0, at most 1

  friend bool operator==(const Share&, const Share&) = default;
};

/// Holds the amplitudes that contacts request for a while: the largest amplitude for each actuator.
class HeldAmplitudes {
 public:
  enum class Rule {
    kEveryContact,      ///< each contact is held
    kLatestOfCollider,  ///< a collider's next contact replaces its previous one, because a collider is in one place at
                        ///< a time
  };

  HeldAmplitudes(std::size_t actuator_count, double hold_s, Rule rule);

  /// Advances to `time_s`, which must not decrease. Drops requests that are `hold_s` old or older.
  void begin(double time_s);
  /// Adds a contact at the current time. `column` is the column of its collider. A contact without shares requests
  /// nothing and is ignored.
  void add(std::uint32_t column, std::span<const Share> shares);
  /// Returns the current amplitude 0 … 1 of each actuator. The reference is valid until the next `begin`.
  const std::vector<double>& now();

 private:
  struct Held {
    double until_s;
    double amplitude;
  };
  struct Collider {
    double until_s = 0;
    bool is_live = false;
    std::vector<Share> shares;
  };

  Rule rule_;
  double hold_s_;
  double time_s_ = 0;
  std::vector<double> amplitude_;
  // kEveryContact: for each actuator, the time until which amplitude_ lasts, and then weaker amplitudes that outlast
  // it.
  std::vector<double> until_s_;
  std::vector<std::vector<Held>> weaker_;
  // kLatestOfCollider
  std::vector<Collider> colliders_;  // by column
  std::vector<std::uint32_t> live_;  // columns
};

}  // namespace vestige
