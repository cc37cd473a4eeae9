// Films of traces: runs vestige-plot as a user does, decodes the file again, and looks at the pixels.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <webp/demux.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/analysis/box_avatar.hpp"
#include "tests/support/process.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using test::Picture;
using test::Pixel;
using test::read_png;
using test::write_text;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

struct Film {
  std::uint32_t loops = 1;
  std::vector<Picture> pictures;
  std::vector<int> duration_ms;
};

Film read_film(const std::filesystem::path& path) {
  const std::string file = read_text_file(path);
  const WebPData data = {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()};
  const std::unique_ptr<WebPAnimDecoder, decltype(&WebPAnimDecoderDelete)> decoder(WebPAnimDecoderNew(&data, nullptr),
                                                                                   &WebPAnimDecoderDelete);
  if (decoder == nullptr) throw std::runtime_error(path.string() + " is no WebP image");
  WebPAnimInfo info;
  WebPAnimDecoderGetInfo(decoder.get(), &info);
  Film film;
  film.loops = info.loop_count;
  int begin_ms = 0;
  while (WebPAnimDecoderHasMoreFrames(decoder.get()) != 0) {
    std::uint8_t* rgba = nullptr;
    int end_ms = 0;
    if (WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms) == 0) throw std::runtime_error("a picture is damaged");
    Picture& picture = film.pictures.emplace_back();
    picture.width = info.canvas_width;
    picture.height = info.canvas_height;
    for (std::size_t i = 0; i < picture.width * picture.height; ++i, rgba += 4)
      picture.pixels.push_back({rgba[0], rgba[1], rgba[2]});
    film.duration_ms.push_back(end_ms - begin_ms);
    begin_ms = end_ms;
  }
  return film;
}

/// Places on a picture, in pixels. The edges leave out rows and columns that have only a few.
struct Spots {
  std::size_t count = 0;
  double left = 0, right = 0, top = 0, bottom = 0;
  double middle_x = 0, middle_y = 0;
};

/// Returns the first and the last of the numbers that is at least a third of the largest.
std::pair<double, double> edges_of(const std::vector<std::size_t>& numbers) {
  const std::size_t least = std::max<std::size_t>(1, *std::ranges::max_element(numbers) / 3);
  const auto is_enough = [&](std::size_t number) { return number >= least; };
  const auto first = std::find_if(numbers.begin(), numbers.end(), is_enough);
  const auto last = std::find_if(numbers.rbegin(), numbers.rend(), is_enough);
  return {static_cast<double>(first - numbers.begin()), static_cast<double>(numbers.rend() - last - 1)};
}

/// The pixels of rows [begin, end), as shares of the height, whose colour is wanted.
template <typename Wanted>
Spots find(const Picture& picture, double begin, double end, const Wanted& wanted) {
  Spots spots;
  std::vector<std::size_t> rows(picture.height);
  std::vector<std::size_t> columns(picture.width);
  const auto last = static_cast<std::size_t>(end * static_cast<double>(picture.height));
  for (auto row = static_cast<std::size_t>(begin * static_cast<double>(picture.height)); row < last; ++row)
    for (std::size_t column = 0; column < picture.width; ++column) {
      if (!wanted(picture.pixels[row * picture.width + column])) continue;
      ++spots.count, ++rows[row], ++columns[column];
      spots.middle_x += static_cast<double>(column), spots.middle_y += static_cast<double>(row);
    }
  if (spots.count == 0) return spots;
  spots.middle_x /= static_cast<double>(spots.count);
  spots.middle_y /= static_cast<double>(spots.count);
  std::tie(spots.top, spots.bottom) = edges_of(rows);
  std::tie(spots.left, spots.right) = edges_of(columns);
  return spots;
}

/// Skin over a motor that runs, in light and in shadow.
bool is_lit(const Pixel& pixel) {
  return pixel.red > 120 && pixel.green > pixel.red * 7 / 10 && pixel.green < pixel.red && pixel.blue < pixel.red / 3;
}
/// The pale orange of the second of three regions.
bool is_belly(const Pixel& pixel) {
  return pixel.red > 150 && pixel.green > pixel.red * 7 / 10 && pixel.green < pixel.red - 15 &&
         pixel.blue > pixel.red / 3 && pixel.blue < pixel.red * 3 / 4;
}
bool is_contact(const Pixel& pixel) {
  return pixel.red > 180 && pixel.green > 60 && pixel.green < 130 && pixel.blue < 50;
}

