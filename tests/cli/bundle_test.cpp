// Runs the bundle in a root that holds glibc and nothing else, and on this machine beside the program it was made of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kBundle = VESTIGE_BUNDLE_DIR;

/// All of glibc that a program needs to start.
constexpr const char* kGlibc =
    "/lib64/ld-linux-x86-64.so.2 /lib/x86_64-linux-gnu/libc.so.6 /lib/x86_64-linux-gnu/libm.so.6 "
    "/lib/x86_64-linux-gnu/libdl.so.2 /lib/x86_64-linux-gnu/libpthread.so.0";

/// What stands in bin/.
constexpr const char* kPrograms[] = {"vestige", "agreement", "geometry_agreement"};

class Bundle : public test::CommandLineTest {
 protected:
  /// Runs `measure --quick` of a copy of the bundle whose vestige is a shell script. It knows the real one as $real.
  test::Outcome measure_with(const std::string& script) const {
    EXPECT_EQ(run("cp -r '" + kBundle + "' b && mv b/bin/vestige b/bin/real").exit_code, 0);
    std::ofstream(folder_ / "b/bin/vestige") << "#!/bin/sh\nreal=$(dirname \"$0\")/real\n" << script;
    EXPECT_EQ(run("chmod +x b/bin/vestige").exit_code, 0);
    return run("b/measure --quick --pairs 2000 results");
  }
};

class BundleAlone : public Bundle {
 protected:
  void SetUp() override {
    const std::string root = (folder_ / "root").string();
    ASSERT_EQ(run("mkdir root && cp --parents -L " + std::string(kGlibc) + " root && cp -r '" + kBundle +
                  "' root/vestige && mkdir root/tmp root/proc")
                  .exit_code,
              0);
    const std::string with_proc =
        " sh -c 'mount --rbind /proc \"$0/proc\" && exec chroot \"$0\" \"$@\"' '" + root + "' ";
    const std::string plain = "chroot '" + root + "' ";
    // Where /proc cannot be had, the loader must be told by its command line where the program lies.
    const std::string loader = "/lib64/ld-linux-x86-64.so.2 ";
    const std::pair<std::string, std::string> ways[] = {{"unshare -m" + with_proc, ""},
                                                        {"unshare -rm" + with_proc, ""},
                                                        {plain, loader},
                                                        {"unshare -r " + plain, loader}};
    for (const auto& [enter, start] : ways) {
      enter_ = "env -i PATH=\"$PATH\" " + enter;
      bin_ = enter_ + start + "/vestige/bin/";
      vestige_ = bin_ + "vestige ";
      if (run(enter_ + loader + "--version").exit_code == 0) return;
    }
    if (std::getenv("CI") != nullptr) FAIL() << "neither chroot nor unshare works here";
    GTEST_SKIP() << "NEITHER chroot NOR unshare WORKS HERE; THE BUNDLE WAS NOT TESTED ALONE";
  }

  std::string enter_;
  std::string bin_;
  std::string vestige_;
};

TEST_F(BundleAlone, FindsEveryLibraryInItself) {
  for (const std::string program : kPrograms) {
    const test::Outcome list = run(enter_ + "/lib64/ld-linux-x86-64.so.2 --list /vestige/bin/" + program);
    EXPECT_EQ(list.exit_code, 0) << list.standard_error;
    EXPECT_THAT(list.standard_output, Not(HasSubstr("not found")));
    EXPECT_THAT(list.standard_output, HasSubstr("libstdc++.so.6 => /vestige/bin/../lib/fallback/"));
  }
}

TEST_F(BundleAlone, ComparesPairsOnTheCpuAndSaysThatThereIsNoOpenGl) {
  EXPECT_EQ(json_of(bin_ + "agreement --method static --pairs 1000")["total"]["differences"], 0);
  const test::Outcome geometry = run(bin_ + "geometry_agreement --pairs 1000");
  EXPECT_EQ(geometry.exit_code, 1);
  EXPECT_THAT(geometry.standard_error, HasSubstr("this machine offers no OpenGL 4.5 context"));
}

TEST_F(BundleAlone, RecordsReplaysOnTheCpuAndSaysThatThereIsNoOpenGl) {
  const test::Outcome recorded = run(vestige_ + "record --count 20 --rate 60 --duration 1 -o /tmp/t.mcap");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.standard_error;
  ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 -o t.mcap").exit_code, 0);
  const auto alone = json_of(vestige_ + "replay /tmp/t.mcap --detector cpu --json -");
  EXPECT_GT(alone["contacts"], 20);
  EXPECT_EQ(alone["texture_hash"], json_of("vestige replay t.mcap --json -")["texture_hash"]);

  const test::Outcome devices = run(vestige_ + "devices");
  EXPECT_EQ(devices.exit_code, 0);
  EXPECT_THAT(devices.standard_output, HasSubstr("This machine offers no OpenGL 4.5 context"));
  EXPECT_THAT(devices.standard_output, HasSubstr("libEGL.so.1: cannot be opened"));
  EXPECT_TRUE(json_of(vestige_ + "devices --json -")["auto"].is_null());
  const test::Outcome paper = run(vestige_ + "replay /tmp/t.mcap --detector paper");
  EXPECT_EQ(paper.exit_code, 1);
  EXPECT_THAT(paper.standard_error, HasSubstr("--detector cpu needs no OpenGL"));
}

