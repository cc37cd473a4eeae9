// Unpacks the Debian packages and runs what is in them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kPackages = VESTIGE_PACKAGE_DIR;

class Packages : public test::CommandLineTest {
 protected:
  void SetUp() override {
    if (run("ls " + package("vestige-plot")).exit_code != 0)
      GTEST_SKIP() << "BUILT WITHOUT VTK: THE PACKAGES WERE NOT TESTED";
  }
  static std::string package(const std::string& name) { return "'" + kPackages + "'/" + name + "_*_amd64.deb"; }
  std::string field(const std::string& name, const std::string& what) const {
    return run("dpkg-deb -f " + package(name) + " " + what).standard_output;
  }
};

TEST_F(Packages, RunWhereTheyAreUnpackedAndFindEachOther) {
  ASSERT_EQ(run("dpkg-deb -x " + package("vestige") + " r && dpkg-deb -x " + package("vestige-plot") + " r").exit_code,
            0);
  const std::string vestige = "PATH=/usr/bin:/bin r/usr/bin/vestige ";
  EXPECT_EQ(run(vestige + "--version").standard_output, run("vestige --version").standard_output);
  ASSERT_EQ(run(vestige + "record --count 20 --rate 60 --duration 1 -o t.mcap").exit_code, 0);
  ASSERT_EQ(run(vestige + "replay t.mcap --timeline a.csv").exit_code, 0);
  const test::Outcome plot = run(vestige + "plot timeline a.csv");
  EXPECT_EQ(plot.exit_code, 0) << plot.standard_error;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.svg"));
  const std::string share = "r/usr/share/";
  for (const char* file : {"man/man1/vestige.1.gz", "man/man1/vestige-replay.1.gz", "man/man1/vestige-plot.1.gz",
                           "bash-completion/completions/vestige", "zsh/vendor-completions/_vestige",
                           "fish/vendor_completions.d/vestige.fish", "doc/vestige/copyright",
                           "doc/vestige-plot/copyright", "doc/vestige/README.md"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / (share + file))) << file;
}

TEST_F(Packages, DependOnWhatTheProgramsNeedAndOnlyPlotOnVtk) {
  EXPECT_THAT(field("vestige", "Depends"),
              AllOf(HasSubstr("libopenexr"), HasSubstr("libzstd1"), Not(HasSubstr("vtk")), Not(HasSubstr("libgl1"))));
  EXPECT_THAT(field("vestige", "Recommends"), HasSubstr("libegl1"));
  EXPECT_THAT(field("vestige-plot", "Depends"),
              AllOf(HasSubstr("libvtk9"), HasSubstr("vestige (="), HasSubstr("fonts-")));
}

TEST_F(Packages, AreWhatLintianExpects) {
  if (run("command -v lintian").exit_code != 0) GTEST_SKIP() << "lintian IS NOT INSTALLED: NOTHING WAS CHECKED";
  // The project has no mail address of its own.
  const test::Outcome lint =
      run("lintian " + package("vestige") + " " + package("vestige-plot") + " 2>/dev/null | grep -v bogus-mail-host");
  EXPECT_EQ(lint.standard_output, "");
}

}  // namespace
}  // namespace vestige
