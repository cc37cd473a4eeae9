#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// The cost of a frame at one size.
struct GrowthPoint {
  double size = 0;  ///< number of colliders, triangles or people, at least 1
  double us = 0;    ///< mean microseconds of a frame, above 0
};

/// One line of a panel. Points are by rising size.
struct GrowthLine {
  std::string detector;
  std::string context;  ///< empty without OpenGL
  std::string skip;
  bool first_only = false;  ///< of several people, only the first has colliders
  std::vector<GrowthPoint> points;
};

struct GrowthPanel {
  std::string title;
  std::string along;  ///< "Number of colliders"
  std::vector<GrowthLine> lines;
};

/// What is drawn of costs that grow.
struct GrowthResult {
  std::vector<GrowthPanel> panels;  ///< at least one
  std::string legend;               ///< what the small print says of the lines
  std::string renderer;             ///< empty without OpenGL
  std::string machine;
  std::string avatar;
  std::string commit;
};

/// Reads the cost against colliders and against triangles from FOLDER/growth.json. Throws `Error` with file and field.
GrowthResult read_growth(const std::filesystem::path& folder);

}  // namespace vestige::plot
