// Pictures of avatars: runs vestige-plot as a user does and looks at the pixels.

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/analysis/box_avatar.hpp"
#include "tests/support/process.hpp"

namespace vestige {
namespace {

using test::Picture;
using test::Pixel;
using test::read_png;
using test::words_of;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::Not;

bool is_blue(Pixel pixel) {
  return pixel.blue > pixel.red + 60 && pixel.blue > pixel.green + 20;
}
bool is_orange(Pixel pixel) {
  return pixel.red > pixel.blue + 60 && pixel.green > pixel.blue + 30;
}
bool is_green(Pixel pixel) {
  return pixel.green > pixel.red + 40 && pixel.green > pixel.blue + 10;
}
/// The upper end of the colours for density.
bool is_hot(Pixel pixel) {
  return pixel.red > pixel.green + 50 && pixel.green < 80;
}

/// Where one picture of the box lies on the page, in dots.
struct Extent {
  std::size_t left = 0;
  std::size_t right = 0;
  std::size_t top = 0;
  std::size_t bottom = 0;
};

/// The drawn boxes from left to right: what is not white at 80 % of the page's height, where no words and numbers are.
std::vector<Extent> boxes(const Picture& picture) {
  const auto is_white = [&](std::size_t column, std::size_t row) {
    return picture.pixels[row * picture.width + column] == test::kWhite;
  };
  const std::size_t row = picture.height * 8 / 10;
  std::vector<Extent> found;
  for (std::size_t column = 1; column < picture.width; ++column) {
    if (is_white(column, row)) continue;
    if (is_white(column - 1, row)) found.push_back({column, column, row, row});
    found.back().right = column + 1;
  }
  for (Extent& box : found) {
    const std::size_t aside = box.left + (box.right - box.left) / 8;  // of numbers and words
    while (!is_white(aside, box.top - 1)) --box.top;
    while (!is_white(aside, box.bottom)) ++box.bottom;
  }
  return found;
}

struct Spot {
  std::size_t count = 0;
  double across = 0;  ///< of the middle: 0 left, 1 right
  double down = 0;    ///< 0 top, 1 bottom
};

template <typename Predicate>
Spot spot(const Picture& picture, const Extent& box, const Predicate& predicate) {
  Spot result;
  for (std::size_t row = box.top; row < box.bottom; ++row)
    for (std::size_t column = box.left; column < box.right; ++column) {
      if (!predicate(picture.pixels[row * picture.width + column])) continue;
      ++result.count;
      result.across += static_cast<double>(column - box.left) / static_cast<double>(box.right - box.left);
      result.down += static_cast<double>(row - box.top) / static_cast<double>(box.bottom - box.top);
    }
  result.across /= static_cast<double>(std::max<std::size_t>(result.count, 1));
  result.down /= static_cast<double>(std::max<std::size_t>(result.count, 1));
  return result;
}

std::size_t area(const Extent& box) {
  return (box.right - box.left) * (box.bottom - box.top);
}

class PlotBodyTest : public test::PlotTest {
 protected:
  PlotBodyTest() {
    test::write_box(folder_.path());
    test::write_box_map(folder_.path());
  }

