#include "detector/actuator_map.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <functional>
#include <limits>

#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using test::message_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A PNG of these samples, `channels` a texel; 16-bit where `Sample` is.
template <typename Sample>
std::vector<std::byte> make_png(const std::vector<Sample>& samples, std::uint32_t width, int colour_type,
                                std::size_t channels = 1) {
  std::vector<std::byte> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp writer, png_bytep bytes, png_size_t count) {
        auto& target = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(writer));
        const auto* first = reinterpret_cast<const std::byte*>(bytes);
        target.insert(target.end(), first, first + count);
      },
      nullptr);
  const std::size_t row = width * channels;
  png_set_IHDR(png, info, width, static_cast<std::uint32_t>(samples.size() / row), 8 * sizeof(Sample), colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (sizeof(Sample) == 2) png_set_swap(png);
  for (std::size_t i = 0; i < samples.size(); i += row)
    png_write_row(png, reinterpret_cast<png_const_bytep>(&samples[i]));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

TEST(ActuatorMap, NumbersGreysInAscendingOrderAndLeavesBlackOut) {
  const auto png = make_png<std::uint8_t>({0, 200, 10, 200}, 2, PNG_COLOR_TYPE_GRAY);
  const ActuatorMap map = parse_actuator_map(png, "", "map.png");
  EXPECT_EQ(map.actuator_count, 2U);
  EXPECT_THAT(map.actuator, ::testing::ElementsAre(0, 2, 1, 2));
}

TEST(ActuatorMap, TellsSixteenBitGreysApart) {
  const auto png = make_png<std::uint16_t>({0, 258, 257, 65535}, 2, PNG_COLOR_TYPE_GRAY);
  EXPECT_THAT(parse_actuator_map(png, "", "map.png").actuator, ::testing::ElementsAre(0, 2, 1, 3));
}

TEST(ActuatorMap, TakesNumbersAndNamesFromTheSidecar) {
  const auto png = make_png<std::uint8_t>({0, 200, 10, 200}, 2, PNG_COLOR_TYPE_GRAY);
  const ActuatorMap map = parse_actuator_map(
      png, R"({"actuators": [{"grey": 200, "name": "left"}, {"grey": 10}, {"grey": 5, "name": "never"}]})", "map.png");
  EXPECT_THAT(map.actuator, ::testing::ElementsAre(0, 1, 2, 1));
  EXPECT_THAT(map.names, ::testing::ElementsAre("left", "actuator 2", "never"));
  EXPECT_THAT(message_of([&] { parse_actuator_map(png, R"({"actuators": [{"grey": 200}]})", "map.png"); }),
              HasSubstr("texel (0, 1) has grey 10"));
  EXPECT_THAT(message_of([&] { parse_actuator_map(png, "{", "map.png"); }), HasSubstr("map.png, sidecar"));
  EXPECT_THAT(message_of([&] { parse_actuator_map(png, R"({"actuators": [{"grey": 0}]})", "map.png"); }),
              HasSubstr("actuators[0]"));
}

TEST(ActuatorMap, TakesPositionsFromTheSidecarWhereItGivesThem) {
  const auto png = make_png<std::uint8_t>({0, 200, 10, 200}, 2, PNG_COLOR_TYPE_GRAY);
  const ActuatorMap map = parse_actuator_map(
      png, R"({"actuators": [{"grey": 200, "position_m": [0.5, 1, -2e-1]}, {"grey": 10}]})", "map.png");
  ASSERT_EQ(map.position_m.size(), 2U);
  EXPECT_EQ(map.position_m[0], glm::dvec3(0.5, 1, -0.2));
  EXPECT_EQ(map.position_m[1], std::nullopt);
  EXPECT_EQ(parse_actuator_map(png, "", "map.png").position_m.size(), 2U);
  for (const char* position : {"[1, 2]", "[1, 2, 3, 4]", R"(["a", 2, 3])", "1", "null", "[1, 2, null]"}) {
    const std::string sidecar =
        fmt::format(R"({{"actuators": [{{"grey": 200}}, {{"grey": 10, "position_m": {}}}]}})", position);
    EXPECT_THAT(message_of([&] { parse_actuator_map(png, sidecar, "map.png"); }),
                HasSubstr("actuators[1]: 'position_m' is not three finite numbers"))
        << position;
  }
}

TEST(ActuatorMap, RefusesASidecarThatSaysOneThingTwice) {
  const auto png = make_png<std::uint8_t>({10}, 1, PNG_COLOR_TYPE_GRAY);
  EXPECT_THAT(message_of([&] {
                parse_actuator_map(png, R"({"actuators": [{"grey": 10, "name": "a", "grey": 11}]})", "map.png");
              }),
              HasSubstr("map.png, sidecar: an object has 'grey' twice"));
  EXPECT_THAT(message_of([&] { parse_actuator_map(png, R"({"actuators": [)", "map.png"); }),
              HasSubstr("map.png, sidecar, byte 16: is not JSON from this byte on"));
  const char* same_name_apart = R"({"name": 1, "actuators": [{"grey": 10, "name": "a"}]})";
  EXPECT_EQ(parse_actuator_map(png, same_name_apart, "map.png").names.at(0), "a");
}

TEST(ActuatorMap, RefusesNamesThatCannotBeShown) {
  const auto png = make_png<std::uint8_t>({10}, 1, PNG_COLOR_TYPE_GRAY);
  for (const char* name : {"5", "null", R"("")", R"("a\nb")", R"("a\u001b[31mred")", R"("a\u007f")"}) {
    const std::string sidecar = fmt::format(R"({{"actuators": [{{"grey": 10, "name": {}}}]}})", name);
    EXPECT_THAT(message_of([&] { parse_actuator_map(png, sidecar, "map.png"); }), HasSubstr("actuators[0]: 'name' "))
        << name;
  }
}

TEST(ActuatorMap, WarnsOfFieldsThatMeanNothingAndOfNamesThatStandTwice) {
  const auto png = make_png<std::uint8_t>({10, 20}, 2, PNG_COLOR_TYPE_GRAY);
  const char* sidecar =
      R"({"skn": "", "actuators": [{"grey": 10, "name": "a", "positon_m": [0, 0, 0]}, {"grey": 20, "name": "a"}]})";
  EXPECT_THAT(parse_actuator_map(png, sidecar, "map.png").warnings,
              ElementsAre(HasSubstr("map.png, sidecar: the field 'skn' has no meaning here"),
                          HasSubstr("map.png, sidecar, actuators[0]: the field 'positon_m' has no meaning here"),
                          HasSubstr("actuators 1 and 2 are both called 'a'")));
}

TEST(ActuatorMap, RefusesAnImageThatIsTooLargeAsWhatItIs) {
  const auto png = make_png<std::uint8_t>(std::vector<std::uint8_t>(16385, 10), 16385, PNG_COLOR_TYPE_GRAY);
  EXPECT_THAT(message_of([&] { parse_actuator_map(png, "", "map.png"); }),
              HasSubstr("is 16385 x 1 texels; a side must have at most 16384"));
}

TEST(ActuatorMap, TakesTheNearestTexelAndWrapsAround) {
  ActuatorMap map;
  map.width = 2;
  map.height = 2;
  map.actuator = {1, 2, 3, 4};
  EXPECT_EQ(map.at({0.25, 0.25}), 1);
  EXPECT_EQ(map.at({0.5, 0.25}), 2);
  EXPECT_EQ(map.at({0.49999, 0.5}), 3);
  EXPECT_EQ(map.at({1.0, 0.0}), 1);
  EXPECT_EQ(map.at({-0.25, 1.75}), 4);
  EXPECT_EQ(map.at({-1e-300, 0}), 2);
  EXPECT_EQ(map.at({std::numeric_limits<double>::quiet_NaN(), 0}), 0);
  EXPECT_EQ(map.at({std::numeric_limits<double>::infinity(), 0}), 0);
}

TEST(ActuatorMap, RefusesWhatIsNoGreyPngAndSaysWhere) {
  const auto png = make_png<std::uint8_t>({0, 200, 10, 200}, 2, PNG_COLOR_TYPE_GRAY);
  for (std::size_t size = 0; size < png.size(); ++size) {
    const auto cut = std::span(png).first(size);
    EXPECT_THROW(parse_actuator_map(cut, "", "map.png"), Error) << size;
  }
  for (std::size_t i = 0; i < png.size(); ++i) {
    auto damaged = png;
    damaged[i] ^= std::byte{0x55};
    message_of([&] { parse_actuator_map(damaged, "", "map.png"); });  // any answer will do, a crash will not
  }
  const auto colour = make_png<std::uint8_t>({1, 2, 3}, 1, PNG_COLOR_TYPE_RGB, 3);
  EXPECT_THAT(message_of([&] { parse_actuator_map(colour, "", "map.png"); }), HasSubstr("greyscale"));
  const auto alpha = make_png<std::uint8_t>({40, 0}, 1, PNG_COLOR_TYPE_GRAY_ALPHA, 2);
  EXPECT_THAT(message_of([&] { parse_actuator_map(alpha, "", "map.png"); }), HasSubstr("greyscale"));
  EXPECT_THAT(message_of([&] { parse_actuator_map({}, "", "map.png"); }), HasSubstr("is not a PNG"));
}

TEST(ActuatorMap, WarnsOfSoftEdges) {
  std::vector<std::uint8_t> ramp(256);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<std::uint8_t>(i);
  const ActuatorMap map = parse_actuator_map(make_png(ramp, 16, PNG_COLOR_TYPE_GRAY), "", "map.png");
  EXPECT_EQ(map.actuator_count, 255U);
  EXPECT_EQ(map.warnings.size(), 2U);
}

TEST(ActuatorMap, ReadsTheMapsOfRealAvatars) {
  const auto path = test::data("avatars/maps/CesiumMan.actuators6.png");
  VESTIGE_REQUIRE_DATA(path);
  const ActuatorMap map = parse_actuator_map(read_file(path), "", path.string());
  EXPECT_EQ(map.actuator_count, 6U);
  EXPECT_EQ(map.width, 512U);
}

TEST(ActuatorMap, OfTheBuiltInAvatarHasSixNamedRegions) {
  const ActuatorMap map = parse_actuator_map(builtin_actuator_map_png(), builtin_actuator_map_json(), "builtin");
  ASSERT_EQ(map.actuator_count, 6U);
  EXPECT_EQ(map.names[1], "upper torso, left");
  EXPECT_TRUE(map.warnings.empty());
}

TEST(ActuatorMap, MayGiveEachTriangleItsOwn) {
  const std::vector<std::uint8_t> greys = {0, 40, 80, 40, 80, 0};
  const auto png = make_png(greys, 3, PNG_COLOR_TYPE_GRAY);
  constexpr const char* kSidecar = R"({"triangles": 5, "actuators": [{"grey": 40}, {"grey": 80}]})";
  const ActuatorMap map = parse_actuator_map(png, kSidecar, "map.png");
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(map.at(i, {0.9, 0.9}), greys[i] / 40) << i;
  EXPECT_EQ(map.at(5, {0.9, 0.9}), 0) << "no triangle of its";
  EXPECT_THAT(map.warnings, ElementsAre(HasSubstr("Every avatar with 5 triangles")));

  EXPECT_THAT(message_of([&] {
                parse_actuator_map(png, R"({"triangles": 4, "actuators": [{"grey": 40}, {"grey": 80}]})", "map.png");
              }),
              HasSubstr("not black"));
  Avatar avatar;
  avatar.triangles.resize(5);
  EXPECT_EQ(parse_actuator_map({png, kSidecar}, avatar, "map.png").triangle_count, 5U);
  avatar.triangles.resize(4);
  EXPECT_THAT(message_of([&] {
                parse_actuator_map({png, kSidecar}, avatar, "map.png");
              }),
              HasSubstr("is for an avatar with 5 triangles, but this avatar has 4"));
  EXPECT_THAT(message_of([&] {
                parse_actuator_map(png, R"({"triangles": 7, "actuators": [{"grey": 40}, {"grey": 80}]})", "map.png");
              }),
              HasSubstr("6 texels for 7 triangles"));
  for (const char* number : {"0", "-1", "1.5", "\"5\""})
    EXPECT_THAT(message_of([&] {
                  parse_actuator_map(png, fmt::format(R"({{"triangles": {}, "actuators": []}})", number), "map.png");
                }),
                HasSubstr("'triangles'"))
        << number;
}

}  // namespace
}  // namespace vestige
