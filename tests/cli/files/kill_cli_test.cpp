// A recorder that is killed at any instant leaves a trace that opens, and loses what it was just putting together.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>

#include "tests/support/background_process.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/long.hpp"
#include "tests/support/npm.hpp"
#include "traces/base/error.hpp"
#include "traces/files/output_file.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/repair/recover.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using Clock = std::chrono::steady_clock;

/// What VESTIGE_KILLS says (the target kill_a_thousand_recorders says 1000), otherwise 50 in long tests and 10 in
/// others.
int kills() {
  const char* text = std::getenv("VESTIGE_KILLS");
  if (text != nullptr) return std::atoi(text);
  return test::is_long() ? 50 : 10;
}

class Kill : public test::CommandLineTest {
 protected:
  /// How many frames are in a trace that nobody finished: all before the end, each the one behind the last.
  static std::uint64_t frames_in(const std::filesystem::path& path) {
    TraceReader reader(path);
    TraceFrame frame;
    std::uint64_t frames = 0;
    while (reader.next(frame)) EXPECT_EQ(frame.index, frames++);
    EXPECT_FALSE(reader.complete());
    return frames;
  }

  /// What stands behind the last whole chunk: less than a chunk.
  static std::uint64_t bytes_behind_chunks(const std::filesystem::path& path) {
    const mcap::FileSource source(path);
    mcap::RecordWalker walker(source);
    mcap::RecordPlace place;
    std::uint64_t end = 0;
    while (walker.next(place)) end = place.end();
    return source.size() - end;
  }

  static void recover(const std::filesystem::path& from, const std::filesystem::path& to) {
    const mcap::FileSource source(from);
    OutputFile file(to, Overwrite::kRefuse);
    recover_mcap(
        source, [&](mcap::Bytes bytes) { file.write(bytes); }, [](double) { return true; });
    file.commit();
  }
};

TEST_F(Kill, AtAnyInstantLosesLessThanAChunkAndWhatIsLeftCanBeRecovered) {
  VESTIGE_REQUIRE_DATA(test::npm_package("@mcap/core"));
  constexpr std::uint64_t kMostChunkBytes = (std::uint64_t{1} << 20) + (std::uint64_t{64} << 10);
  constexpr int kBatch = 50;
  std::mt19937_64 random(20261122);
  std::uniform_int_distribution<int> delay_us(0, 400'000);
  const auto trace = folder_ / "killed.mcap";
  const auto mended = folder_ / "mended";
  int nothing_yet = 0;
  int opened = 0;
  std::uint64_t most_behind = 0;
  for (int first = 0; first < kills(); first += kBatch) {
    std::filesystem::create_directory(mended);
    std::map<std::string, std::uint64_t> expected;
    for (int i = first; i < std::min(kills(), first + kBatch); ++i) {
      {
        const char* const compression = i % 2 == 0 ? "none" : "zstd";  // the reference library has no lz4 of its own
        test::BackgroundProcess recorder(
            {"vestige", "record", "--duration", "1000", "--compression", compression, "-q", "-o", trace.string()},
            folder_ / "error");
        std::this_thread::sleep_for(std::chrono::microseconds(delay_us(random)));
        recorder.signal(SIGKILL);
        ASSERT_EQ(recorder.wait(), 128 + SIGKILL);
      }
      if (!std::filesystem::exists(trace)) {
        ++nothing_yet;
        continue;
      }
      try {
        const std::uint64_t frames = frames_in(trace);
        ++opened;
        const std::uint64_t behind = bytes_behind_chunks(trace);
        most_behind = std::max(most_behind, behind);
        EXPECT_LT(behind, kMostChunkBytes);
        const std::string name = fmt::format("{}.mcap", i);
        recover(trace, mended / name);
        expected[name] = frames;
      } catch (const Error& error) {
        // It was killed while the head was being written, before there was any frame to lose.
        EXPECT_LT(std::filesystem::file_size(trace), 400'000U) << error.what();
        ++nothing_yet;
      }
      std::filesystem::remove(trace);
    }
    const auto seen = nlohmann::json::parse(test::run_node("open_traces.mjs", mended));
    EXPECT_EQ(seen.size(), expected.size());
    // Of the chunk that was being written, recovering keeps what reading passes over.
    for (const auto& [name, frames] : expected) EXPECT_GE(seen.value(name, std::uint64_t{0}), frames) << name;
    std::filesystem::remove_all(mended);
  }
  EXPECT_GT(opened, 0);
  fmt::print("{} killed: {} had no frame yet, {} opened; at most {} bytes of an unfinished chunk\n", kills(),
             nothing_yet, opened, most_behind);
}

/// How much time is lost, seen from outside: frames come in at their own pace, and are counted when they are handed
/// over. What the recorder had not even taken out of the pipe, since it had no processor just then, it did not lose.
TEST_F(Kill, AtAnyInstantLosesAFewMilliseconds) {
  constexpr std::chrono::milliseconds kPeriod(2);
  constexpr int kFrameBytes = 3;
  std::mt19937_64 random(8);
  std::uniform_int_distribution<int> delay_ms(0, 500);
  std::vector<double> lost_ms;
  for (int i = 0; i < kills() / 5; ++i) {
    const auto trace = folder_ / fmt::format("{}.mcap", i);
    const auto pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::vector<Clock::time_point> handed_over;
    {
      test::BackgroundProcess recorder({"sh", "-c",
                                        fmt::format("exec '{}/vestige' record --live - -q -o '{}' < '{}'",
                                                    VESTIGE_BIN_DIR, trace.string(), pipe.string())},
                                       folder_ / "error", "/bin");
      const int input = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
      ASSERT_GE(input, 0);
      const auto start = Clock::now();
      Clock::time_point end = start + std::chrono::hours(1);
      // The first frames wait until the recorder has begun.
      for (int frame = 0; Clock::now() < end; ++frame) {
        std::this_thread::sleep_until(start + frame * kPeriod);
        handed_over.push_back(Clock::now());
        ASSERT_EQ(::write(input, "{}\n", kFrameBytes), kFrameBytes);
        if (frame % 16 == 0 && end > start + std::chrono::minutes(30) && std::filesystem::exists(trace) &&
            std::filesystem::file_size(trace) > 0)
          end = Clock::now() + std::chrono::milliseconds(200 + delay_ms(random));
      }
      recorder.signal(SIGKILL);
      recorder.wait();
      int left_bytes = 0;
      ASSERT_EQ(::ioctl(input, FIONREAD, &left_bytes), 0);
      ::close(input);
      handed_over.resize(handed_over.size() - static_cast<std::size_t>(left_bytes / kFrameBytes));
      std::uint64_t kept = 0;
      try {
        kept = frames_in(trace);
      } catch (const Error&) {
        // Not even the head was there.
        kept = 0;
      }
      ASSERT_LE(kept, handed_over.size());
      lost_ms.push_back(
          kept == handed_over.size()
              ? 0
              : std::chrono::duration<double, std::milli>(handed_over.back() - handed_over[kept]).count());
    }
    std::filesystem::remove(trace);
    std::filesystem::remove(pipe);
  }
  std::sort(lost_ms.begin(), lost_ms.end());
  fmt::print("{} killed: lost {:.0f} ms in the middle, {:.0f} ms at most, {} times more than 100 ms\n", lost_ms.size(),
             lost_ms[lost_ms.size() / 2], lost_ms.back(),
             std::count_if(lost_ms.begin(), lost_ms.end(), [](double ms) { return ms > 100; }));
}

}  // namespace
}  // namespace vestige
