#pragma once

#include <string>
#include <vector>

#include "analysis/run/playback.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/options.hpp"
#include "cli/vest/sink_choice.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

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
};

}  // namespace vestige::cli
