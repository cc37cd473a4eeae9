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

/// Regions as they lie on one avatar: which actuator any point of its skin belongs to.
class RegionPlan {
 public:
  /// `body` must stay. `name` stands in errors: a part or joint that the avatar does not have (`UnknownName`), two
  /// actuators of one name in a region's list. A region that selects no skin is no error: its actuators are nowhere.
  RegionPlan(const Body& body, const std::vector<RegionSpec>& regions, std::string_view name);

  /// 1 … actuator_count, or 0 for none.
  std::uint16_t at(const SkinPoint& point) const;
  std::size_t actuator_count() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  /// Where an actuator was asked to be, if it was.
  const std::optional<glm::dvec3>& given_position_m(std::size_t actuator) const { return given_position_m_[actuator]; }

 private:
  enum class Half { kBoth, kLeft, kRight };
  struct PartChoice {
    SkinPart part = SkinPart::kTorso;
    bool vest = false;
    Half half = Half::kBoth;
  };

  /// Where "height" and "angle" of a selection are counted from. The axis follows the middle between front and back.
  struct Frame {
    double low_m = 0;
    double high_m = 1;
    double middle_x_m = 0;
    std::vector<double> middle_z_m;  ///< from low to high, at even heights

    double height(double y_m) const { return (y_m - low_m) / (high_m - low_m); }
    double angle_degrees(const glm::dvec3& position_m) const;
    double middle_z_at(double y_m) const;
  };

  struct Site {
    glm::dvec3 position_m;
    std::vector<double> detour_m;  ///< of every vertex: distance along the surface, less the straight line
  };

  struct Region {
    std::vector<PartChoice> parts;
    std::vector<bool> nodes;  ///< by node; empty: any
    Frame frame;
    std::optional<Extent> height_m;
    std::vector<Extent> angles;  ///< each of these
    Extent rows_m;
    Extent columns;
    std::size_t row_count = 1;
    std::size_t column_count = 1;
    std::vector<Site> sites;
    double radius_m = 0;
    std::vector<std::uint16_t> actuators;  ///< numbers from 1, by row and column, or by site
  };

  /// A point of the skin with what every region asks of it.
  struct Asked {
    SkinPoint point;
    glm::dvec3 position_m;
    SkinPart part;
  };
  Asked ask(const SkinPoint& point) const;

  void choose_skin(const RegionSpec& spec, const std::string& where, Region& region) const;
  PartChoice part_choice(const std::string& text, const std::string& where) const;
  bool selects(const Region& region, const Asked& asked) const;
  bool holds(const Region& region, const Asked& asked) const;
  /// False: the region selects no skin at all.
  bool fit_frame(Region& region) const;
  void place_sites(const RegionSpec& spec, const std::string& where, Region& region) const;
  void number_actuators(const RegionSpec& spec, const std::string& where, Region& region);
  std::uint16_t number_of(const std::string& actuator_name);
  std::uint16_t actuator_within(const Region& region, const Asked& asked) const;
  template <typename Visit>
  void for_each_sample(const Visit& visit) const;

  const Body& body_;
  std::vector<Region> regions_;
  std::vector<std::string> names_;
  std::vector<std::optional<glm::dvec3>> given_position_m_;
};

}  // namespace vestige
