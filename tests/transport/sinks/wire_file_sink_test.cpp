#include "transport/sinks/wire_file_sink.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "transport/wire/vest_frame.hpp"

namespace vestige {
namespace {

using namespace std::string_literals;

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(WireFileSink, WritesTheBytesOfTheWire) {
  const test::TemporaryFolder folder;
  const auto path = folder / "frames";
  {
    WireFileSink sink(path, Overwrite::kRefuse, Quantity::kDuty, 20);
    EXPECT_EQ(sink.name(), path.string());
    sink.send({0, {255, 0}}, 7);
    sink.send_off(8);
    EXPECT_FALSE(std::filesystem::exists(path)) << "it is complete or absent";
    sink.commit();
    EXPECT_EQ(sink.bytes_sent(), std::filesystem::file_size(path));
  }
  const std::string frames = read_text_file(path);
  const std::vector<std::uint8_t> levels = {255, 0};
  EXPECT_EQ(frames, text_of(encode_state(Quantity::kDuty, levels, 7, 20)) + text_of(encode_off(8)));
  // COBS by hand: a zero follows after five bytes, S sequence ttl n 255, and is the second level.
  EXPECT_EQ(frames.substr(0, 6), "\x06S\x07\x14\x02\xff"s);
  EXPECT_EQ(frames.back(), '\0');
}

TEST(WireFileSink, WritesPressuresWhereTheLevelsAreThose) {
  const test::TemporaryFolder folder;
  WireFileSink sink(folder / "frames", Overwrite::kRefuse, Quantity::kPressure, 20);
  sink.send({0, {1, 2}}, 7);
  sink.commit();
  EXPECT_EQ(read_text_file(folder / "frames").substr(1, 6), "P\x07\x14\x02\x01\x02"s);
}

TEST(WireFileSink, LeavesNothingWithoutCommitAndOverwritesNothing) {
  const test::TemporaryFolder folder;
  WireFileSink(folder / "frames", Overwrite::kRefuse, Quantity::kDuty, 20).send({0, {1}}, 0);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  WireFileSink(folder / "frames", Overwrite::kRefuse, Quantity::kDuty, 20).commit();
  EXPECT_THROW(WireFileSink(folder / "frames", Overwrite::kRefuse, Quantity::kDuty, 20), Error);
}

TEST(WireFileSink, GivesAPipeEachFrameAtOnce) {
  const test::TemporaryFolder folder;
  const auto path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  WireFileSink sink(path, Overwrite::kRefuse, Quantity::kDuty, 20);
  char bytes[100];
  for (std::uint8_t sequence = 0; sequence < 3; ++sequence) {
    sink.send({0, {255}}, sequence);
    const auto expected = encode_state(Quantity::kDuty, std::vector<std::uint8_t>{255}, sequence, 20);
    const ssize_t size = ::read(reader, bytes, sizeof(bytes));
    ASSERT_EQ(size, static_cast<ssize_t>(expected.size()));
    EXPECT_EQ(std::string(bytes, bytes + size), text_of(expected));
  }
  ::close(reader);
}

TEST(WireFileSink, StandardOutputGetsEachFrameAtOnce) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(::pipe(ends), 0);
  const int standard_output = ::dup(STDOUT_FILENO);
  ::dup2(ends[1], STDOUT_FILENO);
  {
    WireFileSink sink("-", Overwrite::kRefuse, Quantity::kDuty, 20);
    sink.send_off(1);
  }
  ::dup2(standard_output, STDOUT_FILENO);
  ::close(standard_output);
  ::close(ends[1]);
  char bytes[100];
  const ssize_t size = ::read(ends[0], bytes, sizeof(bytes));
  ::close(ends[0]);
  EXPECT_EQ(size, static_cast<ssize_t>(encode_off(1).size()));
}

}  // namespace
}  // namespace vestige
