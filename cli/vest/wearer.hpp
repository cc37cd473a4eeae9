#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "cli/vest/sink_choice.hpp"
#include "cli/vest/stream_log.hpp"
#include "cli/vest/vest_options.hpp"
#include "detector/actuators/actuator_map_watch.hpp"
#include "detector/actuators/law_maker.hpp"
#include "transport/sender.hpp"

namespace vestige::cli {

/// A vest that a person of a scene wears: what the flags say of it.
struct WornVest {
  std::size_t person = 0;  ///< from 0 on
  std::string port;
  std::string map;        ///< of --map; empty: the person's own
  std::string map_stamp;  ///< of the map's files before they were read; empty if they are not watched
  std::string log;        ///< empty: none is written
};

/// A person who feels a scene while it goes on: turns the contacts of that person into frames, and sends them to the
/// vest.
class Wearer {
 public:
  /// Measures the layout if the law needs one, and makes the detector. Keeps references to all but `context`. Throws
  /// `Error` if the person has no actuator.
  Wearer(const VestOptions& options, const WornVest& vest, TracedPerson& person, const std::string& detector,
         SharedContext& context);

  const TracedPerson& person() const { return person_; }
  std::size_t number() const { return vest_.person; }
  Detector& detector() const { return *detector_; }
  const OpenSink& sink() const { return *sink_; }
  const LawMaker& laws() const { return laws_; }

  /// Opens the log and the port, and watches the map. `tell` may be called in other threads.
  void open(const std::function<void(const std::string&)>& tell);
  /// Begins to send. Precondition of all that follow: `open` was called.
  void start(const std::function<void(const std::string&)>& tell);

  LawMaker::Law make_law() { return laws_.make(); }
  /// Takes the map over if it changed on disk, and keeps the vest alive.
  void still_here(const std::function<void(const std::string&)>& tell);
  void take(const ActuatorFrame& frame, Sender::Clock::time_point due);

  /// Begins to switch the vest off, without waiting for its answers.
  void stop() { sender_->stop(); }
  /// Waits until the vest is off.
  void finish();
  /// Gives the files of frames and states their names. Without this call they leave nothing behind. Precondition:
  /// `finish` was called.
  void commit();

  const SenderStatistics& sent() const { return sent_; }
  std::uint64_t maps_reloaded() const { return maps_reloaded_; }

 private:
  const VestOptions& options_;
  const WornVest& vest_;
  TracedPerson& person_;
  LawMaker laws_;
  std::unique_ptr<Detector> detector_;
  std::optional<StreamLog> log_;
  std::optional<OpenSink> sink_;
  std::optional<ActuatorMapWatch> watch_;
  std::optional<Sender> sender_;  // after the sink, which it uses
  SenderStatistics sent_;
  std::uint64_t maps_reloaded_ = 0;
};

}  // namespace vestige::cli
