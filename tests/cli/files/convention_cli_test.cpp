// Recordings in the conventions of other programs: understood, or questioned with the flag that mends them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ConventionCommandLine : public test::CommandLineTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("vestige record --animation walk --colliders swarm --rate 250 --duration 1 -o right.mcap").exit_code,
              0);
    ASSERT_EQ(run("vestige export right.mcap -o right").exit_code, 0);
    right_contacts_ = contacts("right.mcap");
    ASSERT_GT(right_contacts_, 50);
  }

  int contacts(const std::string& trace) const {
    return json_of("vestige replay " + trace + " --detector cpu --json - -q")["contacts"];
  }

  /// Makes a CSV of the right colliders; `fields` is awk's print of t, i, x, y and z.
  std::string colliders(const std::string& name, const std::string& fields, const std::string& from = "right") const {
    const test::Outcome outcome = run(
        "awk -F, 'BEGIN{print \"frame,time_s,id,x,y,z,teleported\"} NR>1{OFS=\",\";t=$2;i=$3;x=$4;y=$5;z=$6;print $1," +
        fields + ",$7}' " + from + "/colliders.csv > " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    return name;
  }

  std::string recorded(const std::string& file, const std::string& flags = "") const {
    const test::Outcome outcome = run(
        "vestige record --animation walk --rate 250 --duration 1 --force -o x.mcap --colliders " + file + " " + flags);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    return outcome.standard_error;
  }

  /// Expects that the file is questioned, that the question names `flag`, and that the flag brings the contacts back.
  void expect_mended(const std::string& file, const std::string& flag) const {
    EXPECT_THAT(recorded(file), HasSubstr(flag)) << file;
    EXPECT_THAT(recorded(file, flag), IsEmpty()) << file;
    EXPECT_NEAR(contacts("x.mcap"), right_contacts_, right_contacts_ / 50 + 1) << file;
  }

  int right_contacts_ = 0;
};

TEST_F(ConventionCommandLine, WhatIsRightIsNotQuestioned) {
  EXPECT_THAT(recorded(colliders("right.csv", "t,i,x,y,z")), IsEmpty());
  EXPECT_NEAR(contacts("x.mcap"), right_contacts_, right_contacts_ / 50 + 1);
  EXPECT_THAT(run("vestige import --poses right/poses.csv --colliders right.csv --force -o x.mcap").standard_error,
              IsEmpty());
  EXPECT_THAT(run("vestige replay right.mcap").standard_error, IsEmpty());
}

TEST_F(ConventionCommandLine, NamesTheUnit) {
  expect_mended(colliders("cm.csv", "t,i,100*x,100*y,100*z"), "--collider-unit cm");
  expect_mended(colliders("mm.csv", "t,i,1000*x,1000*y,1000*z"), "--collider-unit mm");
  expect_mended(colliders("in.csv", "t,i,x/0.0254,y/0.0254,z/0.0254"), "--collider-unit in");
}

TEST_F(ConventionCommandLine, NamesTheAxes) {
  expect_mended(colliders("z_up.csv", "t,i,x,-z,y"), "--collider-axes blender");
  expect_mended(colliders("unreal.csv", "t,i,100*z,-100*x,100*y"), "--collider-axes unreal");
  EXPECT_THAT(recorded(colliders("shifted.csv", "t,i,y,z,x")), HasSubstr("columns in the order y,z,x"));
}

TEST_F(ConventionCommandLine, PrefersWhatNeedsNoNumber) {
  // Fists in front of head and torso: an offset would bring more of them near, and two units about as many.
  ASSERT_EQ(run("vestige record --animation walk --colliders punch --rate 250 --duration 1 -o punch.mcap").exit_code,
            0);
  ASSERT_EQ(run("vestige export punch.mcap -o punch").exit_code, 0);
  EXPECT_THAT(recorded(colliders("z_up.csv", "t,i,x,-z,y", "punch")), HasSubstr(": --collider-axes blender"));
  const std::string inches = recorded(colliders("in.csv", "t,i,x/0.0254,y/0.0254,z/0.0254", "punch"));
  EXPECT_THAT(inches, HasSubstr("--collider-unit cm (or --collider-unit in: "));
  EXPECT_THAT(inches, Not(HasSubstr("--collider-offset")));
}

