#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/studio/body_sides.hpp"
#include "analysis/plot/studio/studio.hpp"
#include "analysis/plot/studio/surface.hpp"
#include "detector/actuator_map.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::plot {

/// Pictures of many maps on one body, from two sides each. They are comparable: they share one light and one scale for
/// numbers of contacts. The body is lit only once.
class MapPictures {
 public:
  /// `contacts` are those of all traces, on the avatar's triangles.
  MapPictures(const Avatar& avatar, std::vector<RecordedContact> contacts);
  ~MapPictures();
  MapPictures(const MapPictures&) = delete;
  MapPictures& operator=(const MapPictures&) = delete;

  std::size_t contact_count() const { return contacts_.size(); }

  /// Draws the regions of a map, with their numbers.
  std::unique_ptr<Figure> regions(const ActuatorMap& map) const;
  /// Draws the density of contacts, with the outlines of the regions.
  std::unique_ptr<Figure> contacts(const ActuatorMap& map) const;
  /// Draws the density of the contacts that are not felt.
  std::unique_ptr<Figure> unfelt(const ActuatorMap& map) const;

 private:
  std::vector<RecordedContact> unfelt_contacts(const ActuatorMap& map) const;
  std::unique_ptr<Figure> heat(const ActuatorMap& map, const std::vector<RecordedContact>& contacts,
                               std::string description) const;

  const Avatar& avatar_;
  std::vector<RecordedContact> contacts_;
  Surface surface_;
  double extent_m_;
  std::array<BodySide, 2> sides_;
  double cell_width_pt_ = 0;
  double cell_height_pt_ = 0;
  double m_per_pt_ = 1;
  double bar_high_ = 1;
  std::vector<StudioShot> shots_;  ///< one for each side
};

}  // namespace vestige::plot
