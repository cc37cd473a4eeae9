// Names of people are one short line of UTF-8.

#include "traces/scene/person_name.hpp"

#include <gtest/gtest.h>

namespace vestige {
namespace {

TEST(PersonName, IsOneShortLineOfUtf8) {
  EXPECT_EQ(name_fault(""), "");
  EXPECT_EQ(name_fault("Zoë"), "");
  EXPECT_EQ(name_fault(std::string(kMostNameBytes, 'x')), "");
  EXPECT_EQ(name_fault(std::string(kMostNameBytes + 1, 'x')), "is longer than 100 bytes");
  EXPECT_EQ(name_fault("a\nb"), "has a control character");
  EXPECT_EQ(name_fault(std::string_view("a\0b", 3)), "has a control character");
  EXPECT_EQ(name_fault("a\u0085b"), "has a control character");
  EXPECT_EQ(name_fault("a\u2028b"), "has a control character");
  EXPECT_EQ(name_fault("  "), "is blank");
  EXPECT_EQ(name_fault("a\xff"), "is not UTF-8");
}

TEST(PersonName, OfAnotherProgramIsMadeReadable) {
  EXPECT_EQ(readable_name("Zoë"), "Zoë");
  EXPECT_EQ(readable_name("a\tb\xff"), "a b\uFFFD");
  EXPECT_EQ(readable_name("a\u2028b"), "a b");
  // Cut between characters: "ë" has two bytes.
  EXPECT_EQ(readable_name(std::string(kMostNameBytes - 1, 'x') + "ë"), std::string(kMostNameBytes - 1, 'x'));
}

TEST(PersonName, OfSeveralPeopleIsEachAnother) {
  const std::vector<std::string> recorded = {"Ann", "", "Ann", "person 3"};
  EXPECT_EQ(names_of_people(recorded), (std::vector<std::string>{"Ann", "person 2", "person 3*", "person 3"}));
  EXPECT_EQ(names_of_people({""}), std::vector<std::string>{""});
}

}  // namespace
}  // namespace vestige
