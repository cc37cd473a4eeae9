#include "traces/files/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/files/append_file.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

std::size_t entries_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(OutputFile, IsAbsentUntilCommittedAndCompleteAfter) {
  const test::TemporaryFolder folder;
  OutputFile file(folder / "a.csv", Overwrite::kRefuse);
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
  file.commit();
  EXPECT_EQ(read_text_file(folder / "a.csv"), "hello");
  EXPECT_EQ(entries_in(folder.path()), 1U);
}

TEST(OutputFile, LeavesNothingBehindWhenDroppedWithoutCommit) {
  const test::TemporaryFolder folder;
  { OutputFile(folder / "a.csv", Overwrite::kRefuse).write("half"); }
  EXPECT_EQ(entries_in(folder.path()), 0U);
}

TEST(OutputFile, RefusesToOverwriteAndSaysHowTo) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.csv") << "precious";
  try {
    const OutputFile unwanted(folder / "a.csv", Overwrite::kRefuse);
    FAIL() << "overwrote";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("already exists"));
    EXPECT_THAT(error.what(), HasSubstr("--force"));
  }
  OutputFile allowed(folder / "a.csv", Overwrite::kAllow);
  allowed.write("new");
  allowed.commit();
  EXPECT_EQ(read_text_file(folder / "a.csv"), "new");
}

TEST(OutputFile, DoesNotReplaceAFileThatAppearedMeanwhile) {
  const test::TemporaryFolder folder;
  OutputFile file(folder / "a.csv", Overwrite::kRefuse);
  file.write("mine");
  std::ofstream(folder / "a.csv") << "theirs";
  EXPECT_THROW(file.commit(), Error);
  EXPECT_EQ(read_text_file(folder / "a.csv"), "theirs");
}

TEST(OutputFile, FollowsALinkAndLeavesItALink) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "real.csv") << "old";
  std::filesystem::create_symlink("real.csv", folder / "link.csv");
  EXPECT_THROW(OutputFile(folder / "link.csv", Overwrite::kRefuse), Error);
  OutputFile file(folder / "link.csv", Overwrite::kAllow);
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_EQ(read_text_file(folder / "real.csv"), "new");
  EXPECT_EQ(entries_in(folder.path()), 2U);
}

TEST(OutputFile, WritesWhatALinkLeadsToThoughItIsNotThere) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_symlink("data/real.csv", folder / "link.csv");
  OutputFile file(folder / "link.csv", Overwrite::kRefuse);
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_EQ(read_text_file(folder / "data/real.csv"), "new");
}

TEST(AppendFile, FollowsALinkAndLeavesItALink) {
  for (const bool is_there : {false, true}) {
    const test::TemporaryFolder folder;
    if (is_there) std::ofstream(folder / "real.mcap") << "old";
    std::filesystem::create_symlink("real.mcap", folder / "link.mcap");
    AppendFile file(folder / "link.mcap", is_there ? Overwrite::kAllow : Overwrite::kRefuse);
    file.write(std::as_bytes(std::span("new", 3)));
    file.keep();
    file.close();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.mcap"));
    EXPECT_EQ(read_text_file(folder / "real.mcap"), "new");
    EXPECT_EQ(entries_in(folder.path()), 2U);
  }
}

TEST(OutputFile, RefusesLinksInACircleAndFilesWithoutAName) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  EXPECT_THROW(refuse_overwrite(folder / "a", Overwrite::kAllow), Error);
  EXPECT_THROW(AppendFile(folder / "a", Overwrite::kAllow), Error);
  const int nameless = ::memfd_create("x", MFD_CLOEXEC);
  EXPECT_THROW(OutputFile("/proc/self/fd/" + std::to_string(nameless), Overwrite::kAllow), Error);
  ::close(nameless);
  EXPECT_EQ(entries_in(folder.path()), 2U);
}

TEST(OutputFile, IsRefusedBeforeTheWorkWhereNoFileMayBeMade) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  const test::TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(::seteuid(kNobody), 0);
  std::string message;
  try {
    refuse_overwrite(folder / "a", Overwrite::kRefuse);
  } catch (const Error& error) {
    message = error.what();
  }
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_THAT(message, HasSubstr("could not be written: Permission denied"));
  EXPECT_NO_THROW(refuse_overwrite(folder / "a", Overwrite::kRefuse));
}

TEST(OutputFile, ReportsAFullDisk) {
  OutputFile file("/dev/full", Overwrite::kAllow);
  file.write("x");
  try {
    file.commit();
    FAIL() << "wrote to a full disk";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/dev/full"));
    EXPECT_THAT(error.what(), HasSubstr("disk is full"));
  }
}

TEST(OutputFile, NamesAMissingFolder) {
  try {
    const OutputFile unwanted("/nowhere/at/all/a.csv", Overwrite::kRefuse);
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/at/all"));
  }
}

TEST(ReadFile, SaysWhatIsWrong) {
  EXPECT_THROW(read_file("/no/such/file"), Error);
  EXPECT_THROW(read_file("/tmp"), Error);
  EXPECT_THROW(read_file("/proc/self/exe", 10), Error);
}

}  // namespace
}  // namespace vestige