TEST_F(ConventionCommandLine, NamesEachThatMayBeMeant) {
  // A quarter turn about the vertical: points on all sides of the body fit about as well.
  EXPECT_THAT(recorded(colliders("unreal_m.csv", "t,i,z,-x,y")), HasSubstr("--collider-axes unreal --collider-unit m"));
  EXPECT_THAT(recorded(colliders("turned.csv", "t,i,z,x,y")), HasSubstr("columns in the order z,x,y"));
}

TEST_F(ConventionCommandLine, NamesTheUnitOfASmallScene) {
  colliders("cm.csv", "t,i,100*x,100*y,100*z");
  EXPECT_THAT(recorded("cm.csv", "--collider-unit mm"), HasSubstr("--collider-unit cm"));
  colliders("unreal_m.csv", "t,i,z,-x,y");
  EXPECT_THAT(recorded("unreal_m.csv", "--collider-axes unreal"), HasSubstr("--collider-unit m"));
}

TEST_F(ConventionCommandLine, FindsBackToTheAxesOfATrace) {
  colliders("right.csv", "t,i,x,y,z");
  EXPECT_THAT(recorded("right.csv", "--collider-axes unreal"), HasSubstr("--collider-axes gltf"));
}

TEST_F(ConventionCommandLine, NamesAnOffsetBeforeAxesThatBringFew) {
  ASSERT_EQ(run("vestige record --animation walk --colliders hug --rate 100 --duration 1 -o hug.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige export hug.mcap -o hug").exit_code, 0);
  EXPECT_THAT(recorded(colliders("away.csv", "t,i,x+1,y,z", "hug")), HasSubstr("%: --collider-offset=-1,"));
  // Its mirror image fits better than the recording in centimetres alone.
  EXPECT_THAT(recorded(colliders("unity_cm.csv", "t,i,-100*x,100*y,100*z", "hug")),
              HasSubstr("--collider-axes unity --collider-unit cm"));
}

TEST_F(ConventionCommandLine, LeavesWhatMovesOnTheFloorAlone) {
  std::string rows = "time_s,id,x,y,z\n";
  for (int k = 0; k <= 100; ++k)
    for (int id = 0; id < 5; ++id)
      rows += std::to_string(0.01 * k) + "," + std::to_string(id) + "," + std::to_string(0.05 + 0.02 * id) + ",0.05," +
              std::to_string(0.9 - 0.008 * k) + "\n";
  write("shoe.csv", rows);
  EXPECT_THAT(recorded("shoe.csv"), Not(HasSubstr("axes")));
}

TEST_F(ConventionCommandLine, SaysThatAllCollidersAreInOnePoint) {
  EXPECT_THAT(recorded(colliders("zero.csv", "t,i,0,0,0")), HasSubstr("all 100 colliders stay in one point, 0, 0, 0"));
}

TEST_F(ConventionCommandLine, NamesAUnitAndAnOffset) {
  EXPECT_THAT(recorded(colliders("cm_away.csv", "t,i,100*x+300,100*y,100*z")),
              HasSubstr("--collider-unit cm --collider-offset=-3,"));
}

TEST_F(ConventionCommandLine, NamesAnOffset) {
  const std::string question = recorded(colliders("away.csv", "t,i,x+5,y,z"));
  EXPECT_THAT(question, HasSubstr("--collider-offset=-"));
  const std::size_t begin = question.find("--collider-offset");
  const std::string flag = question.substr(begin, question.find('\n', begin) - begin);
  EXPECT_THAT(recorded("away.csv", flag), IsEmpty());
  EXPECT_GT(contacts("x.mcap"), right_contacts_ / 2);  // the offset is known to about 10 cm
}

