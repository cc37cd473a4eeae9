#include "analysis/mapping/map_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "analysis/mapping/map_raster.hpp"
#include "analysis/mapping/skin_pieces.hpp"
#include "detector/actuators/texture_stretch.hpp"

namespace vestige {

namespace {

/// Share of an actuator's skin. A smaller piece is a speck: from the steps of a border, or from charts that meet within
/// a texel.
constexpr double kSpeck = 0.01;
constexpr double kSpeckTexels = 4;
constexpr double kSpeckOfTriangles = 0.05;  ///< borders step by triangles there
constexpr std::size_t kMostListed = 8;

/// Share of the body's height. A region's middle counts as on one side if it is this far from the body's middle.
constexpr double kBeside = 0.01;

/// Returns 1 for a name with the word "left", -1 for one with "right", otherwise 0.
int side_named(std::string_view name) {
  std::string word;
  int side = 0;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    const auto letter = i < name.size() ? static_cast<unsigned char>(name[i]) : static_cast<unsigned char>(' ');
    if (std::isalpha(letter) != 0) {
      word += static_cast<char>(std::tolower(letter));
      continue;
    }
    side += word == "left" ? 1 : word == "right" ? -1 : 0;
    word.clear();
  }
  return std::clamp(side, -1, 1);
}

struct Piece {
  double area_m2 = 0;
  std::size_t patches = 0;
  glm::dvec3 sum = glm::dvec3(0);
};

class Checker {
 public:
  Checker(const Body& body, const ActuatorMap& map)
      : body_(body), map_(map), far_m_(kFarApart * body.surface().bounds().longest_side()) {
    result_.actuators.resize(map.actuator_count);
    for (std::size_t i = 0; i < map.actuator_count; ++i) result_.actuators[i].name = map.names[i];
    for (const std::uint16_t actuator : map.actuator)
      if (actuator != 0) ++of(actuator).texels;
    patches_ = skin_pieces(body.surface(), map);
  }

  MapCheck check() {
    measure();
    find_absent();
    if (map_.triangle_count == 0) {
      find_unreached();
      find_shared();
      find_soft_edges();
    }
    find_split();
    find_misplaced();
    find_other_facing();
    find_wrong_sides();
    std::ranges::stable_sort(result_.findings, std::ranges::greater(), &MapFinding::severity);
    return std::move(result_);
  }

 private:
  CheckedActuator& of(std::uint16_t actuator) { return result_.actuators[actuator - 1U]; }
  std::string quoted(std::uint16_t actuator) const {
    return fmt::format("{} '{}'", actuator, map_.names[actuator - 1U]);
  }
  void add(Severity severity, const char* kind, std::uint16_t actuator, std::string cause, std::string remedy) {
    result_.findings.push_back({severity, kind, actuator, std::move(cause), std::move(remedy)});
  }

  void measure() {
    for (const SkinPatch& patch : patches_) {
      result_.skin_m2 += double{patch.area_m2};
      if (patch.actuator == 0) continue;
      of(patch.actuator).area_m2 += double{patch.area_m2};
      Piece& piece = pieces_[{patch.actuator, patch.piece}];
      piece.area_m2 += double{patch.area_m2};
      piece.sum += double{patch.area_m2} * glm::dvec3(patch.position_m);
      ++piece.patches;
    }
  }

  void find_absent() {
    if (map_.actuator_count == 0)
      add(Severity::kProblem, "never_fires", 0, "the map is black everywhere, so no actuator can fire",
          "paint regions in grey levels, or make the map with 'vestige map make'");
    const auto is_absent = [&](std::uint16_t actuator) {
      return of(actuator).texels == 0 || (map_.triangle_count != 0 && !(of(actuator).area_m2 > 0));
    };
    for (std::uint16_t region = 1; region <= map_.actuator_count; ++region)
      if (!is_absent(region)) map_.firing.for_each(region - 1U, [&](const Fired& one) { ++fired_[one.actuator + 1]; });
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      if (fired_.contains(actuator)) continue;
      if (is_absent(actuator)) {
        add(Severity::kProblem, "never_fires", actuator,
            fmt::format("actuator {} can never fire: {}", quoted(actuator),
                        of(actuator).texels == 0 ? "the image has no texel of its grey" : "its triangles have no area"),
            "paint its region, or take it out of the sidecar");
      } else {
        add(Severity::kNote, "never_fires", actuator,
            fmt::format("actuator {} never fires: by the sidecar's 'fires', no region that can be touched fires it",
                        quoted(actuator)),
            "if it should vibrate, name it there");
      }
    }
    if (map_.actuator_count > 0 && fired_.empty())
      add(Severity::kProblem, "never_fires", 0, "no actuator can fire", "let a region fire one");
  }

