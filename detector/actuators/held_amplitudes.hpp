#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vestige {

/// What a contact asks of one actuator.
struct Share {
  std::uint32_t actuator = 0;  ///< from 0
  double amplitude = 0;        ///< more than 0, at most 1

  friend bool operator==(const Share&, const Share&) = default;
};

/// What contacts asked for, held for a while after: the largest amplitude for each actuator.
class HeldAmplitudes {
 public:
  enum class Rule {
    kEveryContact,      ///< each contact is held
    kLatestOfCollider,  ///< a collider's next contact takes the place of the one before: it is in one place at a time
  };

  HeldAmplitudes(std::size_t actuator_count, double hold_s, Rule rule);

  /// Goes on to `time_s`, which must not decrease, and drops what was asked for `hold_s` or longer ago.
  void begin(double time_s);
  /// A contact of now. `column`: of its collider. No shares: a contact that asks for nothing, which is no contact.
  void add(std::uint32_t column, std::span<const Share> shares);
  /// 0 … 1 for each actuator, now. The reference stays good until the next `begin`.
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
  // kEveryContact: for each actuator, what amplitude_ lasts until, and behind it weaker ones that outlast it.
  std::vector<double> until_s_;
  std::vector<std::vector<Held>> weaker_;
  // kLatestOfCollider
  std::vector<Collider> colliders_;  // by column
  std::vector<std::uint32_t> live_;  // columns
};

}  // namespace vestige
