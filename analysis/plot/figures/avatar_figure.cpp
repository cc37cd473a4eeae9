#include "analysis/plot/figures/avatar_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/scale_bar.hpp"
#include "analysis/plot/studio/studio.hpp"
#include "traces/base/number_text.hpp"
#include "traces/motion/animation_choice.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 510;
constexpr double kLabelRoomPt = 12;
constexpr double kTitleRoomPt = 24;
constexpr double kBlockTitlePt = 14;
constexpr double kTimeRoomPt = 12;
constexpr double kFootPt = 20;
constexpr double kMostCellHeightPt = 150;
constexpr double kRestCellHeightPt = 240;
constexpr double kElevationDegrees = 6;
constexpr Colour kSkin = {196, 190, 184};

struct Side {
  const char* name;
  double azimuth_degrees;
};
constexpr std::array<Side, 4> kSides = {{{"front", 0}, {"half-left", 42}, {"left", 90}, {"back", 180}}};

std::string name_of(const Avatar& avatar, const Animation& animation) {
  if (!animation.name.empty()) return animation.name;
  return fmt::format("animation {}", &animation - avatar.animations.data());
}

struct Shown {
  double time_s = 0;
  Surface surface;
  std::vector<Raster> pictures;  ///< one for each side
};

struct Block {
  std::string title;
  std::vector<Shown> poses;
  double ground_y = 0;
};

class AvatarFigure : public Figure {
 public:
  explicit AvatarFigure(const ContactSheet& sheet)
      : title_(fmt::format("{}: {} triangles, {} vertices, {}", sheet.subject.title,
                           grouped(static_cast<double>(sheet.subject.avatar.triangles.size())),
                           grouped(static_cast<double>(sheet.subject.avatar.position_bind.size())),
                           counted(sheet.subject.avatar.joint_count, "joint"))) {
    const SurfacePoser poser(sheet.subject.avatar);
    for (const Animation* animation : sheet.animations) blocks_.push_back(block_of(sheet, poser, animation));
    lay_out();
    for (Block& block : blocks_)
      for (Shown& shown : block.poses)
        for (const Side& side : kSides) shown.pictures.push_back(picture(shown.surface, block.ground_y, side));
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kTitleRoomPt + kFootPt + static_cast<double>(blocks_.size()) * block_height_pt();
  }
  std::string description() const override { return fmt::format("{}, posed and seen from four sides.", title_); }

  void draw(Canvas& canvas) const override {
    canvas.text({kLabelRoomPt, height_pt() - 10}, title_, {9, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold});
    double top_pt = height_pt() - kTitleRoomPt;
    for (const Block& block : blocks_) {
      draw_block(canvas, block, top_pt);
      top_pt -= block_height_pt();
    }
    draw_scale_bar(canvas, {kLabelRoomPt, 8}, unit_per_pt_, 90);
  }

 private:
  static Block block_of(const ContactSheet& sheet, const SurfacePoser& poser, const Animation* animation) {
    Block block;
    block.title = "rest pose";
    const std::size_t count = animation == nullptr ? 1 : sheet.poses;
    if (animation != nullptr)
      block.title = fmt::format("{}, {:.3g} s", name_of(sheet.subject.avatar, *animation), animation->duration_s);
    for (std::size_t i = 0; i < count; ++i) {
      Shown shown;
      // The end of a loop is its beginning: leave it out.
      if (animation != nullptr)
        shown.time_s = animation->duration_s * static_cast<double>(i) / static_cast<double>(count);
      const Pose pose = animation == nullptr ? rest_pose(sheet.subject.avatar)
                                             : sample_animation(sheet.subject.avatar, *animation, shown.time_s);
      shown.surface = poser.pose(pose, pose.origin_m);
      block.ground_y = i == 0 ? shown.surface.low.y : std::min(block.ground_y, shown.surface.low.y);
      block.poses.push_back(std::move(shown));
    }
    return block;
  }

  bool only_rest() const { return blocks_.size() == 1 && blocks_.front().poses.size() == 1; }
  std::size_t columns() const { return only_rest() ? kSides.size() : blocks_.front().poses.size(); }
  std::size_t rows() const { return only_rest() ? 1 : kSides.size(); }