TEST_F(ConventionCommandLine, AsksAboutTimes) {
  EXPECT_THAT(recorded(colliders("ms.csv", "1000*t,i,x,y,z")), HasSubstr("--time-unit ms"));
  EXPECT_THAT(recorded("ms.csv", "--time-unit ms"), IsEmpty());
  EXPECT_NEAR(contacts("x.mcap"), right_contacts_, right_contacts_ / 50 + 1);
  // 30 Hz given as 1 kHz: everything is over soon.
  EXPECT_THAT(recorded(colliders("fast.csv", "t*0.03,i,x,y,z")), HasSubstr("colliders are there for 0.0299 s of 1 s"));
  colliders("slow.csv", "t,i,x,y,z");
  EXPECT_THAT(run("vestige record --animation walk --duration 1 --colliders slow.csv --force -o x.mcap").standard_error,
              HasSubstr("samples at 250 Hz become frames at 1000 Hz"));
}

TEST_F(ConventionCommandLine, RefusesIdsThatAreAllEqual) {
  colliders("one_id.csv", "t,7,x,y,z");
  expect_failure("vestige record --colliders one_id.csv -o y.mcap", 1,
                 {"collider 7 has two positions", "give each collider an id of its own"}, "y.mcap");
}

TEST_F(ConventionCommandLine, AsksAboutPosesOfUnity) {
  // Unity's axes are left-handed: +X points the other way, and rotations turn the other way about Y and Z.
  const test::Outcome made = run(
      "awk -F, 'NR==1{for(i=1;i<=NF;i++){n[i]=$i;gsub(/\"/,\"\",n[i])};print;next}{OFS=\",\";for(i=3;i<=NF;i++)"
      "if(n[i]==\"origin_x\"||n[i]~/\\.tx$/||n[i]~/\\.ry$/||n[i]~/\\.rz$/)$i=-$i;print}' right/poses.csv > unity.csv");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  colliders("unity_colliders.csv", "t,i,-x,y,z");
  const std::string import = "vestige import --poses unity.csv --colliders unity_colliders.csv --force -o x.mcap ";
  EXPECT_THAT(run(import).standard_error, HasSubstr("--pose-axes unity"));
  // Mirrored colliders around a body that is alike on both sides touch as often: only the poses tell.
  EXPECT_THAT(run(import + "--pose-axes unity").standard_error, HasSubstr("--collider-axes unity"));
  EXPECT_THAT(run(import + "--pose-axes unity --collider-axes gltf").standard_error, IsEmpty());
  const test::Outcome mended = run(import + "--pose-axes unity --collider-axes unity");
  EXPECT_THAT(mended.standard_error, IsEmpty());
  EXPECT_NEAR(contacts("x.mcap"), right_contacts_, right_contacts_ / 50 + 1);
}

TEST_F(ConventionCommandLine, PosesAreAskedAboutBeforeColliders) {
  const test::Outcome made =
      run("awk -F, 'NR==1{for(i=1;i<=NF;i++){n[i]=$i;gsub(/\"/,\"\",n[i])};print;next}{OFS=\",\";for(i=3;i<=NF;i++)"
          "if(n[i]~/(origin_|\\.t)[xyz]$/)$i=100*$i;print}' right/poses.csv > cm.csv");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  const std::string import = "vestige import --poses cm.csv --colliders right/colliders.csv --force -o x.mcap ";
  const std::string question = run(import).standard_error;
  EXPECT_THAT(question, HasSubstr("--pose-unit cm"));
  EXPECT_THAT(question, Not(HasSubstr("away from the skin")));
  EXPECT_THAT(run(import + "--pose-unit cm").standard_error, IsEmpty());
}

