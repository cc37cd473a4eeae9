#pragma once

#include <string>
#include <vector>

#include "analysis/run/frame_pace.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/options.hpp"
#include "cli/vest/sink_choice.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

inline constexpr PersonFlag kPortFlag = {"--port", "port", "/dev/ttyUSB0"};

/// What a verb is asked for that lets people feel a scene on vests.
struct VestOptions {
  CommonOptions common;
  DetectorChoice choice;
  SinkChoice sink;  ///< without the port
  std::vector<std::string> ports;
  std::vector<std::string> maps;
  LawFlags law;
  std::string log;
  std::string scene;    ///< what is felt, for messages: the trace, or where live input comes from
  double law_rate = 1;  ///< seconds of the scene per second of the vest

  /// Whether the ports take poses and colliders in the place of actuator frames.
  bool plays_people() const { return sink.at(parse_person_value(ports.front()).value).is_vmc(); }
};

/// What `vestige stream` is asked for.
struct StreamOptions : VestOptions {
  PlaybackOptions playback;
  std::string trace;
};

}  // namespace vestige::cli
