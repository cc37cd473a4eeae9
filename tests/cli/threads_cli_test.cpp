// Verbs whose threads share data. ThreadSanitizer watches the program in these tests (.ci/thorough): a race makes its
// exit code 66.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/maps/batch_command_line.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/osc.hpp"
#include "tests/support/udp.hpp"

namespace vestige {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

#ifdef VESTIGE_SANITIZED
constexpr const char* kSeconds = "0.3";  // an exact detector takes long there
constexpr int kMostThreads = 16;         // and threads by the hundred
#else
constexpr const char* kSeconds = "2";
constexpr int kMostThreads = 256;
#endif

using BatchCommandLine = test::BatchCommandLine;
class ThreadsFlag : public test::CommandLineTest {};
class LiveRing : public test::CommandLineTest {};

TEST_F(ThreadsFlag, ThreadsChangeNoBitOfAnyResult) {
  ASSERT_EQ(run(fmt::format("vestige record -q --count 30 --rate 120 --duration {} -o trace.mcap", kSeconds)).exit_code,
            0);
  for (const std::string detector : {"cpu", "exact", "geometry", "compute"}) {
    for (const std::string threads : {"1", "3"})
      ASSERT_EQ(run("vestige replay -q trace.mcap --force --detector " + detector + " --threads " + threads +
                    " --contacts contacts" + threads + ".csv --timeline timeline" + threads + ".csv --json run" +
                    threads + ".json")
                    .exit_code,
                0);
    EXPECT_EQ(run("cmp contacts1.csv contacts3.csv && cmp timeline1.csv timeline3.csv").exit_code, 0) << detector;
    const nlohmann::json one = json_of("cat run1.json");
    const nlohmann::json three = json_of("cat run3.json");
    for (const char* field :
         {"texture_hash", "frames", "frames_skipped", "contacts", "unsure", "pairs_tested", "actuators"})
      EXPECT_EQ(one[field], three[field]) << detector << " " << field;
    EXPECT_EQ(three["threads"], 3);
    EXPECT_GT(three["contacts"], 0);
  }
}

/// What a replay wrote, and what it counted.
struct Replayed {
  std::string files;  ///< hashes of contacts and timelines
  nlohmann::json counts;
};

class RunsOfFrames : public test::CommandLineTest {
 protected:
  /// `flags` are those of the detector.
  Replayed replay(const std::string& trace, const std::string& flags, int threads) {
    const test::Outcome outcome = run(fmt::format(
        "rm -rf out && mkdir out && vestige replay -q --force {} {} --threads {} --contacts out/contacts.csv "
        "--timeline out/timeline.csv --json run.json && sha256sum out/*",
        trace, flags, threads));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    Replayed replayed = {outcome.standard_output, json_of("cat run.json")};
    for (const char* field : {"argv", "time", "threads", "reading_s", "detection_s", "hz"})
      replayed.counts.erase(field);
    return replayed;
  }

