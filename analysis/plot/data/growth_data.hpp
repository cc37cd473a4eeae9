#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// The cost of a frame at one size.
struct GrowthPoint {
  double size = 0;  ///< number of colliders or triangles, at least 1
  double us = 0;    ///< mean microseconds of a frame, above 0
};

/// One line of a panel. Points are by rising size.
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

/// The part of growth.json that is drawn.
struct GrowthResult {
  std::array<GrowthPanel, 2> panels;  ///< against colliders and against triangles
  std::string renderer;               ///< empty without OpenGL
  std::string machine;
  std::string avatar;
  std::string commit;
  double colliders = 0;  ///< number of colliders in the second panel
};

/// Reads FOLDER/growth.json. Throws `Error` with file and field.
GrowthResult read_growth(const std::filesystem::path& folder);

}  // namespace vestige::plot
