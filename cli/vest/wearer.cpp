#include "cli/vest/wearer.hpp"

#include <fmt/format.h>

#include "cli/choices/person_maps.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

/// Returns laws for pressures if the sink asks for them, else those of --law.
LawMaker law_maker_of(const VestOptions& options, const WornVest& vest, const TracedPerson& person) {
  if (person.map.actuator_count == 0)
    throw Error(vest.map.empty() ? options.scene : vest.map,
                person.name.empty() ? "has no actuator, so nothing would be felt"
                                    : person.name + " has no actuator, so nothing would be felt",
                person.name.empty() ? "name a map that has actuators: --map FILE.png"
                                    : fmt::format("name a map that has actuators: --map {}=FILE.png", vest.person + 1));
  const double rate = options.law_rate;
  if (options.sink.quantity() == Quantity::kPressure) return {person.map, options.law.options(rate).hold_s};
  return LawMaker(DriveMaker(options.law, person.avatar, person.map, rate));
}

}  // namespace

Wearer::Wearer(const VestOptions& options, const WornVest& vest, TracedPerson& person, const std::string& detector,
               SharedContext& context)
    : options_(options),
      vest_(vest),
      person_(person),
      laws_(law_maker_of(options, vest, person)),
      detector_(make_detector(detector, context, options.choice, person.avatar, person.map, laws_.planes())) {}

void Wearer::open(const std::function<void(const std::string&)>& tell) {
  const std::size_t actuator_count = person_.map.actuator_count;
  if (!vest_.log.empty()) log_.emplace(vest_.log, options_.common.overwrite(), actuator_count);
  sink_.emplace(options_.sink.at(vest_.port), person_.map.names, options_.common);
  sink_->warn_of_actuators_beyond(actuator_count, options_.common.verbosity());
  if (!vest_.map_stamp.empty())
    watch_.emplace(vest_.map, vest_.map_stamp, actuator_count, person_.avatar,
                   laws_.needs_layout() ? ActuatorMapWatch::Layouts::kMeasured : ActuatorMapWatch::Layouts::kNone,
                   tell);
}

void Wearer::start(const std::function<void(const std::string&)>& tell) {
  const SenderOptions options = {.floor = sink_->floor(), .refresh = sink_->refresh(), .keep_log = log_.has_value()};
  sender_.emplace(sink_->sink(), options, tell);
}

void Wearer::still_here(const std::function<void(const std::string&)>& tell) {
  if (auto taken = watch_ ? watch_->take() : std::nullopt) {
    person_.map = std::move(taken->map);
    laws_.use(person_.map, taken->layout);
    ++maps_reloaded_;
    tell(vest_.map + ": was changed, and is felt as it is now");
    for (const std::string& warning : map_warnings(person_.map, person_, {options_.scene, vest_.map})) tell(warning);
  }
  sender_->still_here();
}

void Wearer::take(const ActuatorFrame& frame, Sender::Clock::time_point due) {
  sender_->post(frame, due);
  if (log_) log_->write(sender_->take_log());
}

void Wearer::finish() {
  sent_ = sender_->finish();
  if (log_) log_->write(sender_->take_log());
}

void Wearer::commit() {
  sink_->commit();
  if (log_) log_->commit();
}

}  // namespace vestige::cli