/// Where the pictures of a film show the scene, and the line of dots between it and the timeline, which only the cursor
/// crosses.
constexpr double kSceneBegin = 0.06;
constexpr double kSceneEnd = 0.75;
std::size_t row_of_cursor(const Picture& picture) {
  return picture.height - static_cast<std::size_t>(70.0 / 384 * static_cast<double>(picture.width));
}

std::size_t cursor_of(const Picture& picture) {
  const auto begin = picture.pixels.begin() + static_cast<std::ptrdiff_t>(row_of_cursor(picture) * picture.width);
  const auto end = begin + static_cast<std::ptrdiff_t>(picture.width);
  const auto darkest = std::min_element(begin, end, [](const Pixel& a, const Pixel& b) { return a.green < b.green; });
  EXPECT_LT(darkest->green, 160) << "no cursor";
  return static_cast<std::size_t>(darkest - begin);
}

class PlotFilmTest : public test::PlotTest {
 protected:
  PlotFilmTest() {
    test::write_box(folder_.path());
    test::write_box_map(folder_.path());
    write_text(folder_ / "through.csv", "time_s,id,x,y,z\n0,7,0.1,0.75,0.6\n1,7,0.1,0.75,0.03\n");
  }

  void record(const std::string& arguments) const {
    const test::Outcome outcome =
        test::run("vestige record --avatar box.gltf --map box.png -o box.mcap -q --force " + arguments, folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }

  Film film(const std::string& arguments, int width = 320) const {
    const test::Outcome outcome = run("film box.mcap --force --width " + std::to_string(width) + " " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    return read_film(folder_ / "box-film.webp");
  }
};

TEST_F(PlotFilmTest, LastsAsLongAsTheTraceAtItsSpeed) {
  record("--animation turn --colliders none --rate 100 --duration 1");
  const Film slow = film("--fps 10 --speed 1/2 --to 0.95");
  EXPECT_EQ(slow.loops, 0U) << "it repeats for ever";
  EXPECT_EQ(slow.duration_ms, std::vector<int>(20, 100));
  for (std::size_t i = 0; i < slow.pictures.size(); ++i) {
    EXPECT_EQ(slow.pictures[i].width, 320U);
    if (i > 0) {
      EXPECT_NE(slow.pictures[i].pixels, slow.pictures[i - 1].pixels) << i;
      EXPECT_NEAR(static_cast<double>(cursor_of(slow.pictures[i]) - cursor_of(slow.pictures[i - 1])),
                  static_cast<double>(cursor_of(slow.pictures[1]) - cursor_of(slow.pictures[0])), 1.01)
          << "the cursor moves evenly";
    }
  }
  EXPECT_EQ(film("--fps 10 --from 0.2 --to 0.5").duration_ms, std::vector<int>(4, 100));
}

TEST_F(PlotFilmTest, ShowsEachFrameOfASlowTraceOnce) {
  record("--animation turn --count 3 --rate 10 --duration 1");
  const Film shown = film("");
  EXPECT_EQ(shown.pictures.size(), 10U);
  EXPECT_THAT(shown.duration_ms, Each(::testing::AnyOf(80, 120)));
  EXPECT_NEAR(std::accumulate(shown.duration_ms.begin(), shown.duration_ms.end(), 0), 1000, 45);
}

TEST_F(PlotFilmTest, AMotorLightsUpOnItsRegionWhileItRuns) {
  record("--animation none --colliders through.csv --rate 100 --duration 1");
  // The front is seen, whose upper half is touched at 0.88 s.
  const Film shown = film("--view front --fps 20 --from 0.7");
  ASSERT_EQ(shown.pictures.size(), 7U) << "six, and the last frame";
  const auto lit = [&](std::size_t picture) { return find(shown.pictures[picture], kSceneBegin, kSceneEnd, is_lit); };
  for (std::size_t before = 0; before < 4; ++before) EXPECT_LT(lit(before).count, 20U) << before;
  const Spots running = lit(4);
  const double below = running.middle_y / static_cast<double>(shown.pictures[4].height);
  const Spots belly = find(shown.pictures[4], below, kSceneEnd, is_belly);
  EXPECT_GT(running.count, 1000U);
  EXPECT_NEAR(running.left, belly.left, 3);
  EXPECT_NEAR(running.right, belly.right, 3);
  EXPECT_NEAR(running.bottom, belly.top, 3);
  // The timeline has it all along: its second half is blue in the line of the chest.
  const auto is_chest_line = [](const Pixel& pixel) { return pixel.blue > 150 && pixel.red < 60; };
  for (const Picture& picture : {shown.pictures.front(), shown.pictures.back()})
    EXPECT_GT(find(picture, 1 - 68.0 / 384 * 320 / static_cast<double>(picture.height) - 0.08, 1, is_chest_line).count,
              100U);

  // Half the duty is half the way to yellow, which has no blue.
  write_text(folder_ / "motors.json", R"({"duty": {"table": [[0, 0], [1, 0.5]]}})");
  const Film half = film("--view front --fps 20 --from 0.7 --actuator motors.json");
  const auto blue_of_chest = [&](const Picture& picture) {
    const auto row = static_cast<std::size_t>((running.top + running.bottom) / 2);
    const auto column = static_cast<std::size_t>((running.left + running.right) / 2);
    return picture.pixels[row * picture.width + column].blue;
  };
  EXPECT_NEAR(blue_of_chest(half.pictures[4]), blue_of_chest(shown.pictures[0]) / 2, 25);
  EXPECT_LT(blue_of_chest(shown.pictures[4]), 40);
}

TEST_F(PlotFilmTest, TheRawFramesOfHoldZeroAreNotLostBetweenPictures) {
  record("--animation none --colliders through.csv --rate 1000 --duration 1");
  const Film shown = film("--view front --fps 4 --from 0.15 --hold 0");
  ASSERT_EQ(shown.pictures.size(), 5U);
  EXPECT_GT(find(shown.pictures[3], kSceneBegin, kSceneEnd, is_lit).count, 1000U)
      << "one frame at 0.88 s; the pictures are those of 0.65 s and 0.9 s";
  EXPECT_LT(find(shown.pictures[4], kSceneBegin, kSceneEnd, is_lit).count, 20U);
  const Film later = film("--view front --fps 4 --from 0.95 --hold 0");
  EXPECT_LT(find(later.pictures.front(), kSceneBegin, kSceneEnd, is_lit).count, 20U) << "felt before the film began";
}

TEST_F(PlotFilmTest, AContactLiesWhereTheStillFigureHasItAndFades) {
  record("--animation none --colliders through.csv --rate 100 --duration 1");
  ASSERT_EQ(test::run("vestige replay box.mcap --contacts contacts.csv -q", folder_.path()).exit_code, 0);
  ASSERT_EQ(run("scene box.mcap --contacts contacts.csv --frames 1").exit_code, 0);
  const Picture still = read_png(folder_ / "box-scene.png");
  const Spots still_mark = find(still, 0.1, 0.85, is_contact);
  const Spots still_belly = find(still, 0.1, 0.85, is_belly);
  const Film shown = film("--fps 50 --from 0.86 --hold 0", 640);
  std::size_t before = 0;
  std::vector<std::size_t> sizes;
  for (const Picture& picture : shown.pictures) {
    const Spots mark = find(picture, kSceneBegin, kSceneEnd, is_contact);
    const Spots belly = find(picture, kSceneBegin, kSceneEnd, is_belly);
    sizes.push_back(mark.count);
    if (before == 0 && mark.count > 0) {
      const double scale = (still_belly.bottom - still_belly.top) / (belly.bottom - belly.top);
      EXPECT_NEAR((mark.middle_x - belly.left) * scale, still_mark.middle_x - still_belly.left, 8) << "of 500 dots";
      EXPECT_NEAR((mark.middle_y - belly.top) * scale, still_mark.middle_y - still_belly.top, 8);
    }
    before = mark.count;
  }
  EXPECT_GT(*std::ranges::max_element(sizes), 20U);
  EXPECT_EQ(sizes.front(), 0U);
  EXPECT_EQ(sizes.back(), 0U) << "faded";
}

TEST_F(PlotFilmTest, ContactsBetweenPicturesAreSeenHoweverFarApartThoseAre) {
  record("--animation none --colliders through.csv --rate 100 --duration 1");
  // The contact at 0.88 s is older than --trail in the picture of 0.99 s.
  const auto is_paler = [](const Pixel& pixel) { return pixel.red > 180 && pixel.green < 150 && pixel.blue < 110; };
  const auto marks_of = [&](const Picture& picture) { return find(picture, kSceneBegin, kSceneEnd, is_paler).count; };
  const Film fast = film("--view front --fps 5 --speed 4 --trail 20 --hold 0", 640);
  ASSERT_EQ(fast.pictures.size(), 3U) << "0 s, 0.8 s and the last frame";
  EXPECT_EQ(marks_of(fast.pictures[1]), 0U);
  EXPECT_GT(marks_of(fast.pictures[2]), 20U);
}

TEST_F(PlotFilmTest, NothingAfterTheLastPeriodIsLost) {
  record("--animation none --colliders through.csv --rate 100 --duration 1");
  const test::Outcome outcome = run("film box.mcap --view front --fps 1 --speed 1000 --width 320");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error + outcome.standard_output, AllOf(HasSubstr("2 pictures"), HasSubstr("1 contact")));
  const Film shown = read_film(folder_ / "box-film.webp");
  ASSERT_EQ(shown.pictures.size(), 2U);
  EXPECT_LT(find(shown.pictures[0], kSceneBegin, kSceneEnd, is_lit).count, 20U);
  EXPECT_GT(find(shown.pictures[1], kSceneBegin, kSceneEnd, is_lit).count, 1000U);
}

TEST_F(PlotFilmTest, SaysWhatIsNotFinite) {
  ASSERT_EQ(test::run("vestige record -q --count 1 --duration 0.02 -o t.mcap && vestige export -q t.mcap -o t.ndjson",
                      folder_.path())
                .exit_code,
            0);
  std::istringstream lines(read_text_file(folder_ / "t.ndjson"));
  std::string changed;
  for (std::string line; std::getline(lines, line);) {
    nlohmann::json frame = nlohmann::json::parse(line);
    if (frame["frame"] == 10) frame["pose"]["nodes"][7][0] = 3e38;
    changed += frame.dump() + "\n";
  }
  write_text(folder_ / "again.ndjson", changed);
  ASSERT_LE(test::run("vestige record -q --live - -o again.mcap < again.ndjson", folder_.path()).exit_code, 3);
  const test::Outcome outcome = run("film again.mcap --fps 1 --width 320");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("again.mcap: 1 pose and"), HasSubstr("the first in frame 10")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "again-film.webp"));
}

