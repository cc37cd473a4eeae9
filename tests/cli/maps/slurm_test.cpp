// A batch as a Slurm job array, on a real Slurm: slurmctld, slurmd and munged of this machine, in a namespace of their
// own. One shard's program is killed in the middle; the merged result is the one of a batch run in one go.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

/// Under CI nothing may be left out.
bool is_ci() {
  const char* ci = std::getenv("CI");
  return ci != nullptr && std::string_view(ci) == "true";
}

class Slurm : public test::CommandLineTest {
 protected:
  void SetUp() override {
    std::string missing;
    if (::getuid() != 0) missing = "ROOT IS NEEDED TO START SLURM";
    if (run("command -v slurmctld slurmd sbatch munged python3").exit_code != 0)
      missing = "slurmctld, slurmd, slurm-client, munge OR python3 IS NOT INSTALLED";
    if (missing.empty() && run("unshare -u -p -f --kill-child --mount-proc hostname localhost").exit_code != 0)
      missing = "THIS SYSTEM GIVES NO NAMESPACES (unshare)";
    if (missing.empty()) return;
    if (is_ci()) FAIL() << missing;
    GTEST_SKIP() << missing << ": BATCHES ON SLURM WERE NOT TESTED";
  }

  /// munged and the jobs' accounts must be able to enter the folder.
  test::Outcome run_on_cluster(const std::string& script) const {
    return run(
        "cat >job.sh <<'JOB'\n" + script +
        "\nJOB\nmkdir cluster && chmod 755 . && timeout -s KILL 300 unshare -u -p -f --kill-child --mount-proc bash "
        "'" VESTIGE_SOURCE_DIR "/tests/cli/maps/slurm_cluster.sh' \"$PWD/cluster\" 'bash job.sh'");
  }
};

constexpr const char* kInputs =
    "--maps builtin --traces a.mcap b.mcap c.mcap d.mcap --laws binary,speed --detector exact";

TEST_F(Slurm, AKilledShardIsQueuedAgainAndTheMergedResultIsTheSame) {
  for (const char* name : {"a", "b", "c", "d"})
    ASSERT_EQ(run("vestige record --count 3 --rate 500 --duration 2 --seed " + std::to_string(*name) + " -o " + name +
                  ".mcap")
                  .exit_code,
              0);
  ASSERT_EQ(run(std::string("vestige batch ") + kInputs + " -o whole").exit_code, 0);
  ASSERT_EQ(run(std::string("vestige batch slurm --shards 2 ") + kInputs + " -o out >submit.sh").exit_code, 0);
  const test::Outcome outcome = run_on_cluster(R"job(
set -euo pipefail
# await SECONDS WHAT CONDITION
await() {
  local until=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    [ $SECONDS -lt $until ] || { echo "gave up waiting for $what" >&2; squeue >&2; tail -n 20 out/logs/* >&2; exit 1; }
    sleep 0.02
  done
}
# Lets the program of shard 2 run in steps of 20 ms until it has finished its first trace, so that it is killed at work on
# its second however busy the machine is. The shell around it has no such arguments.
killed_in_the_middle() {
  local worker
  worker=$(pgrep -f -- ' --shard 2/2 ') || return 1
  kill -STOP "$worker" || return 1
  while ! ls out/shards/2/items/*.json >/dev/null 2>&1; do
    kill -CONT "$worker" && sleep 0.02 && kill -STOP "$worker" || return 1
  done
  kill -KILL "$worker"
}
queue_is_empty() { [ -z "$(squeue -h)" ]; }

bash submit.sh
await 60 "shard 2 to be in its middle" killed_in_the_middle
await 200 "all jobs" queue_is_empty
scontrol -o show job
)job");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_output << outcome.standard_error;
  const std::string& jobs = outcome.standard_output;
  EXPECT_THAT(jobs, HasSubstr("Restarts=1")) << "the killed shard";
  EXPECT_THAT(jobs, ::testing::Not(HasSubstr("JobState=FAILED")));
  EXPECT_THAT(jobs, HasSubstr("JobName=vestige-merge"));
  EXPECT_THAT(read_text_file(folder_ / "out/logs/shard-2.log"), HasSubstr("ended with 137; queued again"));
  EXPECT_THAT(read_text_file(folder_ / "out/logs/shard-2.log"), HasSubstr("finished by an earlier run"));

  EXPECT_EQ(run("diff -r --exclude=run.json --exclude=times --exclude=.lock --exclude=shards --exclude=logs whole out")
                .standard_output,
            "");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/ranking.json"));
  const auto merged = nlohmann::json::parse(read_text_file(folder_ / "out/run.json"));
  EXPECT_EQ(merged["complete"], true);
  EXPECT_EQ(merged["merged"].size(), 2U);
  EXPECT_EQ(merged["traces"].size(), 4U);
}

}  // namespace
}  // namespace vestige
