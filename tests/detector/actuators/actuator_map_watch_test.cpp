#include "detector/actuators/actuator_map_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ActuatorMapWatchTest : public ::testing::Test {
 protected:
  void write_png(const std::string& name) const {
    std::ofstream stream(folder / name, std::ios::binary);
    const std::vector<std::byte> png = builtin_actuator_map_png();
    stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  }
  void write_text(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

  /// As long as a slow machine may take.
  std::optional<ActuatorMap> wait_for_map(ActuatorMapWatch& watch) const {
    for (int i = 0; i < 500; ++i) {
      if (auto watched = watch.take()) return watched->map;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return std::nullopt;
  }
  void wait_for_warnings(std::size_t count) {
    for (int i = 0; i < 500 && warnings_so_far().size() < count; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::vector<std::string> warnings_so_far() {
    const std::lock_guard lock(mutex);
    return warnings;
  }

  const Avatar& avatar = test::builtin_avatar();
  const test::TemporaryFolder folder;
  const std::string file = (folder / "map.png").string();
  std::mutex mutex;
  std::vector<std::string> warnings;
  std::function<void(const std::string&)> warn = [this](const std::string& text) {
    const std::lock_guard lock(mutex);
    warnings.push_back(text);
  };
};

TEST_F(ActuatorMapWatchTest, AMapThatStaysAsItIsIsNotReadAgain) {
  write_png("map.png");
  ActuatorMapWatch watch(file, ActuatorMapWatch::stamp(file), 6, avatar, ActuatorMapWatch::Layouts::kNone, warn);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  EXPECT_FALSE(watch.take());
}

TEST_F(ActuatorMapWatchTest, AnotherFileInItsPlaceAndAnotherSidecarAreRead) {
  write_png("map.png");
  ActuatorMapWatch watch(file, ActuatorMapWatch::stamp(file), 6, avatar, ActuatorMapWatch::Layouts::kNone, warn);
  write_png("new.png");
  std::filesystem::rename(folder / "new.png", file);
  ASSERT_TRUE(wait_for_map(watch));
  EXPECT_FALSE(watch.take());
  write_text("map.json", builtin_actuator_map_json());
  const auto named = wait_for_map(watch);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->names.front(), "upper torso, right");
  EXPECT_THAT(warnings_so_far(), ElementsAre());
}

TEST_F(ActuatorMapWatchTest, WhatCannotBeReadAndAnotherNumberOfActuatorsIsSaidOnceAndTheOldMapStays) {
  write_png("map.png");
  ActuatorMapWatch watch(file, ActuatorMapWatch::stamp(file), 6, avatar, ActuatorMapWatch::Layouts::kNone, warn);
  write_text("map.png", "not a picture");
  wait_for_warnings(1);
  std::filesystem::remove(file);
  wait_for_warnings(2);
  write_png("map.png");
  EXPECT_TRUE(wait_for_map(watch));
  EXPECT_THAT(warnings_so_far(), ElementsAre(HasSubstr("is not a PNG file"), HasSubstr("map.png")));
  EXPECT_FALSE(watch.take());

  ActuatorMapWatch other(file, ActuatorMapWatch::stamp(file), 5, avatar, ActuatorMapWatch::Layouts::kNone, warn);
  write_png("new.png");
  std::filesystem::rename(folder / "new.png", file);
  wait_for_warnings(3);
  EXPECT_THAT(warnings_so_far().back(), HasSubstr("now has 6 actuators, but 5 are in use"));
  EXPECT_FALSE(other.take());
}

}  // namespace
}  // namespace vestige