TEST_F(PlotFilmTest, IsSeenFromTheSideThatIsAskedFor) {
  record("--animation none --count 1 --rate 10 --duration 1");
  const auto of_belly = [&](const std::string& side) {
    return find(film("--to 0 --view " + side).pictures.front(), kSceneBegin, kSceneEnd, is_belly);
  };
  const Spots front = of_belly("front");
  const Spots half_left = of_belly("auto");
  EXPECT_GT(front.count, 1000U);
  EXPECT_LT(half_left.right - half_left.left, 0.9 * (front.right - front.left));
  for (const char* side : {"back", "left", "right"}) EXPECT_LT(of_belly(side).count, 50U) << side;
}

TEST_F(PlotFilmTest, SeveralPeopleHaveTheirOwnMotors) {
  // The second stands 1 m to the right of the first, and is touched there.
  write_text(folder_ / "second.csv", "time_s,id,x,y,z\n0,7,-0.9,0.75,0.6\n1,7,-0.9,0.75,0.03\n");
  record(
      "--animation none --colliders second.csv --rate 100 --duration 1 --name first --avatar box.gltf --map box.png "
      "--animation none --at -1,0,0 --name second");
  const Film shown = film("--view front --fps 20 --from 0.9");
  const Spots lit = find(shown.pictures.front(), kSceneBegin, kSceneEnd, is_lit);
  EXPECT_GT(lit.count, 300U);
  EXPECT_LT(lit.right, 160) << "the left half of the picture";
}