TEST_F(Bundle, UsesItsOwnLibrariesAndTheMachinesOpenGl) {
  const std::string vestige = "env -u LD_LIBRARY_PATH '" + kBundle + "/bin/vestige' ";
  const std::string list = run("env -u LD_LIBRARY_PATH ldd '" + kBundle + "/bin/vestige'").standard_output;
  EXPECT_THAT(list, HasSubstr("libfmt.so.9 => " + kBundle + "/bin/../lib/libfmt.so.9"));
  EXPECT_THAT(list, Not(HasSubstr("/lib/fallback/"))) << "a driver may need the machine's newer one";
  ASSERT_EQ(run(vestige + "record --count 20 --rate 60 --duration 1 -o t.mcap").exit_code, 0);
  // own context: OSMesa, beside the one of all tests
  for (const std::string& context : {test::gl_flags("egl"), std::string(" --context osmesa")}) {
    const std::string flags = "replay t.mcap --detector paper --json -" + context;
    const auto bundled = json_of(vestige + flags);
    EXPECT_EQ(bundled["texture_hash"], json_of("vestige " + flags)["texture_hash"]) << context;
    EXPECT_FALSE(bundled["gl"]["renderer"].get<std::string>().empty());
  }
}

TEST_F(Bundle, NeedsNoGlibcNewerThan236) {
  const test::Outcome needs = run("cd '" + kBundle + "' && objdump -T bin/* lib/*.so* lib/fallback/*.so*");
  ASSERT_EQ(needs.exit_code, 0) << needs.standard_error;
  const std::regex version("GLIBC_2\\.([0-9]+)");
  std::set<int> minors;
  for (std::sregex_iterator i(needs.standard_output.begin(), needs.standard_output.end(), version), end; i != end; ++i)
    minors.insert(std::stoi((*i)[1]));
  ASSERT_FALSE(minors.empty());
  EXPECT_LE(*minors.rbegin(), 36);
}

TEST_F(Bundle, IsSmallAndSaysWhatItsPartsAreLicensedUnder) {
  std::uintmax_t bytes = 0;
  std::size_t libraries = 0;
  std::size_t licences = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kBundle)) {
    if (!entry.is_regular_file()) continue;
    bytes += entry.file_size();
    if (entry.path().string().find(".so") != std::string::npos) ++libraries;
    if (entry.path().parent_path().filename() == "licences") ++licences;
    EXPECT_THAT(entry.path().filename().string(), Not(::testing::AnyOf(HasSubstr("libc.so"), HasSubstr("libGL"))));
  }
  EXPECT_LT(bytes, 40U << 20U);
  for (const std::string program : kPrograms)
    EXPECT_THAT(run("objdump -t '" + kBundle + "/bin/" + program + "'").standard_output, HasSubstr("no symbols"));
  EXPECT_GE(libraries, 10U);
  EXPECT_GE(licences, 10U);
}

