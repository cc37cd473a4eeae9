// Film strips of traces: runs vestige-plot as a user does and looks at the pixels.

#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <utility>

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

/// How many dots of two panels in a row of four differ.
std::size_t difference(const Picture& picture, std::size_t panel, std::size_t other) {
  constexpr std::size_t kPanelDots = 525;
  constexpr std::size_t kInsetDots = 20;
  std::size_t result = 0;
  for (std::size_t row = picture.height / 4; row < picture.height * 3 / 4; ++row)
    for (std::size_t column = kInsetDots; column + kInsetDots < kPanelDots; ++column)
      if (picture.pixels[row * picture.width + panel * kPanelDots + column] !=
          picture.pixels[row * picture.width + other * kPanelDots + column])
        ++result;
  return result;
}

class PlotSceneTest : public test::PlotTest {
 protected:
  PlotSceneTest() {
    test::write_box(folder_.path());
    test::write_box_map(folder_.path());
  }

  void record(const std::string& arguments) const {
    const test::Outcome outcome =
        test::run("vestige record --avatar box.gltf --map box.png -o box.mcap -q " + arguments, folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }

  /// A film strip of one frame with one resting collider.
  Picture picture_with_collider_at(double x, double y, double z) const {
    write_text(folder_ / "one.csv", fmt::format("time_s,id,x,y,z\n0,1,{0},{1},{2}\n1,1,{0},{1},{2}\n", x, y, z));
    record("--animation none --colliders one.csv --rate 10 --duration 1 --force");
    EXPECT_EQ(run("scene box.mcap --frames 1 --map none --force").exit_code, 0);
    return read_png(folder_ / "box-scene.png");
  }
};

TEST_F(PlotSceneTest, ShowsFramesEvenlyOverTheTraceEachWithItsTime) {
  record("--count 20 --rate 200 --duration 1");
  const test::Outcome outcome = run("scene box.mcap --frames 4");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "box-scene.svg");
  for (const char* expected : {"box.mcap: 20 colliders", "0.250 s", "0.500 s", "0.750 s", "0.995 s", "path of 100 ms"})
    EXPECT_THAT(words, HasSubstr(expected));
  const Picture picture = read_png(folder_ / "box-scene.png");
  for (std::size_t panel = 0; panel < 4; ++panel)
    for (std::size_t other = panel + 1; other < 4; ++other)
      EXPECT_GT(difference(picture, panel, other), 5000U) << panel << ' ' << other;
}

