#include "analysis/mapping/layouts.hpp"
namespace vestige {
std::vector<std::string> layout_names() { return {"paper6", "torso16", "torso40", "body"}; }
std::string layout_summary(std::string_view l) { return "layout " + std::string(l); }
ActuatorMapFiles read_map_files(const Avatar&, const std::string& map) { for (auto& n : layout_names()) if (n == map) return read_actuator_map_files("builtin"); return read_actuator_map_files(map); }
}