TEST_F(Bundle, MeasureLeavesAFolderOfResultsAndOneVerdict) {
  const test::Outcome measured = run("'" + kBundle + "/measure' --quick --pairs 2000 results");
  ASSERT_EQ(measured.exit_code, 0) << measured.standard_output << measured.standard_error;
  for (const char* file : {"devices.json", "devices.txt", "swarm.mcap", "replay-swarm-cpu-static-off.json",
                           "replay-swarm-geometry-ccd-on.json", "replay-swarm-paper.json", "agreement-cpu-ccd.json",
                           "agreement-geometry-carried.json", "sweep/sweep.json", "README.md", "log/machine.txt"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "results" / file)) << file;
  EXPECT_THAT(run("tar -tzf results.tar.gz").standard_output,
              AllOf(HasSubstr("results/sweep/sweep.json"), HasSubstr("results/verdict.txt")));
  std::set<std::string> series;
  const auto sweep = json_in("results/sweep/sweep.json");
  for (const auto& one : sweep["series"])
    series.insert(one["detector"].get<std::string>() + " " + one["skip"].get<std::string>());
  EXPECT_THAT(series, IsSupersetOf({"paper off", "geometry off", "geometry on", "compute on", "cpu off", "cpu on"}));

  const std::string verdict = read_text_file(folder_ / "results/verdict.txt");
  const auto device = json_in("results/devices.json")["auto"];
  EXPECT_THAT(verdict, StartsWith("VERDICT: EXACT on " + device["renderer"].get<std::string>() + "\n"));
  EXPECT_THAT(verdict, AllOf(HasSubstr(device["context"].get<std::string>()), HasSubstr("to nearest even")));
  // Three methods by five contestants; two methods.
  EXPECT_THAT(verdict, HasSubstr("0 missed, 0 other winners, of 60000 answers"));
  EXPECT_THAT(verdict, HasSubstr("0 differ, of 4200 answers"));
  EXPECT_THAT(verdict, HasSubstr("the texture of cpu without skipping: 45 of 45"));
  EXPECT_THAT(verdict, HasSubstr("errors: 0, others: "));
  EXPECT_THAT(verdict, HasSubstr("With 100 colliders, against the fastest cpu"));
  EXPECT_THAT(verdict, Not(HasSubstr("FAILED")));
  EXPECT_THAT(measured.standard_output, EndsWith(verdict));
  EXPECT_THAT(read_text_file(folder_ / "results/README.md"), HasSubstr(verdict));
  EXPECT_NE(run("'" + kBundle + "/measure' --quick results").exit_code, 0) << "overwrote results";
  EXPECT_EQ(run("'" + kBundle + "/measure' --quick --pairs many other").exit_code, 2);
}

TEST_F(Bundle, MeasureGoesOnAfterAFailureAndSaysSo) {
  // This vestige crashes in the sweep, and for the rest of the work only pretends.
  const test::Outcome measured = measure_with(R"(
case $1 in
  sweep) echo broken >&2; exit 139 ;;
  record) while [ "$1" != -o ]; do shift; done; : >"$2" ;;
  replay) echo "OpenGL debug: error, high: GL_INVALID_ENUM in glEnable" >&2 ;;
  accuracy | stress) ;;
  *) exec "$real" "$@" ;;
esac
)");
  EXPECT_EQ(measured.exit_code, 1);
  EXPECT_THAT(measured.standard_error, HasSubstr("these steps failed: sweep(139)"));
  EXPECT_THAT(read_text_file(folder_ / "results/log/sweep.txt"), HasSubstr("broken"));
  const std::string verdict = read_text_file(folder_ / "results/verdict.txt");
  EXPECT_THAT(verdict, StartsWith("VERDICT: INCOMPLETE on "));
  EXPECT_THAT(verdict, HasSubstr("FAILED:\n    sweep(139): results/log/sweep.txt"));
  EXPECT_THAT(verdict, HasSubstr("0 missed, 0 other winners, of 60000 answers")) << "what ran is kept";
  EXPECT_THAT(verdict, AllOf(HasSubstr("errors: 1, others: "), HasSubstr("GL_INVALID_ENUM in glEnable")));
}

TEST_F(Bundle, MeasureSaysWhereContactsDiffer) {
  const test::Outcome measured = measure_with(R"(
case "$1 $*" in
  record*) while [ "$1" != -o ]; do shift; done; : >"$2" ;;
  replay*paper*) exit 4 ;;
  replay*hug*geometry*carried*--skip\ on*) exit 4 ;;
  replay* | sweep* | accuracy* | stress*) ;;
  *) exec "$real" "$@" ;;
esac
)");
  EXPECT_EQ(measured.exit_code, 1);
  const std::string verdict = read_text_file(folder_ / "results/verdict.txt");
  EXPECT_THAT(verdict, AllOf(StartsWith("VERDICT: NOT EXACT on "), HasSubstr(": contacts differ\n"),
                             HasSubstr("the texture of cpu without skipping: 44 of 45"),
                             HasSubstr("results/log/replay-hug-geometry-carried-on.txt"),
                             HasSubstr("paper, which does not promise to be exact, differ in: replay-swarm-paper")));
}

TEST_F(Bundle, MeasureSaysThatGeometryIsRefusedAndWhy) {
  const test::Outcome measured = measure_with(R"(
case $1 in
  record) while [ "$1" != -o ]; do shift; done; : >"$2" ;;
  replay | sweep | accuracy | stress) ;;
  devices) "$real" "$@" | sed "s/^\* .*/&\n                    'geometry' is refused there: it rounds up/" ;;
  *) exec "$real" "$@" ;;
esac
)");
  EXPECT_EQ(measured.exit_code, 1);
  const std::string verdict = read_text_file(folder_ / "results/verdict.txt");
  EXPECT_THAT(verdict,
              AllOf(StartsWith("VERDICT: NOT KNOWN TO BE EXACT on "), HasSubstr("geometry is refused, it rounds up\n"),
                    HasSubstr("the texture of cpu without skipping: 9 of 9")));
}

}  // namespace
}  // namespace vestige
