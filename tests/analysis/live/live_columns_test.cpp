// Columns for colliders that appear over time.

#include "analysis/live/live_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vestige {
namespace {

using ::testing::ElementsAre;

class Columns : public ::testing::Test {
 protected:
  /// Numbers a frame with these colliders.
  bool number(const std::vector<std::uint32_t>& ids, double time_s) {
    TraceFrame frame;
    frame.time_ns = static_cast<std::int64_t>(time_s * 1e9);
    for (const std::uint32_t id : ids) frame.colliders.push_back({.id = id});
    frame.teleported = teleported_;
    return columns_.number(frame, out_);
  }

  std::vector<std::uint32_t> numbers() const {
    std::vector<std::uint32_t> numbers;
    for (const ColliderSample& collider : out_.colliders) numbers.push_back(collider.id);
    return numbers;
  }

  LiveColumns columns_;
  TraceFrame out_;
  std::vector<std::uint32_t> teleported_;
};

TEST_F(Columns, StayWithTheirCollidersWhoeverComesBetween) {
  number({7, 4'000'000'000}, 0);
  EXPECT_THAT(numbers(), ElementsAre(0U, 1U));
  teleported_ = {7, 99};
  number({3, 7}, 0.1);
  EXPECT_THAT(numbers(), ElementsAre(2U, 0U));
  EXPECT_THAT(out_.teleported, ElementsAre(0U)) << "nobody has the id 99";
  EXPECT_EQ(columns_.ids()[1], 4'000'000'000);
  EXPECT_EQ(columns_.seen(), 3U);
}

TEST_F(Columns, GrowWhenTheyAreAllTaken) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 1000; columns_.columns().size() > ids.size(); ++id) ids.push_back(id);
  EXPECT_FALSE(number(ids, 0));
  ids.push_back(5);
  EXPECT_TRUE(number(ids, 0.1)) << "more columns";
  EXPECT_EQ(numbers().front(), 0U) << "the others keep theirs";
  EXPECT_EQ(numbers().back(), ids.size() - 1);
  EXPECT_EQ(columns_.columns().back(), columns_.columns().size() - 1);
}

TEST_F(Columns, OfThoseWhoAreGoneForLongAreUsedAgain) {
  const std::size_t size = columns_.columns().size();
  for (std::uint32_t id = 0; id < 100 * size; ++id) EXPECT_FALSE(number({id}, id * 20.0 / static_cast<double>(size)));
  EXPECT_EQ(columns_.columns().size(), size) << "a stream of new ids needs no more memory";
  EXPECT_EQ(columns_.seen(), 100 * size);
}

}  // namespace
}  // namespace vestige
