#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/body.hpp"
#include "analysis/mapping/region_file.hpp"

namespace vestige {

/// Regions on one avatar: maps each point of the skin to an actuator.
class RegionPlan {
 public:
  /// `body` must outlive this object. `name` appears in errors. Throws `UnknownName` if the avatar does not have a part
  /// or joint. Throws `Error` if a region asks for two opposite sides, if its list has two actuators of one name, if
  /// its criteria leave no skin for the list, or if there are more than 65534 actuators. A region that selects no skin
  /// is not an error: its actuators have no skin. Throws `Error` if the avatar does not stand
  /// (`AvatarFacing::lies_deg`) and a region has a grid, a height, an angle, a side, the vest, or a left or right part.
  RegionPlan(const Body& body, const std::vector<RegionSpec>& regions, std::string_view name);

  /// Returns the actuator's number, 1 … actuator_count, or 0 if the point belongs to no actuator.
  std::uint16_t at(const SkinPoint& point) const;
  std::size_t actuator_count() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  /// Returns the position that an actuator of a region's list has on the skin. Other actuators have none.
  const std::optional<glm::dvec3>& given_position_m(std::size_t actuator) const { return given_position_m_[actuator]; }

 private:
  enum class Half { kBoth, kLeft, kRight };
  struct PartChoice {
    SkinPart part = SkinPart::kTorso;
    bool vest = false;
    Half half = Half::kBoth;
  };

  /// The frame that "height" and "angle" of a selection refer to. Its axis follows the middle between front and back.
  /// Places are those of `Body::turned`.
  struct Frame {
    double low_m = 0;
    double high_m = 1;
    double middle_x_m = 0;
    std::vector<double> middle_z_m;  ///< from low to high, at equally spaced heights

    double height(double y_m) const { return (y_m - low_m) / (high_m - low_m); }
    double angle_degrees(const glm::dvec3& position_m) const;
    double middle_z_at(double y_m) const;
  };

  struct Site {
    glm::dvec3 position_m;
    std::vector<double> detour_m;  ///< for each vertex: distance along the surface minus the straight-line distance
  };

  struct Region {
    std::vector<PartChoice> parts;
    std::vector<bool> nodes;  ///< whether the region has each node; empty: any node
    Frame frame;
    std::optional<Extent> height_m;
    std::vector<Extent> angles;  ///< all of these must hold
    Extent rows_m;
    Extent columns;
    std::size_t row_count = 1;
    std::size_t column_count = 1;
    std::vector<Site> sites;
    double radius_m = 0;
    std::vector<std::uint16_t> actuators;  ///< numbers from 1, by row and column, or by site
  };

  /// A point of the skin, with the values that every region looks at.
  struct Asked {
    SkinPoint point;
    glm::dvec3 position_m;  ///< as if the avatar faced +z (`Body::turned`)
    SkinPart part;
  };
  Asked ask(const SkinPoint& point) const;

  void choose_skin(const RegionSpec& spec, const std::string& where, Region& region) const;
  PartChoice part_choice(const std::string& text, const std::string& where) const;
  bool selects(const Region& region, const Asked& asked) const;
  bool holds(const Region& region, const Asked& asked) const;
  /// Returns false if the region selects no skin.
  bool fit_frame(Region& region) const;
  void place_sites(const RegionSpec& spec, const std::string& where, Region& region) const;
  void number_actuators(const RegionSpec& spec, const std::string& where, Region& region);
  std::uint16_t number_of(const std::string& actuator_name);
  std::uint16_t actuator_within(const Region& region, const Asked& asked) const;
  template <typename Visit>
  void for_each_sample(const Visit& visit) const;

  const Body& body_;
  double step_;  ///< of the samples, see affordable_step
  std::vector<Region> regions_;
  std::vector<std::string> names_;
  std::vector<std::optional<glm::dvec3>> given_position_m_;
};

}  // namespace vestige