TEST_F(ConventionCommandLine, AsksAboutTimesOfPoses) {
  const test::Outcome made = run("awk -F, 'NR==1{print;next}{OFS=\",\";$2=1000*$2;print}' right/poses.csv > ms.csv");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_THAT(run("vestige import --poses ms.csv --force -o x.mcap").standard_error, HasSubstr("--time-unit ms"));
  EXPECT_THAT(run("vestige import --poses ms.csv --time-unit ms --force -o x.mcap").standard_error, IsEmpty());
}

TEST_F(ConventionCommandLine, AsksAboutQuaternionsInAnotherOrder) {
  const test::Outcome made =
      run("sed '1{s/\\.rx/.r0/g;s/\\.ry/.r1/g;s/\\.rz/.r2/g;s/\\.rw/.rx/g;s/\\.r0/.ry/g;"
          "s/\\.r1/.rz/g;s/\\.r2/.rw/g}' right/poses.csv > wxyz.csv");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_THAT(run("vestige import --poses wxyz.csv --force -o x.mcap").standard_error,
              HasSubstr("are turned by more than 120 degrees; if their quaternions are written w,x,y,z"));
}

TEST_F(ConventionCommandLine, AsksAboutAFewJoints) {
  const test::Outcome made =
      run("awk -F, 'NR==1{for(i=1;i<=NF;i++)if($i==\"time_s\"||$i~/^(clavicle|forearm)/)k[++m]=i}{for(j=1;j<=m;j++)"
          "{v=$k[j];if(NR==1)n[j]=v;else if(n[j]~/(tx|ry|rz)$/)v=-v;printf \"%s%s\",v,j<m?\",\":\"\\n\"}}' "
          "right/poses.csv > few.csv");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  const std::string import = "vestige import --poses few.csv --force -o x.mcap ";
  EXPECT_THAT(run(import).standard_error, HasSubstr("4 of 4 joints"));
  EXPECT_THAT(run(import + "--pose-axes unity").standard_error, Not(HasSubstr("joints do not")));
}

TEST_F(ConventionCommandLine, ReplayAsksAboutATraceThatWasRecordedSo) {
  recorded(colliders("cm.csv", "t,i,100*x,100*y,100*z"));
  const test::Outcome outcome = run("vestige replay x.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("--collider-unit cm"));
}

TEST_F(ConventionCommandLine, SaysOnlyHowFarWhereNothingHelps) {
  write("far.csv", "time_s,id,x,y,z\n0,1,3,4,1000000\n0,2,-700000,4,90\n1,1,3,4.1,1000000\n1,2,-700000,4,90\n");
  const std::string question = recorded("far.csv");
  EXPECT_THAT(question, HasSubstr("m away from the skin"));
  EXPECT_THAT(question, Not(HasSubstr("--collider-unit")));
}

TEST_F(ConventionCommandLine, TheTraceKeepsWhatWasTakenForGranted) {
  recorded(colliders("cm.csv", "t,i,100*x,100*y,100*z"), "--collider-unit cm");
  const std::string session = run("vestige inspect x.mcap -v").standard_output;
  EXPECT_THAT(session, HasSubstr("collider_unit"));
  EXPECT_THAT(session, HasSubstr("cm"));
}

TEST_F(ConventionCommandLine, RefusesFlagsWithoutAFile) {
  expect_failure("vestige record --collider-unit cm -o y.mcap", 2, {"--collider-unit", "no colliders come from a file"},
                 "y.mcap");
  expect_failure("vestige record --time-unit ms -o y.mcap", 2, {"--time-unit"}, "y.mcap");
  expect_failure("vestige record --colliders right/colliders.csv --collider-offset 1,2 -o y.mcap", 2,
                 {"--collider-offset"}, "y.mcap");
  expect_failure("vestige import right --pose-axes unity -o y.mcap", 2, {"--pose-axes"}, "y.mcap");
  expect_failure("vestige record --colliders right/colliders.csv --collider-axes maya -o y.mcap", 2,
                 {"--collider-axes"}, "y.mcap");
}

}  // namespace
}  // namespace vestige