  /// One scale at which every pose fits into its cell from every side.
  void lay_out() {
    double width = 0;
    double height = 0;
    for (const Block& block : blocks_) {
      for (const Shown& shown : block.poses) {
        const glm::dvec3 size = shown.surface.high - shown.surface.low;
        for (const Side& side : kSides) {
          const Camera camera = Camera::from(side.azimuth_degrees, kElevationDegrees, shown.surface.facing);
          width = std::max(width, std::abs(camera.right.x) * size.x + std::abs(camera.right.z) * size.z);
          // The feet rest on the ground, which is seen a little from above.
          height = std::max(height, (shown.surface.high.y - block.ground_y) * camera.up.y +
                                        std::abs(camera.up.x) * size.x + std::abs(camera.up.z) * size.z);
        }
      }
    }
    width *= 1.06;
    height *= 1.08;
    if (!(width > 0)) width = 1;
    if (!(height > 0)) height = 1;
    cell_width_pt_ =
        whole_dots_pt((kWidthPt - kLabelRoomPt) / static_cast<double>(std::max<std::size_t>(columns(), 3)));
    const double most_pt = only_rest() ? kRestCellHeightPt : kMostCellHeightPt;
    unit_per_pt_ = std::max(width / cell_width_pt_, height / most_pt);
    cell_height_pt_ = whole_dots_pt(height / unit_per_pt_ + 5.9);
  }

  double block_height_pt() const { return kBlockTitlePt + static_cast<double>(rows()) * cell_height_pt_ + kTimeRoomPt; }

  void draw_block(Canvas& canvas, const Block& block, double top_pt) const {
    canvas.text({kLabelRoomPt, top_pt - kBlockTitlePt / 2}, block.title, {8, kInk});
    const double cells_top_pt = top_pt - kBlockTitlePt;
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      for (std::size_t i = 0; i < block.poses.size(); ++i) {
        const std::size_t column = only_rest() ? side : i;
        const std::size_t row = only_rest() ? 0 : side;
        const double left_pt = kLabelRoomPt + static_cast<double>(column) * cell_width_pt_;
        const double cell_top_pt = cells_top_pt - static_cast<double>(row) * cell_height_pt_;
        const Box cell = {left_pt, cell_top_pt - cell_height_pt_, left_pt + cell_width_pt_, cell_top_pt};
        canvas.image(cell, block.poses[i].pictures[side]);
        const Place below = {(cell.left_pt + cell.right_pt) / 2, cell.bottom_pt - 6};
        if (only_rest())
          canvas.text(below, kSides[side].name, {7, kInk, Anchor::kCentre});
        else if (side + 1 == kSides.size())
          canvas.text(below, fmt::format("{:.2f} s", block.poses[i].time_s), {7, kInk, Anchor::kCentre});
      }
      if (!only_rest()) {
        TextStyle style = {7, kInk, Anchor::kCentre};
        style.turned_degrees = 90;
        canvas.text({5, cells_top_pt - (static_cast<double>(side) + 0.5) * cell_height_pt_}, kSides[side].name, style);
      }
    }
  }

  Raster picture(const Surface& surface, double ground_y, const Side& side) const {
    View view = view_of_cell(Camera::from(side.azimuth_degrees, kElevationDegrees, surface.facing), cell_width_pt_,
                             cell_height_pt_, unit_per_pt_);
    // Every pose stands in the middle of its cell, whatever ground the animation covers.
    glm::dvec3 stand = (surface.low + surface.high) / 2.0;
    stand.y = ground_y;
    const glm::dvec3 seen = view.camera.seen(stand);
    view.left = seen.x - static_cast<double>(view.width) / 2 * view.unit_per_dot;
    const glm::dvec3 size = surface.high - surface.low;
    const double nearest = (std::abs(view.camera.up.x) * size.x + std::abs(view.camera.up.z) * size.z) / 2;
    view.bottom = seen.y - nearest - 0.02 * surface.height();
    const StudioShot shot(surface, view, ground_y);
    return shot.picture([](std::uint32_t, double, double) { return kSkin; });
  }

  std::string title_;
  std::vector<Block> blocks_;
  double cell_width_pt_ = 0;
  double cell_height_pt_ = 0;
  double unit_per_pt_ = 1;
};

}  // namespace

std::vector<const Animation*> ContactSheet::choose(const Avatar& avatar, const std::string& animation) {
  if (!animation.empty() || avatar.animations.empty()) return {find_animation(avatar, animation)};
  std::vector<const Animation*> all;
  all.reserve(avatar.animations.size());
  for (const Animation& each : avatar.animations) all.push_back(&each);
  return all;
}

std::unique_ptr<Figure> avatar_figure(const ContactSheet& sheet) {
  return std::make_unique<AvatarFigure>(sheet);
}

}  // namespace vestige::plot
