// Limbs as colliders, and people who touch each other, as a user records them.

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

class LimbsOfPeople : public test::CommandLineTest {
 protected:
  void record(const std::string& flags) const {
    const test::Outcome outcome = run("vestige record --rate 60 " + flags + " --force -o limbs.mcap");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    EXPECT_EQ(run("vestige doctor limbs.mcap").exit_code, 0);
  }

  /// The colliders of the trace's first frame.
  std::vector<ColliderSample> first_colliders() const {
    TraceReader reader(folder_ / "limbs.mcap", People::kSeveral);
    TraceFrame frame;
    EXPECT_TRUE(reader.next(frame));
    return frame.colliders;
  }
};

TEST_F(LimbsOfPeople, BelongToTheirPersonAndFollowTheOtherIds) {
  record("--duration 0.2 --avatar builtin --limbs hand_left,hand_right --avatar builtin --at 0,0,2,180 --limbs head");
  std::size_t of_first = 0;
  std::uint32_t id = 0;
  for (const ColliderSample& collider : first_colliders()) {
    EXPECT_EQ(collider.id, id++) << "no other collider by default";
    EXPECT_TRUE(collider.owner == 1 || collider.owner == 2);
    of_first += collider.owner == 1 ? 1U : 0U;
  }
  EXPECT_GE(of_first, 2U);
  EXPECT_GT(id, of_first);
  record("--duration 0.2 --colliders rain --count 5 --avatar builtin --avatar builtin --at 0,0,2,180 --limbs head");
  const std::vector<ColliderSample> all = first_colliders();
  ASSERT_GT(all.size(), 5U);
  EXPECT_EQ(std::ranges::count(all, 0, &ColliderSample::owner), 5);
  std::set<std::uint32_t> ids;
  for (const ColliderSample& collider : all) {
    EXPECT_TRUE(ids.insert(collider.id).second) << collider.id;
    EXPECT_TRUE(collider.owner == 0 || collider.id >= 6) << "6: ids are dealt to two people";
  }
  write("far.csv", std::string("time_s,id,x,y,z\n0,700,0,0,0\n1,700,0,0,1\n"));
  record("--duration 0.2 --colliders far.csv --limbs head");
  EXPECT_EQ(first_colliders().back().id, 700 + first_colliders().size() - 1);
}

TEST_F(LimbsOfPeople, NeverTouchTheirOwnPerson) {
  record(
      "--duration 1 --avatar builtin --animation walk --limbs all --avatar builtin --animation walk --at 0,0,0.2 "
      "--limbs all");
  const test::Outcome outcome = run("vestige replay limbs.mcap --contacts c.csv --json r.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  std::map<std::uint32_t, int> owner_of;
  for (const ColliderSample& collider : first_colliders()) owner_of[collider.id] = collider.owner;
  std::istringstream csv(read_text_file(folder_ / "c.csv"));
  std::string line;
  std::getline(csv, line);
  std::size_t rows = 0;
  while (std::getline(csv, line)) {
    const auto second = line.find(',', line.find(',') + 1);
    EXPECT_NE(owner_of.at(static_cast<std::uint32_t>(std::stoul(line.substr(second + 1)))), line.back() - '0');
    ++rows;
  }
  EXPECT_GT(rows, 100U);
  for (const char* detector : {"cpu --skip off", "geometry", "geometry --skip off"})
    EXPECT_EQ(json_of(std::string("vestige replay limbs.mcap -q --json - --detector ") + detector)["texture_hash"],
              json_in("r.json")["texture_hash"])
        << detector;
}

TEST_F(LimbsOfPeople, PatAShoulderThreeTimes) {
  record("--duration 2 --colliders touch");
  EXPECT_THAT(run("vestige inspect limbs.mcap").standard_output, HasSubstr("'giver'"));
  run("vestige replay limbs.mcap --contacts c.csv");
  std::istringstream csv(read_text_file(folder_ / "c.csv"));
  std::string line;
  std::getline(csv, line);
  std::size_t pats = 0;
  int last = -100;
  while (std::getline(csv, line)) {
    EXPECT_EQ(line.back(), '2') << "the receiver is touched";
    const int frame = std::stoi(line);
    if (frame > last + 3) ++pats;
    last = frame;
    std::vector<std::string> values;
    std::istringstream row(line);
    for (std::string value; std::getline(row, value, ',');) values.push_back(value);
    EXPECT_GT(std::stod(values[12]), 1.3) << "as high as a shoulder";
    EXPECT_LT(std::stod(values[14]), 0.03) << "a pat, and no stab";
  }
  EXPECT_EQ(pats, 3U);
}

TEST_F(LimbsOfPeople, WhatCannotBeIsRefused) {
  const std::string record = "vestige record -o a.mcap ";
  expect_failure(record + "--limbs tail", 2, {"--limbs", "there is no limb 'tail'", "hand_left"}, "a.mcap");
  expect_failure(record + "--limbs head,head", 2, {"--limbs", "'head' stands there twice"}, "a.mcap");
  expect_failure(record + "--limbs head --limbs torso", 2, {"--limbs", "is given twice"}, "a.mcap");
  expect_failure(record + "--limbs head --live -", 2, {"--limbs", "their own limbs never touch"}, "a.mcap");
  expect_failure(record + "--colliders touch --avatar builtin", 2, {"--avatar", "brings its own people"}, "a.mcap");
  expect_failure(record + "--colliders touch --count 3", 2, {"--count"}, "a.mcap");
  write("box.csv", std::string("time_s,id,x,y,z\n0,4294967295,0,0,0\n1,4294967295,0,0,1\n"));
  expect_failure(record + "--colliders box.csv --limbs head", 1, {"--limbs", "4294967295"}, "a.mcap");
}

}  // namespace
}  // namespace vestige
