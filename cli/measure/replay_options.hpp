#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/choices/detectors.hpp"
#include "cli/options.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

/// What `vestige replay` is asked for.
struct ReplayOptions {
  CommonOptions common;
  DetectorChoice choice;
  std::string trace;
  std::size_t threads = 0;  ///< 0: the verb chooses
  LawFlags law;
  std::vector<std::string> maps;
  std::vector<std::string> map_at;
  std::string contacts;
  std::string textures;
  std::string planes = "actuator,t,triangle";
  std::string timeline;
  std::string verify;
};

}  // namespace vestige::cli
