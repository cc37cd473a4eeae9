#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// What a frame costs at one size.
struct GrowthPoint {
  double size = 0;  ///< colliders or triangles, at least 1
  double us = 0;    ///< mean microseconds of a frame, above 0
};

/// One line of a panel; points by rising size.
struct GrowthLine {
  std::string detector;
  std::string context;  ///< empty without OpenGL
  std::string skip;
  std::vector<GrowthPoint> points;
};

struct GrowthPanel {
  std::string along;  ///< "Number of colliders"
  std::vector<GrowthLine> lines;
};

/// growth.json, as far as it is drawn.
struct GrowthResult {
  std::array<GrowthPanel, 2> panels;  ///< against colliders and against triangles
  std::string renderer;               ///< empty without OpenGL
  std::string machine;
  std::string avatar;
  std::string commit;
  double colliders = 0;  ///< of the second panel
};

/// Reads FOLDER/growth.json. Throws `Error` naming file and field.
GrowthResult read_growth(const std::filesystem::path& folder);

}  // namespace vestige::plot
