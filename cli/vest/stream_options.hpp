#pragma once

#include <string>
#include <vector>

#include "analysis/run/playback.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/options.hpp"
#include "cli/vest/sink_choice.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

inline constexpr PersonFlag kPortFlag = {"--port", "port", "/dev/ttyUSB0"};

/// What `vestige stream` is asked for.
struct StreamOptions {
  CommonOptions common;
  DetectorChoice choice;
  SinkChoice sink;  ///< without the port
  std::vector<std::string> ports;
  PlaybackOptions playback;
  std::string trace;
  std::vector<std::string> maps;
  LawFlags law;
  std::string log;

  /// Whether the ports take poses and colliders in the place of actuator frames.
  bool plays_people() const { return sink.at(parse_person_value(ports.front()).value).is_vmc(); }
};

}  // namespace vestige::cli
