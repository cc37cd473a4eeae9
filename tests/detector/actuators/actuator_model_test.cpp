#include "detector/actuators/actuator_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "detector/actuators/portable_math.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ActuatorMap map_of(std::vector<std::string> names) {
  ActuatorMap map;
  map.actuator_count = names.size();
  map.names = std::move(names);
  return map;
}

std::string complaint(std::string_view json) {
  try {
    parse_actuator_model(json, "motor.json").motors(map_of({"left", "right"}));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Motor, RisesToNinetyFivePercentInThreeTimeConstants) {
  const Motor motor;
  EXPECT_NEAR(motor.after(0, 255, 0.180), 0.95, 0.001);
  EXPECT_NEAR(motor.after(1, 0, 0.060), std::exp(-1), 1e-12);
}

TEST(Motor, ComesToTheSameWhateverTheFrameRate) {
  Motor motor;
  motor.rise_s = 0.08;
  motor.fall_s = 0.03;
  motor.dead_zone = 0.2;
  const double at_once = motor.after(0.1, 200, 0.150);
  for (const int steps : {3, 9, 150, 1000}) {
    double amplitude = 0.1;
    for (int i = 0; i < steps; ++i) amplitude = motor.after(amplitude, 200, 0.150 / steps);
    EXPECT_NEAR(amplitude, at_once, 1e-12) << steps;
  }
}

TEST(Motor, StandsStillInItsDeadZone) {
  Motor motor;
  motor.dead_zone = 0.2;
  EXPECT_EQ(motor.settled(51), 0);
  EXPECT_NEAR(motor.settled(153), 0.5, 1e-12);
  EXPECT_EQ(motor.settled(255), 1);
  EXPECT_EQ(motor.duty(0), 0);
  EXPECT_EQ(motor.duty(0.5), 128);
}

TEST(ActuatorModel, ReadsCurvesAndWhatIsDifferentForOne) {
  const ActuatorModel model = parse_actuator_model(
      R"({"duty": {"gamma": 0.5}, "rise_ms": 90, "dead_zone": 0.1, "felt_threshold": 0.2,
          "actuators": [{"name": "right", "duty": {"table": [[0, 0.4], [0.5, 0.6], [1, 1]]}, "kick_ms": 20}]})",
      "motor.json");
  const std::vector<Motor> motors = model.motors(map_of({"left", "right"}));
  ASSERT_EQ(motors.size(), 2U);
  EXPECT_EQ(motors[0].duty(0.25), std::lround(255 * std::sqrt(64 / 255.0)));
  EXPECT_EQ(motors[0].duty(0), 0);
  EXPECT_EQ(motors[0].duty(1), 255);
  EXPECT_EQ(motors[0].kick_s, 0);
  EXPECT_EQ(motors[1].duty(0), 0) << "off is off";
  EXPECT_EQ(motors[1].duty(51 / 255.0), std::lround(255 * 0.48));
  EXPECT_EQ(motors[1].duty(204 / 255.0), std::lround(255 * 0.84));
  EXPECT_EQ(motors[1].kick_s, 0.020);
  EXPECT_EQ(motors[1].rise_s, 0.090);
  EXPECT_EQ(motors[1].felt_threshold, 0.2);
}

TEST(ActuatorModel, SaysWhatIsWrong) {
  EXPECT_EQ(complaint("{}"), "");
  EXPECT_THAT(complaint("nonsense"), AllOf(HasSubstr("motor.json"), HasSubstr("not JSON")));
  EXPECT_THAT(complaint("[]"), HasSubstr("not a JSON object"));
  EXPECT_THAT(complaint(R"({"rise_ms": 0})"), HasSubstr("'rise_ms' is 0"));
  EXPECT_THAT(complaint(R"({"rise_ms": "fast"})"), HasSubstr("'rise_ms'"));
  EXPECT_THAT(complaint(R"({"dead_zone": 1.5})"), HasSubstr("'dead_zone'"));
  EXPECT_THAT(complaint(R"({"dead_zone": 1})"), HasSubstr("never turns"));
  EXPECT_THAT(complaint(R"({"deadzone": 0.1})"), AllOf(HasSubstr("'deadzone'"), HasSubstr("dead_zone")));
  EXPECT_THAT(complaint(R"({"duty": 1})"), HasSubstr("'duty'"));
  EXPECT_THAT(complaint(R"({"duty": {"gamma": 0}})"), HasSubstr("'gamma'"));
  EXPECT_THAT(complaint(R"({"duty": {"table": [[0, 0], [0.5, 0.6], [0.5, 1], [1, 1]]}})"), HasSubstr("'table'"));
  EXPECT_THAT(complaint(R"({"duty": {"table": [[0, 0], [0.9, 1]]}})"), HasSubstr("'table'"));
  EXPECT_THAT(complaint(R"({"actuators": {}})"), HasSubstr("'actuators' is not a list"));
  EXPECT_THAT(complaint(R"({"actuators": [{"rise_ms": 2}]})"), HasSubstr("has no 'name'"));
  EXPECT_THAT(complaint(R"({"actuators": [{"name": "up"}]})"), AllOf(HasSubstr("'up'"), HasSubstr("left, right")));
  EXPECT_THAT(complaint(R"({"actuators": [{"name": "left"}, {"name": "left"}]})"), HasSubstr("twice"));
}

TEST(PortableMath, AgreesWithTheLibrarys) {
  for (double x = -700; x < 700; x += 0.37) EXPECT_NEAR(portable_exp(x) / std::exp(x), 1, 1e-15) << x;
  for (double x = 1e-300; x < 1e300; x *= 1.7)
    EXPECT_NEAR(portable_log2(x), std::log2(x), 1e-15 * std::max(1.0, std::abs(std::log2(x)))) << x;
  EXPECT_EQ(portable_log2(0x1p-1060), -1060);
  EXPECT_EQ(portable_log2(1024), 10);
  EXPECT_EQ(portable_exp(0), 1);
  EXPECT_EQ(portable_exp(-1e9), 0);
  EXPECT_TRUE(std::isnan(portable_exp(std::nan(""))));
  EXPECT_TRUE(std::isnan(portable_log2(-1)));
  EXPECT_NEAR(portable_pow(0.3, 2.2), std::pow(0.3, 2.2), 1e-15);
}

}  // namespace
}  // namespace vestige
