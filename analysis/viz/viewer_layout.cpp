#include "analysis/viz/viewer_layout.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/colours/region_colours.hpp"
#include "analysis/viz/viz_trace.hpp"
#include "traces/viz/viz_bodies.hpp"
#include "traces/viz/viz_format.hpp"

namespace vestige {

namespace {

using nlohmann::ordered_json;

constexpr const char* kScenePanel = "3D!vestige";
constexpr const char* kDutyPanel = "Plot!vestige";
constexpr const char* kContactPanel = "RawMessages!vestige";

/// Foxglove and Lichtblick have keys of their own for the title.
ordered_json titled(const char* title, ordered_json panel) {
  panel["foxglovePanelTitle"] = title;
  panel["lichtblickPanelTitle"] = title;
  return panel;
}

/// The axes of all frames are hidden: they would cover the body.
ordered_json hidden_frames(std::span<const MappedPerson> people) {
  ordered_json frames;
  const auto hide = [&](const std::string& name) { frames["frame:" + name] = {{"visible", false}}; };
  hide(viz_format::kWorld);
  hide(viz_format::kUpright);
  const VizBodies bodies(avatars_of(people));
  for (const VizBody& body : bodies.people()) {
    hide(body.frame);
    for (const std::string& name : body.node_frames) hide(name);
  }
  return frames;
}

/// A floor of 10 m through the origin of the world. Grids lie in x and y, so it is turned: the world's y points up.
ordered_json floor_grid() {
  return {{"layerId", "foxglove.Grid"},
          {"instanceId", "floor"},
          {"label", "Floor"},
          {"visible", true},
          {"frameLocked", true},
          {"frameId", viz_format::kWorld},
          {"size", 10},
          {"divisions", 10},
          {"lineWidth", 1},
          {"color", "#8080807f"},
          {"position", {0, 0, 0}},
          {"rotation", {90, 0, 0}},
          {"order", 1}};
}

ordered_json scene_panel(std::span<const MappedPerson> people) {
  ordered_json topics;
  for (const char* topic : {viz_format::kMeshTopic, viz_format::kContactsTopic, viz_format::kSceneTopic})
    topics[topic] = {{"visible", true}};
  return {{"cameraState",
           {{"perspective", true},
            {"distance", 4},
            {"phi", 75},
            {"thetaOffset", 30},
            {"targetOffset", {0, 0, 0}},
            {"target", {0, 0, 0}},
            {"targetOrientation", {0, 0, 0, 1}},
            {"fovy", 45},
            {"near", 0.01},
            {"far", 5000}}},
          {"followMode", "follow-pose"},
          {"followTf", viz_format::kUpright},
          {"scene", {{"transforms", {{"showLabel", false}}}}},
          {"transforms", hidden_frames(people)},
          {"topics", std::move(topics)},
          {"layers", {{"floor", floor_grid()}}},
          {"publish", ordered_json::object()},
          {"imageMode", ordered_json::object()}};
}

ordered_json duty_panel(std::span<const MappedPerson> people) {
  const std::vector<std::string> names = viz_actuator_names(people);
  ordered_json paths = ordered_json::array();
  for (const MappedPerson& person : people)
    for (std::size_t actuator = 1; actuator <= person.map.actuator_count; ++actuator) {
      const plot::Colour colour = plot::region_colour(actuator, person.map.actuator_count);
      paths.push_back({{"value", fmt::format("{}.actuators[{}].duty", viz_format::kActuatorsTopic, paths.size())},
                       {"label", names[paths.size()]},
                       {"color", plot::css(colour)},
                       {"enabled", true},
                       {"timestampMethod", "receiveTime"}});
    }
  return {{"paths", std::move(paths)}, {"minYValue", 0},
          {"maxYValue", 255},          {"showXAxisLabels", true},
          {"showYAxisLabels", true},   {"showLegend", true},
          {"legendDisplay", "left"},   {"showPlotValuesInLegend", true},
          {"isSynced", true},          {"xAxisVal", "timestamp"},
          {"sidebarDimension", 160}};
}

ordered_json contact_panel() {
  return {{"topicPath", viz_format::kContactsTopic},
          {"diffEnabled", false},
          {"diffMethod", "custom"},
          {"diffTopicPath", ""},
          {"showFullMessageForDiff", false}};
}

}  // namespace

std::string viewer_layout(std::span<const MappedPerson> people) {
  const ordered_json beside = {
      {"direction", "column"}, {"first", kDutyPanel}, {"second", kContactPanel}, {"splitPercentage", 60}};
  const ordered_json layout = {
      {"configById",
       {{kScenePanel, titled("Body", scene_panel(people))},
        {kDutyPanel, titled("Duties", duty_panel(people))},
        {kContactPanel, titled("Contacts", contact_panel())}}},
      {"globalVariables", ordered_json::object()},
      {"userNodes", ordered_json::object()},
      {"playbackConfig", {{"speed", 1}}},
      {"layout", {{"direction", "row"}, {"first", kScenePanel}, {"second", beside}, {"splitPercentage", 60}}}};
  return layout.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace vestige