  /// box.mcap and contacts.csv, with one collider that flies along z, at the x and y of its only contact.
  void record(const std::string& arguments,
              const std::string& places = "0,7,0.1,0.75,0.6\n1,7,0.1,0.75,-0.05\n") const {
    write_text(folder_ / "through.csv", "time_s,id,x,y,z\n" + places);
    const test::Outcome outcome = test::run(
        "vestige record --avatar box.gltf --colliders through.csv --rate 10 --duration 1 -o box.mcap -q " + arguments,
        folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    ASSERT_EQ(test::run("vestige replay box.mcap --contacts contacts.csv -q", folder_.path()).exit_code, 0);
  }
};

TEST_F(PlotBodyTest, RegionsAreSeenFromTheSideThatTheyAreOn) {
  const test::Outcome outcome = run("body --avatar box.gltf --map box.png -o out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const Picture picture = read_png(folder_ / "out.png");
  const std::vector<Extent> found = boxes(picture);
  ASSERT_EQ(found.size(), 2U) << "front and back";
  const Spot chest = spot(picture, found[0], is_blue);
  const Spot belly = spot(picture, found[0], is_orange);
  EXPECT_GT(chest.count, area(found[0]) * 45 / 100);
  EXPECT_GT(belly.count, area(found[0]) * 45 / 100);
  EXPECT_NEAR(chest.down, 0.25, 0.02) << "the map's first row is v = 0";
  EXPECT_NEAR(belly.down, 0.75, 0.02);
  EXPECT_EQ(spot(picture, found[0], is_green).count, 0U);
  EXPECT_GT(spot(picture, found[1], is_green).count, area(found[1]) * 95 / 100);
  EXPECT_EQ(spot(picture, found[1], is_blue).count + spot(picture, found[1], is_orange).count, 0U);
  for (const char* expected : {"box.gltf", "3 regions", "chest", "belly", "spine", "no actuator", "front", "back"})
    EXPECT_THAT(words_of(folder_ / "out.svg"), HasSubstr(expected));
}

TEST_F(PlotBodyTest, ContactsAreDrawnAndHeatTheSkinWhereTheyAre) {
  record("--animation none --map box.png");
  const test::Outcome outcome = run("body box.mcap --contacts contacts.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const Picture picture = read_png(folder_ / "box-body.png");
  const std::vector<Extent> found = boxes(picture);
  ASSERT_EQ(found.size(), 4U) << "map and density, front and back";
  const Spot hot = spot(picture, found[2], is_hot);
  EXPECT_GT(hot.count, 50U);
  EXPECT_NEAR(hot.across, 0.75, 0.02);
  EXPECT_NEAR(hot.down, 0.25, 0.02);
  EXPECT_EQ(spot(picture, found[3], is_hot).count, 0U);
  const Spot mark = spot(picture, found[0], [](Pixel pixel) { return pixel == Pixel{0, 0, 0}; });
  EXPECT_GT(mark.count, 10U);
  const std::string words = words_of(folder_ / "box-body.svg");
  for (const char* expected : {"chest: 1 contact", "belly: 0 contacts", "with 1 contact", "per dm²"})
    EXPECT_THAT(words, HasSubstr(expected));
}

TEST_F(PlotBodyTest, ContactsOfAMovingAvatarAreDrawnAtTheSkinThatTheyTouched) {
  // In the frame at 0.5 s the box has turned by 45 degrees, and the collider, at x = 0.05, meets its front where that
  // is 0.05 √2 - 0.1 to the left of its middle.
  record("--map box.png", "0,7,0.05,0.75,0.6\n0.4,7,0.05,0.75,0.6\n0.5,7,0.05,0.75,-0.6\n");
  ASSERT_EQ(run("body box.mcap --contacts contacts.csv").exit_code, 0);
  const Picture picture = read_png(folder_ / "box-body.png");
  const std::vector<Extent> found = boxes(picture);
  ASSERT_EQ(found.size(), 4U);
  const Spot hot = spot(picture, found[2], is_hot);
  EXPECT_GT(hot.count, 50U);
  EXPECT_NEAR(hot.across, (0.2 + 0.0707 - 0.1) / 0.4, 0.02);
  EXPECT_NEAR(hot.down, 0.25, 0.02);
}

TEST_F(PlotBodyTest, ContactsWithoutAMapAreDrawnAndNothingToDrawIsRefused) {
  record("--animation none --map none");
  EXPECT_EQ(run("body box.mcap --contacts contacts.csv").exit_code, 0);
  EXPECT_THAT(words_of(folder_ / "box-body.svg"), HasSubstr("No actuator map, with 1 contact"));
  const test::Outcome refused = run("body box.mcap --force");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, HasSubstr("box.mcap: there is no actuator map"));
}

TEST_F(PlotBodyTest, ContactsOfAnotherTraceAreRefusedNamingTheirLine) {
  record("--animation none --map box.png");
  const std::string header = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z\n";
  struct Case {
    const char* row;
    const char* cause;
  };
  for (const Case& wrong : {Case{"1,0.1,0,12,0,0,0,0,0,1,1,0,0,0", "line 3: refers to triangle 12"},
                            Case{"1,0.1,0,11,0,0,0,0,0,4,1,0,0,0", "line 3: refers to actuator 4"},
                            Case{"1,0.1,0,x,0,0,0,0,0,1,1,0,0,0", "line 3: is not a row of contacts"},
                            Case{"1,0.1,0,11,0,0,0,0,0,1,0,x,junk", "line 3: is not a row of contacts"},
                            Case{"1,0.1,0,11,0,0,0,0,0,1,1,0,0,0,0", "line 3: is not a row of contacts"},
                            Case{"1,0.1,0,11,0,nan,0,0,0,1,1,0,0,0", "line 3: u and v must be weights"},
                            Case{"1,0.1,0,11,0,0,1e300,0,0,1,1,0,0,0", "line 3: u and v must be weights"}}) {
    write_text(folder_ / "other.csv", header + "1,0.1,0,11,0,0,0,0,0,3,1,0,0,0\n" + wrong.row + "\n");
    const test::Outcome outcome = run("body box.mcap --contacts other.csv");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.standard_error, HasSubstr(fmt::format("other.csv, {}", wrong.cause)));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "box-body.svg"));
  }
}

TEST_F(PlotBodyTest, WithAnotherMapContactsAreCountedInTheRegionsThatAreDrawn) {
  record("--animation none --map box.png");
  // The greys the other way round: the chest, actuator 1 in the trace, is this map's third.
  ASSERT_EQ(test::run("cp box.png other.png", folder_.path()).exit_code, 0);
  write_text(folder_ / "other.json", R"({"actuators": [{"grey": 30, "name": "spine"}, {"grey": 20, "name": "belly"},
    {"grey": 10, "name": "chest"}]})");
  ASSERT_EQ(run("body box.mcap --map other.png --contacts contacts.csv").exit_code, 0);
  const std::string words = words_of(folder_ / "box-body.svg");
  for (const char* expected : {"chest: 1 contact", "belly: 0 contacts", "spine: 0 contacts"})
    EXPECT_THAT(words, HasSubstr(expected));
}