TEST_F(PlotSceneTest, WithContactsShowsTheFramesThatHaveThem) {
  write_text(folder_ / "through.csv", "time_s,id,x,y,z\n0,7,0.1,0.75,0.6\n1,7,0.1,0.75,0.03\n");
  record("--animation none --colliders through.csv --rate 10 --duration 1");
  ASSERT_EQ(test::run("vestige replay box.mcap --contacts contacts.csv -q", folder_.path()).exit_code, 0);
  const test::Outcome outcome = run("scene box.mcap --contacts contacts.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "box-scene.svg");
  EXPECT_THAT(words, HasSubstr("0.900 s"));
  EXPECT_THAT(words, HasSubstr("box.mcap: 1 collider"));
  EXPECT_THAT(words, HasSubstr("1 contact"));
  constexpr Pixel kContact = {213, 94, 0};
  EXPECT_GT(read_png(folder_ / "box-scene.png").count(kContact, 0, 800), 50U);

  const test::Outcome elsewhere = run("scene box.mcap --contacts contacts.csv --to 0.5 --force");
  EXPECT_EQ(elsewhere.exit_code, 2);
  EXPECT_THAT(elsewhere.standard_error, HasSubstr("are drawn have no contact"));
}

TEST_F(PlotSceneTest, ColoursByColliderTellCollidersApart) {
  write_text(folder_ / "two.csv",
             "time_s,id,x,y,z\n0,3,0.2,0.9,0.6\n0,8,0.2,0.6,0.6\n1,3,0.2,0.9,0.03\n1,8,0.2,0.6,0.03\n");
  record("--animation none --colliders two.csv --rate 10 --duration 1");
  ASSERT_EQ(test::run("vestige replay box.mcap --contacts contacts.csv -q", folder_.path()).exit_code, 0);
  const auto dots = [&](const std::string& colour_by) {
    const test::Outcome outcome =
        run("scene box.mcap --contacts contacts.csv --map none --force --colour-by " + colour_by);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    const Picture picture = read_png(folder_ / "box-scene.png");
    const std::size_t above_key = (picture.height - 100) * picture.width;
    const auto count = [&](const Pixel& colour) {
      return std::count(picture.pixels.begin(), picture.pixels.begin() + static_cast<std::ptrdiff_t>(above_key),
                        colour);
    };
    return std::pair(count({0, 114, 178}), count({213, 94, 0}));  // the first two colours of lines
  };
  const auto [kind_blue, kind_vermillion] = dots("kind");
  EXPECT_EQ(kind_blue, 0);  // paths are never quite opaque
  EXPECT_GT(kind_vermillion, 100);
  const auto [blue, vermillion] = dots("collider");
  EXPECT_GT(blue, 50);
  EXPECT_GT(vermillion, 50);
  EXPECT_THAT(words_of(folder_ / "box-scene.svg"), HasSubstr("2 colliders, a colour for each"));
}

TEST_F(PlotSceneTest, SeveralPeopleStandWhereTheyAreWithEachOnesContacts) {
  // The second stands 1 m to the right of the first, and is touched there.
  write_text(folder_ / "through.csv", "time_s,id,x,y,z\n0,7,-0.9,0.75,0.6\n1,7,-0.9,0.75,0.03\n");
  const std::string people = " --name first --avatar box.gltf --map box.png --animation none --at -1,0,0 --name second";
  record("--animation none --colliders through.csv --rate 10 --duration 1" + people);
  ASSERT_EQ(test::run("vestige replay box.mcap --contacts contacts.csv -q", folder_.path()).exit_code, 0);
  const test::Outcome outcome = run("scene box.mcap --contacts contacts.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(words_of(folder_ / "box-scene.svg"), HasSubstr("box.mcap: 2 people, 1 collider"));
  constexpr Pixel kContact = {213, 94, 0};
  const Picture both = read_png(folder_ / "box-scene.png");
  EXPECT_GT(both.count(kContact, 0, 800), 50U);

  // Alone, the second is half of what was seen.
  record("--animation none --colliders through.csv --rate 10 --duration 1 --at -1,0,0 --force");
  ASSERT_EQ(run("scene box.mcap --frames 1 --force").exit_code, 0);
  EXPECT_NE(read_png(folder_ / "box-scene.png").pixels, both.pixels);

  record("--animation none --colliders through.csv --rate 10 --duration 1 --force" + people);
  const test::Outcome mapped = run("scene box.mcap --map box.png --force");
  EXPECT_EQ(mapped.exit_code, 2);
  EXPECT_THAT(mapped.standard_error, HasSubstr("box.mcap holds several people"));
}

TEST_F(PlotSceneTest, OnePersonOfSeveralIsChosenByNumber) {
  // Only the second is touched.
  write_text(folder_ / "through.csv", "time_s,id,x,y,z\n0,1,1,0.75,-2\n1,1,1,0.75,2\n");
  record(
      "--animation none --colliders through.csv --rate 10 --duration 1 --name first --at -1,0,0 --avatar box.gltf "
      "--map box.png --animation none --name second --at 1,0,0");
  ASSERT_EQ(test::run("vestige replay box.mcap -q --contacts c.csv --textures t.exr", folder_.path()).exit_code, 0);
  for (const std::string command : {"body box.mcap -o b", "textures t.exr -o x", "paraview box.mcap -o p.pvd"}) {
    const test::Outcome several = run(command);
    EXPECT_EQ(several.exit_code, 2) << command;
    EXPECT_THAT(several.standard_error, HasSubstr("holds 2 people")) << command;
    EXPECT_EQ(run(command + " --person 3").exit_code, 2) << command;
  }
  EXPECT_EQ(run("body box.mcap --person 1 --contacts c.csv -o first").exit_code, 0);
  EXPECT_EQ(run("body box.mcap --person 2 --contacts c.csv -o second").exit_code, 0);
  EXPECT_NE(words_of(folder_ / "first.svg"), words_of(folder_ / "second.svg")) << "the number of contacts differs";
  EXPECT_EQ(run("textures t.exr --person 1 -o first-textures").exit_code, 0);
  EXPECT_EQ(run("textures t.exr --person 2 -o second-textures").exit_code, 0);
  EXPECT_FALSE(read_png(folder_ / "first-textures.png").pixels == read_png(folder_ / "second-textures.png").pixels);
  EXPECT_THAT(run("paraview box.mcap --person 1 -o first.pvd").standard_error, HasSubstr(" 0 contacts"));
  EXPECT_THAT(run("paraview box.mcap --person 2 -o second.pvd").standard_error, Not(HasSubstr(" 0 contacts")));
}

TEST_F(PlotSceneTest, ContactsOfAnotherTraceAreRefusedNamingTheirLine) {
  record("--count 1 --rate 10 --duration 1");
  for (const auto& [row, cause] : {std::pair("10,1,0,11,0,0,0,0,0,3,1,0,0,0", "line 2: refers to frame 10"),
                                   std::pair("9,0.9,0,11,0,0,0,0,0,4,1,0,0,0", "line 2: refers to actuator 4")}) {
    write_text(folder_ / "other.csv",
               fmt::format("frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z\n{}\n", row));
    const test::Outcome outcome = run("scene box.mcap --contacts other.csv");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.standard_error, HasSubstr(fmt::format("other.csv, {}", cause)));
  }
}

TEST_F(PlotSceneTest, AColliderBehindTheBodyIsPaleAndOneInFrontIsNot) {
  constexpr Pixel kInk = {40, 40, 40};
  constexpr std::size_t kPanelDots = 600;
  // Half a metre from the box's middle, towards the viewer and away.
  const std::size_t in_front = picture_with_collider_at(0.278, 0.621, 0.397).count(kInk, 20, kPanelDots);
  const std::size_t behind = picture_with_collider_at(-0.278, 0.379, -0.397).count(kInk, 20, kPanelDots);
  EXPECT_GT(in_front, behind + 30);
}

TEST_F(PlotSceneTest, ATraceTenThousandKilometresAwayLooksTheSame) {
  record("--count 20 --rate 100 --duration 1");
  ASSERT_EQ(run("scene box.mcap --frames 2").exit_code, 0);
  const Picture here = read_png(folder_ / "box-scene.png");
  record("--count 20 --rate 100 --duration 1 --origin 9999999,-3,-9999999 --force");
  ASSERT_EQ(run("scene box.mcap --frames 2 --force").exit_code, 0);
  EXPECT_EQ(read_png(folder_ / "box-scene.png").pixels, here.pixels);
}

TEST_F(PlotSceneTest, ADamagedTraceShowsWhatIsThereAndExitsWith3) {
  record("--count 200 --rate 1000 --duration 1");
  const std::string whole = read_text_file(folder_ / "box.mcap");
  write_text(folder_ / "cut.mcap", std::string_view(whole).substr(0, whole.size() / 2));
  const test::Outcome outcome = run("scene cut.mcap --frames 2");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("cut.mcap"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cut-scene.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cut-scene.png"));

  write_text(folder_ / "empty.mcap", std::string_view(whole).substr(0, 8000));
  const test::Outcome empty = run("scene empty.mcap");
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.standard_error, HasSubstr("empty.mcap: holds no frame"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "empty-scene.svg"));
}

TEST_F(PlotSceneTest, ATimeWithoutFramesIsRefusedNamingTheTraces) {
  record("--count 1 --rate 100 --duration 1");
  const test::Outcome outcome = run("scene box.mcap --from 2");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.standard_error, HasSubstr("from 0 s to 0.99 s"));
  const test::Outcome backwards = run("scene box.mcap --from 0.5 --to 0.2");
  EXPECT_EQ(backwards.exit_code, 2);
  EXPECT_THAT(backwards.standard_error, HasSubstr("0.5 s is after 0.2 s"));
  for (const char* flag : {"--from", "--to", "--trail"})
    for (const char* value : {"nan", "inf"}) {
      const test::Outcome refused = run(fmt::format("scene box.mcap {} {}", flag, value));
      EXPECT_EQ(refused.exit_code, 2) << flag << value;
      EXPECT_THAT(refused.standard_error, HasSubstr("is not a finite number")) << flag << value;
    }
  EXPECT_EQ(run("scene box.mcap --frames 0").exit_code, 2);
  EXPECT_EQ(run("scene box.gltf").exit_code, 1);
}

}  // namespace
}  // namespace vestige
