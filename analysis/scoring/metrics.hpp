#pragma once

#include <cstdint>
#include <span>

namespace vestige {

struct LawTally;

enum class Better : std::uint8_t { kHigher, kLower, kNeither };

/// Where a metric stands: in files only, or also on the terminal beside the metric that ranks.
enum class Shown : std::uint8_t { kInFiles, kBesideTheRank };

/// One number that a mapping is judged by, with all that is known of it. Names are columns of files. Their meaning
/// never changes.
struct Metric {
  const char* name;
  const char* unit;
  Better better;
  bool model_based;  ///< computed by a model of perception, motors or link, not measured in a user study
  Shown shown;
  const char* formula;
  const char* source;
  double (*value)(const LawTally& all);  ///< NaN if undefined, for example without contacts or slides
};

std::span<const Metric> metrics();

}  // namespace vestige