  void expect_same_with_any_threads(const std::string& trace, const std::string& flags) {
    const Replayed one = replay(trace, flags, 1);
    EXPECT_GT(one.counts["contacts"], 0) << flags;
    for (const int threads : {2, 3, 7}) {
      const Replayed several = replay(trace, flags, threads);
      EXPECT_EQ(several.files, one.files) << flags << " " << threads;
      EXPECT_EQ(several.counts, one.counts) << flags << " " << threads;
    }
  }
};

// At 1 kHz, what a frame found apart is not looked at again in the next.
TEST_F(RunsOfFrames, ThreadsChangeNoWorkEither) {
  ASSERT_EQ(run(fmt::format("vestige record -q --animation walk --colliders hug --count 20 --rate 1000 --duration {} "
                            "-o trace.mcap",
                            kSeconds))
                .exit_code,
            0);
  for (const char* method : {"static", "carried", "ccd"})
    expect_same_with_any_threads("trace.mcap", fmt::format("--detector cpu --method {}", method));
}

TEST_F(RunsOfFrames, ThreadsChangeNoWorkOfSeveralPeople) {
  ASSERT_EQ(run(fmt::format("vestige record -q --avatar builtin --avatar builtin --at 1,0,0 --colliders swarm "
                            "--count 40 --rate 1000 --duration {} -o trace.mcap",
                            kSeconds))
                .exit_code,
            0);
  expect_same_with_any_threads("trace.mcap", "--detector cpu");
}

TEST_F(RunsOfFrames, AreCutWhereADamagedChunkIsMissing) {
  ASSERT_EQ(run("vestige record -q --colliders hug --count 20 --rate 1000 --duration 0.8 -o trace.mcap").exit_code, 0);
  ASSERT_EQ(run("python3 -c \"d=bytearray(open('trace.mcap','rb').read()); h=len(d)//2; d[h:h+64]=bytes(64); "
                "open('damaged.mcap','wb').write(d)\"")
                .exit_code,
            0);
  const std::string command = "vestige replay damaged.mcap --force --contacts contacts{0}.csv --threads {0}";
  const test::Outcome one = run(fmt::format(fmt::runtime(command), 1));
  EXPECT_EQ(one.exit_code, 3);
  for (const int threads : {2, 7}) {
    const test::Outcome several = run(fmt::format(fmt::runtime(command), threads));
    EXPECT_EQ(several.exit_code, one.exit_code);
    EXPECT_EQ(several.standard_error, one.standard_error);
    EXPECT_EQ(run(fmt::format("cmp contacts1.csv contacts{}.csv", threads)).exit_code, 0);
  }
}

TEST_F(RunsOfFrames, EndWithTheSameErrorOnAFullDisk) {
  ASSERT_EQ(
      run(fmt::format("vestige record -q --colliders hug --count 50 --rate 1000 --duration {} -o trace.mcap", kSeconds))
          .exit_code,
      0);
  for (const char* file : {"--contacts", "--timeline"}) {
    const std::string command = fmt::format("timeout 60 vestige replay -q trace.mcap {} /dev/full --threads ", file);
    const test::Outcome one = run(command + "1");
    EXPECT_EQ(one.exit_code, 1);
    EXPECT_THAT(one.standard_error, HasSubstr("No space left"));
    for (const char* threads : {"2", "7"}) {
      const test::Outcome several = run(command + threads);
      EXPECT_EQ(several.exit_code, one.exit_code) << file;
      EXPECT_EQ(several.standard_error, one.standard_error) << file;
    }
  }
}

TEST_F(ThreadsFlag, WithoutItFilesTakeAllCoresAndAFrequencyTakesOne) {
  ASSERT_EQ(run("vestige record -q --count 5 --rate 100 --duration 0.2 -o trace.mcap").exit_code, 0);
  const auto threads = [&](const std::string& flags) {
    return json_of("vestige replay trace.mcap --force --json - " + flags)["threads"].get<unsigned>();
  };
  const unsigned cores = std::min(256U, std::thread::hardware_concurrency());
  EXPECT_EQ(threads(""), 1U);
  for (const char* file : {"--contacts out.csv", "--timeline out.csv", "--textures out.exr"})
    EXPECT_EQ(threads(file), cores) << file;
  EXPECT_EQ(threads("--detector geometry --contacts out.csv"), 1U);
  EXPECT_EQ(threads("--contacts out.csv --verify geometry"), 1U);
  EXPECT_THAT(run("vestige replay trace.mcap --force --contacts out.csv").standard_output,
              HasSubstr(fmt::format("Hz (threads: {})\n", cores)));
}

TEST_F(ThreadsFlag, AComparisonRunsOnThemToo) {
  ASSERT_EQ(run(fmt::format("vestige record -q --count 30 --rate 120 --duration {} -o trace.mcap", kSeconds)).exit_code,
            0);
  const test::Outcome same = run("vestige replay trace.mcap --threads 2 --verify exact");
  EXPECT_EQ(same.exit_code, 0) << same.standard_error;
  EXPECT_THAT(same.standard_output, HasSubstr("verify against exact: 0 contacts differ"));
}

TEST_F(ThreadsFlag, ATraceThatContradictsItselfMidwayEndsWithItsErrorAndNotWithAHang) {
  ASSERT_EQ(run("vestige record -q --compression none --count 5 --rate 100 --duration 2 -o trace.mcap").exit_code, 0);
  // Behind the first half of the file, all of it from the first quarter on: its frames run back in time.
  ASSERT_EQ(
      run("python3 -c \"d=open('trace.mcap','rb').read(); h=len(d)//2; open('twice.mcap','wb').write(d[:h]+d[h//2:])\"")
          .exit_code,
      0);
  const test::Outcome one = run("timeout 60 vestige replay twice.mcap");
  const test::Outcome four = run("timeout 60 vestige replay twice.mcap --threads 4");
  EXPECT_EQ(four.exit_code, one.exit_code);
  EXPECT_NE(four.exit_code, 0);
  EXPECT_NE(four.exit_code, 124);
  EXPECT_EQ(four.standard_error, one.standard_error);
}

TEST_F(ThreadsFlag, AsManyAsAMachineCouldHaveAreTakenAndNoOthers) {
  ASSERT_EQ(run("vestige record -q --count 2 --rate 60 --duration 0.2 -o trace.mcap").exit_code, 0);
  EXPECT_EQ(run(fmt::format("vestige replay trace.mcap --threads {}", kMostThreads)).exit_code, 0);
  EXPECT_EQ(run("vestige replay trace.mcap --threads 0").exit_code, 2);
  EXPECT_EQ(run("vestige replay trace.mcap --threads 257").exit_code, 2);
}

TEST_F(BatchCommandLine, IsTheSameBytesWhateverTheJobs) {
  record({"a.mcap", "b.mcap", "c.mcap"});
  const std::string command = "vestige batch --maps builtin paper6 --traces a.mcap b.mcap c.mcap ";
  ASSERT_EQ(run(command + "--jobs 1 -o one").exit_code, 0);
  ASSERT_EQ(run(command + "--jobs 2 -o two").exit_code, 0);
  expect_same_results("one", "two");
}

TEST_F(LiveRing, GivesASnapshotWhenAskedWhileDatagramsArrive) {
  const std::uint16_t port = test::free_udp_port();
  test::BackgroundProcess recorder({"vestige", "record", "--live", fmt::format("vmc://127.0.0.1:{}", port), "--rate",
                                    "100", "--ring", "60", "-o", (folder_ / "last.mcap").string()},
                                   folder_ / "error");
  const test::UdpSender sender(port);
  for (int i = 0; i < 3000 && !std::filesystem::exists(folder_ / "last-0001.mcap"); ++i) {
    sender.send(test::collider(5, 1, 2, 3));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    // Before it listens, the signal would end it.
    if (i % 50 == 49 && read_text_file(folder_ / "error").find("listening") != std::string::npos)
      recorder.signal(SIGUSR1);
  }
  recorder.signal(SIGTERM);
  EXPECT_THAT(recorder.wait(), AnyOf(0, 3)) << read_text_file(folder_ / "error");  // 3: frames came too late
  EXPECT_THAT(read_text_file(folder_ / "error"), HasSubstr("last-0001.mcap: the last "));
  const auto frames = [&](const char* trace) {
    return json_of(fmt::format("vestige replay {} --json -", (folder_ / trace).string()))["frames"].get<int>();
  };
  EXPECT_GT(frames("last-0001.mcap"), 0);
  EXPECT_GE(frames("last.mcap"), frames("last-0001.mcap"));
}

}  // namespace
}  // namespace vestige