TEST_F(PlotFilmTest, WithoutAMapThereIsNoMotor) {
  record("--animation none --colliders through.csv --rate 100 --duration 1");
  const Film shown = film("--map none --view front --fps 10 --from 0.8");
  for (const Picture& picture : shown.pictures) EXPECT_LT(find(picture, kSceneBegin, kSceneEnd, is_lit).count, 20U);
  // Then no law matters, not even one that only spheres satisfy.
  const test::Outcome outcome = run("film box.mcap --force --width 320 --to 0.1 --map none --law depth");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("there is no actuator map, so no motor runs"));
  const test::Outcome felt = run("film box.mcap --force --width 320 --to 0.1 --law depth");
  EXPECT_EQ(felt.exit_code, 1);
  EXPECT_THAT(felt.standard_error, HasSubstr("only spheres are felt"));
}

TEST_F(PlotFilmTest, WhatCannotBeDoneIsSaidAndNothingIsWritten) {
  record("--animation none --count 1 --rate 10 --duration 61");
  const std::size_t files = file_count();
  const auto expect_refusal = [&](const std::string& arguments, const std::string& cause) {
    const test::Outcome outcome = run("film box.mcap " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.standard_error, HasSubstr(cause)) << arguments;
    EXPECT_EQ(file_count(), files) << arguments;
  };
  expect_refusal("", "would be longer than 60 s");
  expect_refusal("-o box.png", "'box.png' does not end in .webp");
  for (const char* speed : {"0", "-1", "1/0", "0/0", "1/", "/2", "nan", "inf", "fast", "1e9", "1/1e9"})
    expect_refusal(fmt::format("--to 1 --speed {}", speed), fmt::format("'{}' is no speed", speed));
  expect_refusal("--from 2 --to 1", "2 s is after 1 s");
  expect_refusal("--from 100", "lasts from 0 s to 60.9 s");
  expect_refusal("--from 0.51 --to 0.59", "lasts from 0 s to 60.9 s");
  expect_refusal("--fps 0", "--fps");
  expect_refusal("--width 10", "--width");
  expect_refusal("--view above", "--view");
  expect_refusal("--to 1 --law loud", "there is no intensity law 'loud'");
  expect_refusal("--to 1 --sigma 9", "--sigma");
  const test::Outcome first = run("film absent.mcap --from 2 --to 1");
  EXPECT_EQ(first.exit_code, 2) << "before the trace is read";
  const test::Outcome no_trace = run("film box.gltf");
  EXPECT_EQ(no_trace.exit_code, 1);
  const test::Outcome no_layout = run("film box.mcap --to 1 --map torso41");
  EXPECT_EQ(no_layout.exit_code, 1);
  EXPECT_THAT(no_layout.standard_error, HasSubstr("the layouts are: paper6, torso16, torso40, body, builtin"));
  const test::Outcome no_gl = run("film box.mcap --to 1", "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent");
  EXPECT_EQ(no_gl.exit_code, 1);
  EXPECT_THAT(no_gl.standard_error, AllOf(HasSubstr("box-film.webp: cannot be drawn"), HasSubstr("libegl1")));
  EXPECT_EQ(file_count(), files);

  write_text(folder_ / "box-film.webp", "mine");
  EXPECT_EQ(run("film box.mcap --to 1").exit_code, 1);
  EXPECT_EQ(read_text_file(folder_ / "box-film.webp"), "mine");
}