TEST_F(PlotBodyTest, ATraceThatWasCutOffIsDrawnAndExitsWith3) {
  record("--animation none --map box.png");
  const std::string whole = read_text_file(folder_ / "box.mcap");
  write_text(folder_ / "cut.mcap", std::string_view(whole).substr(0, whole.size() - 300));
  const test::Outcome outcome = run("body cut.mcap");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("warning: cut.mcap"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cut-body.png"));
  const test::Outcome quiet = run("body cut.mcap -q --force");
  EXPECT_EQ(quiet.exit_code, 3);
  EXPECT_EQ(quiet.standard_error, "");
}

TEST_F(PlotBodyTest, FortyRegionsAreAllNumberedAndNamed) {
  std::vector<std::uint8_t> grey(40);
  std::string json;
  for (std::size_t i = 0; i < grey.size(); ++i) {
    grey[i] = static_cast<std::uint8_t>(i + 1);
    json += fmt::format(R"({}{{"grey": {}, "name": "pad no. {}"}})", i == 0 ? "" : ", ", i + 1, i + 1);
  }
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = 4;
  image.height = 10;
  image.format = PNG_FORMAT_GRAY;
  ASSERT_NE(png_image_write_to_file(&image, (folder_ / "forty.png").c_str(), 0, grey.data(), 0, nullptr), 0);
  write_text(folder_ / "forty.json", R"({"actuators": [)" + json + "]}");
  ASSERT_EQ(run("body --avatar box.gltf --map forty.png -o out").exit_code, 0);
  const std::string words = words_of(folder_ / "out.svg");
  for (int i = 1; i <= 40; ++i) EXPECT_THAT(words, HasSubstr(fmt::format("pad no. {}", i)));
}

TEST_F(PlotBodyTest, AContactSheetShowsEveryPoseFromFourSides) {
  const test::Outcome outcome = run("avatar box.gltf --poses 4 -o sheet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "sheet.svg");
  for (const char* expected : {"box.gltf: 12 triangles", "turn, 1 s", "front", "half-left", "left", "back", "0.00 s",
                               "0.25 s", "0.75 s", "0.5 m"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_THAT(words, Not(HasSubstr("1.00 s"))) << "a loop's end is its beginning";
}

TEST_F(PlotBodyTest, ARestPoseIsWideFromTheFrontAndNarrowFromTheLeft) {
  ASSERT_EQ(run("avatar box.gltf --animation none -o rest").exit_code, 0);
  const Picture picture = read_png(folder_ / "rest.png");
  const std::size_t row = picture.height / 2;
  // The widest run of body in each quarter of the page.
  std::vector<std::size_t> widths;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    std::size_t width = 0;
    for (std::size_t column = quarter * 510 + 60; column < quarter * 510 + 560; ++column)
      if (picture.pixels[row * picture.width + column].red < 235) ++width;
    widths.push_back(width);
  }
  EXPECT_NEAR(static_cast<double>(widths[2]) / static_cast<double>(widths[0]), 0.5, 0.05);
  EXPECT_NEAR(static_cast<double>(widths[3]) / static_cast<double>(widths[0]), 1, 0.05);
  EXPECT_GT(widths[1], widths[0]);
}

TEST_F(PlotBodyTest, AnAnimationThatIsNotThereIsRefusedNamingThoseThatAre) {
  const test::Outcome outcome = run("avatar box.gltf --animation walk");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.standard_error, HasSubstr("0 (turn)"));
}

TEST_F(PlotBodyTest, WrongInputIsRefused) {
  write_text(folder_ / "note.mcap", "no trace");
  EXPECT_EQ(run("body note.mcap").exit_code, 1);
  EXPECT_THAT(run("body note.mcap").standard_error, HasSubstr("note.mcap"));
  EXPECT_THAT(run("body none.mcap").standard_error, HasSubstr("none.mcap"));
  EXPECT_EQ(run("body").exit_code, 2);
  EXPECT_EQ(run("body note.mcap --avatar builtin").exit_code, 2);
  EXPECT_EQ(run("avatar none.glb").exit_code, 1);
  EXPECT_EQ(run("avatar box.gltf --poses 0").exit_code, 2);
}

}  // namespace
}  // namespace vestige
