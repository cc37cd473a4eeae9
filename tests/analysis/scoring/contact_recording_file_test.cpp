#include "analysis/scoring/contact_recording_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/message_of.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

class ContactRecordingFile : public ::testing::Test {
 protected:
  ContactRecordingFile() {
    for (std::uint32_t i = 0; i < 4; ++i) {
      Contact contact;
      contact.triangle = 10 + i;
      contact.t = 0.25F;
      contact.depth_m = 0.1 / (1 + i);
      recorded_.contacts.add(0.1 * i, i == 1 ? ContactRow(2) : ContactRow{contact, contact});
    }
    recorded_.collider_ids = {3, 8};
    recorded_.shape = ColliderShape::kSpheres;
  }
  ~ContactRecordingFile() override { std::filesystem::remove(path_); }

  RecordedTrace written_and_read() const {
    write_contact_recording(path_, recorded_);
    return read_contact_recording(path_);
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() /
       (std::string("vestige-recording-") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv"))
          .string();
  RecordedTrace recorded_;
};

TEST_F(ContactRecordingFile, ReadsBackDepths) {
  const RecordedTrace read = written_and_read();
  EXPECT_EQ(read.shape, ColliderShape::kSpheres);
  EXPECT_TRUE(read.covered.empty());
  ASSERT_EQ(read.contacts.contacts.size(), 6U);
  EXPECT_EQ(read.contacts.frames(), 4U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(read.contacts.contacts[i].depth_m, recorded_.contacts.contacts[i].depth_m);
}

TEST_F(ContactRecordingFile, ReadsBackWhatSpheresCover) {
  recorded_.covered["front"] = {{0, 2, 2, 3, 3, 3, 4}, {{0, 0.01}, {4, 1.0 / 3}, {2, 5e-9}, {1, 0.5}}};
  recorded_.covered["vest-40"] = {{0, 0, 1, 1, 1, 1, 1}, {{39, 0.125}}};
  const RecordedTrace read = written_and_read();
  ASSERT_EQ(read.covered.size(), 2U);
  for (const auto& [map, places] : recorded_.covered)
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_THAT(read.covered.at(map).of(i), ::testing::ElementsAreArray(places.of(i))) << map << ", contact " << i;
}

TEST_F(ContactRecordingFile, RefusesWhatIsNoListOfCoveredPlaces) {
  recorded_.covered["front"] = {{0, 1, 1, 1, 1, 1, 1}, {{0, 0.25}}};
  write_contact_recording(path_, recorded_);
  const std::string text = read_text_file(path_);
  const std::size_t place = text.find("front:1:0.25");
  ASSERT_NE(place, std::string::npos);
  for (const char* bad : {"front", "front:1", "front:0:0.25", "front:1:0", "front:1:-1", "front:1:nan", "front:x:0.25",
                          ":1:0.25x", "1:0.25", "front:1:0.25,"}) {
    std::ofstream(path_) << std::string(text).replace(place, 12, bad);
    EXPECT_THAT(test::message_of([&] { read_contact_recording(path_); }), HasSubstr("line 2")) << bad;
  }
}

}  // namespace
}  // namespace vestige
