// What is left where a recorder was killed, a disk was full or a file was there before, and what goes through pipes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using test::kColliders;
using test::kNodes;
using test::message_of;
using ::testing::HasSubstr;

std::vector<std::string> entries_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(TraceFile, RefusesToOverwriteUnlessAllowed) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.mcap") << "precious";
  EXPECT_THAT(message_of([&] { test::write_trace(folder / "a.mcap", 1, test::steady_options()); }),
              HasSubstr("--force"));
  EXPECT_EQ(read_text_file(folder / "a.mcap"), "precious");
  TraceWriterOptions allowed = test::steady_options();
  allowed.overwrite = Overwrite::kAllow;
  test::write_trace(folder / "a.mcap", 1, allowed);
  TraceReader reader(folder / "a.mcap");
  EXPECT_TRUE(reader.complete());
  EXPECT_THAT(entries_in(folder.path()), ::testing::ElementsAre("a.mcap"));
}

TEST(TraceFile, WithoutFinishIsReadableToTheLastFrame) {
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(kNodes);
  {
    TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}},
                       test::steady_options(1000));
    for (std::uint64_t i = 0; i < 20; ++i) writer.write(test::frame(i, kNodes, kColliders));
  }
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(test::read_frames(reader).size(), 20U);
  EXPECT_FALSE(reader.complete());
  ASSERT_EQ(reader.warnings().size(), 1U);
  EXPECT_THAT(reader.warnings()[0], HasSubstr("without a footer"));
}

TEST(TraceFile, LeavesNothingBehindWhenNoFrameWasWritten) {
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(kNodes);
  {
    const TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}},
                             test::steady_options());
    EXPECT_TRUE(std::filesystem::exists(folder / "a.mcap"));
  }
  EXPECT_TRUE(entries_in(folder.path()).empty());
}

/// Runs `body` in a child process, which exits with what it returns; gives back waitpid's status.
template <typename Body>
int status_of_child(Body body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

/// Writes frames until the file may not grow any more; returns the error's message through `path`.message.
int record_until_full(const std::filesystem::path& path, rlim_t limit_bytes, Overwrite overwrite) {
  return status_of_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {limit_bytes, limit_bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = message_of([&] {
      const auto glb = test::skeleton_glb(kNodes);
      TraceWriterOptions options = test::steady_options(2000);
      options.overwrite = overwrite;
      TraceWriter writer(path, {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, options);
      for (std::uint64_t i = 0; i < 10000; ++i) writer.write(test::frame(i, kNodes, kColliders));
      writer.finish();
    });
    std::ofstream(path.string() + ".message") << message;
    return 0;
  });
}

TEST(TraceFile, KeepsWhatWasWrittenWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(record_until_full(folder / "a.mcap", 50'000, Overwrite::kRefuse), 0);
  const std::string message = read_text_file(folder / "a.mcap.message");
  EXPECT_THAT(message, HasSubstr("a.mcap: could not write"));
  EXPECT_THAT(message, HasSubstr("a.mcap.partial"));
  EXPECT_THAT(entries_in(folder.path()), ::testing::ElementsAre("a.mcap.message", "a.mcap.partial"));
  TraceReader reader(folder / "a.mcap.partial");
  const auto frames = test::read_frames(reader);
  EXPECT_GT(frames.size(), 50U);
  EXPECT_TRUE(test::same_bits(frames.back(), test::frame(frames.back().index, kNodes, kColliders)));
  EXPECT_FALSE(reader.complete());

  // A second failure does not replace what the first one kept.
  ASSERT_EQ(record_until_full(folder / "a.mcap", 50'000, Overwrite::kRefuse), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "a.mcap.partial-2"));
}

TEST(TraceFile, LosesNothingWhenTheDiskIsFullAtTheStart) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(record_until_full(folder / "a.mcap", 500, Overwrite::kRefuse), 0);
  EXPECT_THAT(entries_in(folder.path()), ::testing::ElementsAre("a.mcap.message"));
  std::ofstream(folder / "a.mcap") << "precious";
  ASSERT_EQ(record_until_full(folder / "a.mcap", 500, Overwrite::kAllow), 0);
  EXPECT_EQ(read_text_file(folder / "a.mcap"), "precious");
  EXPECT_THAT(entries_in(folder.path()), ::testing::ElementsAre("a.mcap", "a.mcap.message"));
}

TEST(TraceFile, ReportsADeviceWithoutRoom) {
  EXPECT_THAT(message_of([] { test::write_trace("/dev/full", 1, {.overwrite = Overwrite::kAllow}); }),
              HasSubstr("/dev/full: could not write"));
}

TEST(TraceFile, OfAKilledRecorderLosesAtMostOneChunk) {
  const test::TemporaryFolder folder;
  int to_parent[2] = {};
  ASSERT_EQ(::pipe(to_parent), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto glb = test::skeleton_glb(kNodes);
    TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}},
                       test::steady_options(4000));
    for (std::uint64_t i = 0;; ++i) {
      writer.write(test::frame(i, kNodes, kColliders));
      if (::write(to_parent[1], &i, sizeof i) != sizeof i) ::_exit(1);
    }
  }
  ::close(to_parent[1]);
  std::uint64_t last = 0;
  while (last < 500) ASSERT_EQ(::read(to_parent[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  for (std::uint64_t more = 0; ::read(to_parent[0], &more, sizeof more) == sizeof more;) last = more;
  ::close(to_parent[0]);

  TraceReader reader(folder / "a.mcap");
  const auto frames = test::read_frames(reader);
  constexpr std::uint64_t kInAChunk = 10;  // a frame takes about 560 bytes of one
  EXPECT_GE(frames.size() + kInAChunk, last);
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_TRUE(test::same_bits(frames[i], test::frame(i, kNodes, kColliders))) << i;
  EXPECT_FALSE(reader.complete());
}

TEST(TraceFile, GoesThroughPipes) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "expected.mcap", 40, test::steady_options(3000));
  // One process records to standard output, the other reads standard input.
  int pipe_ends[2] = {};
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const pid_t recorder = ::fork();
  if (recorder == 0) {
    ::dup2(pipe_ends[1], STDOUT_FILENO);
    ::close(pipe_ends[0]);
    ::close(pipe_ends[1]);
    test::write_trace("-", 40, test::steady_options(3000));
    ::_exit(0);
  }
  ::close(pipe_ends[1]);  // else the reader would never see the end
  const int status = status_of_child([&] {
    ::dup2(pipe_ends[0], STDIN_FILENO);
    TraceReader reader("-");
    const bool good = test::read_frames(reader).size() == 40 && reader.frame_count() == 40 && reader.complete();
    return good ? 0 : 1;
  });
  ::close(pipe_ends[0]);
  int recorder_status = 0;
  ::waitpid(recorder, &recorder_status, 0);
  EXPECT_EQ(recorder_status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace vestige