TEST_F(PlotFilmTest, AnInterruptedFilmIsAFailureThatLeavesNothing) {
  record("--animation turn --colliders none --rate 25 --duration 59");
  const std::size_t files = file_count();
  const test::Outcome outcome = test::run("vestige-plot film box.mcap & P=$!; " + test::interrupt(), folder_.path());
  EXPECT_EQ(outcome.exit_code, 1) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error,
              HasSubstr("box-film.webp: stopped by Ctrl-C; nothing was written\n  start it again"));
  EXPECT_EQ(file_count(), files);
}

TEST_F(PlotFilmTest, ADamagedTraceShowsWhatIsThereAndExitsWith3) {
  record("--animation turn --count 200 --rate 1000 --duration 1");
  const std::string whole = read_text_file(folder_ / "box.mcap");
  write_text(folder_ / "cut.mcap", std::string_view(whole).substr(0, whole.size() / 2));
  const test::Outcome outcome = run("film cut.mcap --fps 5 --width 320");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("cut.mcap"));
  EXPECT_GE(read_film(folder_ / "cut-film.webp").pictures.size(), 1U);

  write_text(folder_ / "empty.mcap", std::string_view(whole).substr(0, 8000));
  const test::Outcome empty = run("film empty.mcap");
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.standard_error, AllOf(HasSubstr("empty.mcap"), HasSubstr("holds no frame")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "empty-film.webp"));
}

TEST_F(PlotFilmTest, ATraceTenThousandKilometresAwayLooksTheSame) {
  record("--animation turn --count 20 --rate 100 --duration 0.4");
  const Film here = film("--fps 5");
  record("--animation turn --count 20 --rate 100 --duration 0.4 --origin 9999999,-3,-9999999");
  const Film there = film("--fps 5");
  ASSERT_EQ(here.pictures.size(), there.pictures.size());
  for (std::size_t i = 0; i < here.pictures.size(); ++i)
    EXPECT_EQ(here.pictures[i].pixels, there.pictures[i].pixels) << i;
}

}  // namespace
}  // namespace vestige