  void find_unreached() {
    std::vector<bool> reached(map_.actuator_count + 1, false);
    const glm::dvec2 size(map_.width, map_.height);
    std::size_t unfit = 0;
    const auto wrap = [](std::int64_t value, std::int64_t side) {
      return static_cast<std::size_t>(((value % side) + side) % side);
    };
    for (std::uint32_t i = 0; i < body_.avatar().triangles.size(); ++i) {
      const auto corners = body_.surface().texels(i, size);
      if (!fits_texture(corners, size)) {
        ++unfit;
        continue;
      }
      for_touched_texels(corners, [&](std::int64_t column, std::int64_t row) {
        reached[map_.actuator[wrap(row, map_.height) * map_.width + wrap(column, map_.width)]] = true;
      });
    }
    if (unfit > 0)
      add(Severity::kProblem, "texture_coordinates", 0,
          fmt::format("{} triangles have texture coordinates that are not finite or cover the texture more than once, "
                      "so each fires many regions",
                      unfit),
          "give each triangle a separate place in the texture, and export the avatar again");
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      const bool is_only_by_itself = map_.firing.is_own(actuator - 1U) && fired_[actuator] == 1;
      if (of(actuator).texels > 0 && !reached[actuator] && unfit == 0 && is_only_by_itself)
        add(Severity::kProblem, "never_fires", actuator,
            fmt::format("actuator {} can never fire: no skin reaches its {} texels", quoted(actuator),
                        of(actuator).texels),
            "paint it where the avatar's texture shows skin; 'vestige avatar FILE --uv uv.png' draws this skin");
    }
  }

  bool is_mirrored(const glm::vec3& a, const glm::vec3& b) const {
    const glm::dvec3 here = body_.turned(a);
    const glm::dvec3 image(2 * body_.middle_x_m() - here.x, here.y, here.z);
    return glm::distance(image, body_.turned(b)) < far_m_;
  }

  /// The first patch of each texel represents it. Patches far from the first share the texel.
  void find_shared() {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> first(map_.actuator.size(), kNone);
    struct Sharing {
      std::size_t texels = 0;
      std::size_t other_pieces = 0;
      std::size_t mirrored = 0;
      float farthest_m = 0;
    };
    std::vector<Sharing> sharing(map_.actuator_count + 1);
    enum : std::uint8_t { kShared = 1, kMirrored = 2 };
    std::vector<std::uint8_t> marks(map_.actuator.size(), 0);
    for (std::uint32_t i = 0; i < patches_.size(); ++i) {
      const SkinPatch& patch = patches_[i];
      if (patch.actuator == 0) continue;
      if (first[patch.texel] == kNone) first[patch.texel] = i;
      const SkinPatch& other = patches_[first[patch.texel]];
      const float apart_m = glm::distance(patch.position_m, other.position_m);
      if (double{apart_m} < far_m_) continue;
      Sharing& shared = sharing[patch.actuator];
      shared.farthest_m = std::max(shared.farthest_m, apart_m);
      std::uint8_t& mark = marks[patch.texel];
      if ((mark & kShared) == 0) {
        ++shared.texels;
        if (patch.piece != other.piece) ++shared.other_pieces;
      }
      mark |= kShared;
      if (is_mirrored(patch.position_m, other.position_m)) {
        if ((mark & kMirrored) == 0) ++shared.mirrored;
        mark |= kMirrored;
      }
    }
    for (const SkinPatch& patch : patches_) {
      if (patch.actuator == 0) continue;
      if ((marks[patch.texel] & kShared) != 0) of(patch.actuator).shared_m2 += double{patch.area_m2};
      if ((marks[patch.texel] & kMirrored) != 0) of(patch.actuator).mirrored_m2 += double{patch.area_m2};
    }
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      const Sharing& shared = sharing[actuator];
      const CheckedActuator& checked = of(actuator);
      if (shared.texels == 0) continue;
      const bool is_speck =
          checked.shared_m2 < kSpeck * checked.area_m2 || static_cast<double>(shared.texels) < kSpeckTexels;
      if (2 * shared.mirrored > shared.texels) {
        const auto& position_m = map_.position_m[actuator - 1U];
        const bool is_central = position_m && std::abs(body_.leftwards_m(*position_m)) < far_m_;
        add(is_speck || is_central ? Severity::kNote : Severity::kProblem, "mirrored_texels", actuator,
            fmt::format("actuator {} fires left and right alike: {} of its {} texels lie on both halves of the body "
                        "({:.0f} cm² of skin)",
                        quoted(actuator), shared.mirrored, checked.texels, checked.mirrored_m2 * 1e4),
            "the avatar's halves share one texture: make the map --per-triangle, or give each half its own place in "
            "the texture; if both are meant to fire, set a position_m in the body's middle");
      } else {
        add(is_speck || shared.other_pieces == 0 ? Severity::kNote : Severity::kProblem, "shared_texels", actuator,
            fmt::format("actuator {}: {} of its {} texels lie on two places of the skin, up to {:.2f} m apart "
                        "({:.0f} cm² of skin)",
                        quoted(actuator), shared.texels, checked.texels, double{shared.farthest_m},
                        checked.shared_m2 * 1e4),
            "make the map --per-triangle, or give each its own place in the texture; 'vestige avatar FILE --uv uv.png' "
            "draws where they overlap");
      }
    }
  }

  void find_split() {
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      CheckedActuator& checked = of(actuator);
      std::vector<Piece> pieces;
      const double speck = map_.triangle_count == 0 ? kSpeck : kSpeckOfTriangles;
      for (auto found = pieces_.lower_bound({actuator, 0}); found != pieces_.end() && found->first.first == actuator;
           ++found)
        // A patch is half a texel.
        if (found->second.area_m2 >= speck * checked.area_m2 &&
            static_cast<double>(found->second.patches) >= 2 * kSpeckTexels)
          pieces.push_back(found->second);
      checked.pieces = pieces.size();
      if (pieces.size() < 2) continue;
      std::ranges::stable_sort(pieces, std::ranges::greater(), &Piece::area_m2);
      std::string places;
      for (std::size_t i = 0; i < std::min(pieces.size(), kMostListed); ++i) {
        const glm::dvec3 middle = pieces[i].sum / pieces[i].area_m2;
        places += fmt::format("{}{:.0f} cm² around ({:.2f}, {:.2f}, {:.2f})", i == 0 ? "" : ", ",
                              pieces[i].area_m2 * 1e4, middle.x, middle.y, middle.z);
      }
      if (pieces.size() > kMostListed) places += ", …";
      add(Severity::kProblem, "split", actuator,
          fmt::format("actuator {} lies in {} pieces on the body: {}", quoted(actuator), pieces.size(), places),
          "remove the stray pieces, or give each piece its own grey: an actuator is felt in one place");
    }
  }

  /// Finds greys without any texel whose four neighbours have the same grey.
  void find_soft_edges() {
    std::vector<bool> is_solid(map_.actuator_count + 1, false);
    for (std::uint32_t row = 0; row < map_.height; ++row)
      for (std::uint32_t column = 0; column < map_.width; ++column) {
        const auto at = [&](std::uint32_t x, std::uint32_t y) {
          return map_.actuator[std::size_t{y} * map_.width + x];
        };
        const std::uint16_t here = at(column, row);
        const bool same =
            (column == 0 || at(column - 1, row) == here) && (column + 1 == map_.width || at(column + 1, row) == here) &&
            (row == 0 || at(column, row - 1) == here) && (row + 1 == map_.height || at(column, row + 1) == here);
        if (same) is_solid[here] = true;
      }
    std::size_t soft = 0;
    std::size_t texels = 0;
    std::uint16_t one = 0;
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      if (is_solid[actuator] || of(actuator).texels == 0) continue;
      ++soft;
      one = actuator;
      texels += of(actuator).texels;
    }
    // A map as coarse as a chessboard has no soft edges.
    if (soft == 0 || (soft == map_.actuator_count && map_.width * map_.height < 64 * 64)) return;
    add(Severity::kProblem, "soft_edges", soft == 1 ? one : std::uint16_t{0},
        fmt::format("{} of {} grey levels are at most two texels wide everywhere ({} texels): soft edges of an editor, "
                    "each a separate actuator",
                    soft, map_.actuator_count, texels),
        "draw with a hard brush (GIMP: the pencil; no anti-aliasing, no scaling with interpolation)");
  }

  void find_misplaced() {
    std::vector<double> nearest_m(map_.actuator_count + 1, std::numeric_limits<double>::infinity());
    for (const SkinPatch& patch : patches_) {
      if (patch.actuator == 0 || !map_.position_m[patch.actuator - 1U]) continue;
      const double away_m = glm::distance(glm::dvec3(patch.position_m), *map_.position_m[patch.actuator - 1U]);
      nearest_m[patch.actuator] = std::min(nearest_m[patch.actuator], away_m);
    }
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator)
      if (std::isfinite(nearest_m[actuator]) && nearest_m[actuator] > far_m_)
        add(Severity::kProblem, "position", actuator,
            fmt::format("actuator {}: its position_m is {:.2f} m away from the nearest skin that fires it",
                        quoted(actuator), nearest_m[actuator]),
            "use the map of this avatar; positions are metres in the avatar's rest pose");
  }

  void find_other_facing() {
    const Facing faces = body_.avatar().facing.axis;
    if (!map_.facing || *map_.facing == faces) return;
    add(Severity::kProblem, "facing", 0,
        fmt::format("the map was made for an avatar that faces {}, and this one faces {}", to_string(*map_.facing),
                    to_string(faces)),
        "make the map anew for this avatar, or set --facing");
  }

  /// The joints' names tell the sides, not the facing, which may be wrong.
  void find_wrong_sides() {
    const auto& left = body_.avatar().facing.left;
    if (!left) return;
    std::vector<glm::dvec3> sum(map_.actuator_count + 1, glm::dvec3(0));
    for (const auto& [key, piece] : pieces_) sum[key.first] += piece.sum;
    const double middle_m = body_.middle_m(*left);
    for (std::uint16_t actuator = 1; actuator <= map_.actuator_count; ++actuator) {
      const int side = side_named(map_.names[actuator - 1U]);
      const double area_m2 = of(actuator).area_m2;
      if (side == 0 || !(area_m2 > 0)) continue;
      const double beside_m = glm::dot(sum[actuator] / area_m2, *left) - middle_m;
      if (side * beside_m > -kBeside * body_.surface().height_m()) continue;
      const char* where = beside_m > 0 ? "left" : "right";
      add(Severity::kProblem, "wrong_side", actuator,
          fmt::format("actuator {} lies {:.2f} m to the {} of the body's middle, on the side of the joints named {}",
                      quoted(actuator), std::abs(beside_m), where, where),
          fmt::format("make the map anew with --facing {}, or rename its regions",
                      to_string(nearest_facing(forward_from_left(*left)))));
    }
  }

  const Body& body_;
  const ActuatorMap& map_;
  double far_m_;
  std::vector<SkinPatch> patches_;
  std::map<std::pair<std::uint16_t, std::uint32_t>, Piece> pieces_;
  std::map<std::uint32_t, std::size_t> fired_;  ///< for each actuator: how many regions with texels fire it
  MapCheck result_;
};

}  // namespace

bool MapCheck::good() const {
  return std::ranges::none_of(findings, [](const MapFinding& f) { return f.severity == Severity::kProblem; });
}

MapCheck check_map(const Body& body, const ActuatorMap& map, std::string_view avatar_name) {
  if (map.triangle_count == 0) require_texture_coordinates(body.avatar(), avatar_name);
  return Checker(body, map).check();
}

}  // namespace vestige
