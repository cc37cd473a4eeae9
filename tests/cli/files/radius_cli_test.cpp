// Colliders with a radius, as they come in from every carrier and leave by it again.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/cli/files/exchange_fixture.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/hdf5/hdf5_table.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Radius : public test::ExchangeTest {
 protected:
  /// What `cat` prints of the frames: all that a trace says, but who wrote it.
  std::string frames_of(const std::string& trace) const {
    return run("vestige cat " + trace + " | grep -v '\"topic\":\"/viz'").standard_output;
  }
  std::string version_of(const std::string& trace) const {
    return json_of("vestige inspect " + trace + " --json -")["session"]["format_version"];
  }
  /// A recording whose radii change from frame to frame, and in which a point is among spheres.
  void record_growing() const {
    write("growing.csv",
          "time_s,id,x,y,z,radius_m\n"
          "0,4,0,1,1,0.05\n0,9,0.5,1,1,0\n0.1,4,0,1,0.5,0.1\n0.1,9,0.5,1,0,0\n0.2,4,0,1,1,0.0123456789\n");
    ASSERT_EQ(run("vestige record --colliders growing.csv --rate 100 --duration 0.2 -o growing.mcap").exit_code, 0);
  }
};

TEST_F(Radius, ATraceOfPointsSaysVersion1AndOneOfSpheresVersion2) {
  EXPECT_EQ(version_of("a.mcap"), "1");
  ASSERT_EQ(run("vestige record --count 3 --duration 0.1 --radius 0.05 -o b.mcap").exit_code, 0);
  EXPECT_EQ(version_of("b.mcap"), "2");
  EXPECT_THAT(frames_of("b.mcap"), HasSubstr(R"("radius":0.05)"));
  ASSERT_EQ(run("vestige record --count 3 --duration 0.1 --radius 0 -o c.mcap").exit_code, 0);
  EXPECT_EQ(version_of("c.mcap"), "1");
}

TEST_F(Radius, OfCollidersGivesContactsADepthAndPointsHaveNone) {
  ASSERT_EQ(run("vestige record --colliders rest --duration 0.8 --rate 100 -o rest.mcap").exit_code, 0);
  for (const char* detector : {"cpu", "exact"})
    ASSERT_EQ(run(fmt::format("vestige replay rest.mcap --detector {0} --contacts {0}.csv", detector)).exit_code, 0);
  EXPECT_EQ(run("head -1 cpu.csv").standard_output,
            "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z,depth\n");
  EXPECT_EQ(run("cmp cpu.csv exact.csv").exit_code, 0);
  const std::string deepest = run("tail -n +2 cpu.csv | cut -d, -f15 | sort -g | tail -1").standard_output;
  EXPECT_GT(std::stod(deepest), 0.004);
  EXPECT_LT(std::stod(deepest), 0.008);
  ASSERT_EQ(run("vestige replay rest.mcap --contacts c.h5").exit_code, 0);
  EXPECT_EQ(run("vestige replay rest.mcap --verify c.h5").exit_code, 0);
  EXPECT_EQ(run("vestige replay rest.mcap --verify cpu.csv").exit_code, 0);
  ASSERT_EQ(run("vestige replay a.mcap --contacts a.csv").exit_code, 0);
  EXPECT_EQ(run("head -1 a.csv").standard_output,
            "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z\n");
}

TEST_F(Radius, IsNeededByLawsUnderWhichOnlySpheresAreFelt) {
  for (const char* law : {"depth", "patch"}) {
    const auto refused = run(fmt::format("vestige replay a.mcap --law {} --timeline t.csv", law));
    EXPECT_EQ(refused.exit_code, 1) << law;
    EXPECT_THAT(refused.standard_error, HasSubstr("only spheres are felt")) << law;
  }
  ASSERT_EQ(run("vestige record --colliders brush --duration 2.4 --rate 100 --map body -o brush.mcap").exit_code, 0);
  for (const char* law : {"depth", "patch"}) {
    ASSERT_EQ(run(fmt::format("vestige replay brush.mcap --law {0} --timeline {0}.csv", law)).exit_code, 0) << law;
    EXPECT_THAT(
        run(fmt::format("tail -n +2 {}.csv | cut -d, -f2- | tr ',' '\n' | sort -n | tail -1", law)).standard_output,
        Not("0\n"))
        << law;
  }
}

TEST_F(Radius, OfZeroForEveryColliderMakesPoints) {
  write("zeros.csv", "time_s,id,x,y,z,radius_m\n0,4,0,1,1,0\n0.2,4,0,1,-1,0\n");
  ASSERT_EQ(run("vestige record --colliders zeros.csv --rate 100 --duration 0.2 -o zeros.mcap").exit_code, 0);
  ASSERT_EQ(version_of("zeros.mcap"), "2") << "it has radii";
  EXPECT_THAT(run("vestige replay zeros.mcap --law depth --timeline t.csv").standard_error,
              HasSubstr("only spheres are felt"));
  EXPECT_THAT(run("vestige plot paraview zeros.mcap --law patch").standard_error, HasSubstr("only spheres are felt"));
  EXPECT_THAT(run("vestige batch --maps paper6 --traces zeros.mcap --laws depth -o b").standard_error,
              HasSubstr("only spheres are felt"));
  ASSERT_EQ(run("vestige replay zeros.mcap --contacts zeros_contacts.csv").exit_code, 0);
  EXPECT_THAT(run("head -1 zeros_contacts.csv").standard_output, Not(HasSubstr("depth")));
}

TEST_F(Radius, ThatCoversNoActuatorsPlaceIsSaidToBeSilentUnderPatch) {
  ASSERT_EQ(
      run("vestige record --colliders rest --count 1 --duration 0.8 --rate 100 --map body -o rest.mcap").exit_code, 0);
  EXPECT_THAT(run("vestige replay rest.mcap --law depth --timeline d.csv").standard_error, Not(HasSubstr("drove no")));
  ASSERT_EQ(run("vestige record --colliders rest --count 1 --duration 0.8 --rate 100 --map body --radius 0.012 "
                "-o small.mcap")
                .exit_code,
            0);
  const auto silent = run("vestige replay small.mcap --law patch --timeline p.csv");
  EXPECT_EQ(silent.exit_code, 0);
  EXPECT_THAT(silent.standard_error, HasSubstr("drove no actuator under the law patch"));
}

TEST_F(Radius, GivesDepthToTexturesAndExports) {
  ASSERT_EQ(run("vestige record --colliders rest --duration 0.8 --rate 100 -o rest.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige replay rest.mcap --contacts c.csv --textures t.exr --planes depth").exit_code, 0);
  EXPECT_THAT(run("vestige explain t.exr").standard_output, HasSubstr("depth"));
  ASSERT_EQ(run("vestige export rest.mcap -o rest.h5 --contacts c.csv").exit_code, 0);
  const auto rows = static_cast<hsize_t>(std::stoul(run("tail -n +2 c.csv | wc -l").standard_output));
  ASSERT_GT(rows, 10U);
  const Hdf5Handle file = open_hdf5(folder_ / "rest.h5", "");
  std::vector<double> depth_m;
  Hdf5Table(file.id(), "rest.h5", "contacts/depth").read(0, rows, depth_m);
  std::string text;
  for (const double depth : depth_m) text += fmt::format("{}\n", depth);
  EXPECT_EQ(text, run("tail -n +2 c.csv | cut -d, -f15").standard_output);
}

TEST_F(Radius, InCsvIsInterpolatedAsThePositionIs) {
  record_growing();
  EXPECT_EQ(version_of("growing.mcap"), "2");
  ASSERT_EQ(run("vestige export growing.mcap -o c.csv --what colliders").exit_code, 0);
  EXPECT_EQ(run("head -1 c.csv").standard_output, "frame,time_s,id,x,y,z,radius_m,teleported\n");
  EXPECT_EQ(run("grep ^5, c.csv").standard_output, "5,0.05,4,0,1,0.75,0.075,0\n5,0.05,9,0.5,1,0.5,0,0\n");
}

TEST_F(Radius, ComesBackToTheBitFromEveryLosslessFormat) {
  record_growing();
  const std::string frames = frames_of("growing.mcap");
  EXPECT_THAT(frames, HasSubstr(R"("radius":0.0)"));
  for (const char* out : {"folder", "g.h5", "g.ndjson"}) {
    ASSERT_EQ(run(fmt::format("vestige export growing.mcap -o {}", out)).exit_code, 0) << out;
    const std::string back = std::string(out) == "g.ndjson"
                                 ? "vestige record --live - -o back.mcap --force < g.ndjson"
                                 : fmt::format("vestige import {} -o back.mcap --force", out);
    ASSERT_EQ(run(back).exit_code, 0) << out;
    EXPECT_EQ(version_of("back.mcap"), "2") << out;
    EXPECT_TRUE(frames_of("back.mcap") == frames) << out;
  }
}

TEST_F(Radius, OfAGltfNodeIsItsScale) {
  record_growing();
  const auto exported = run("vestige export growing.mcap -o g.glb");
  EXPECT_EQ(exported.exit_code, 0) << exported.standard_error;
  const nlohmann::json glb = json_of_glb("g.glb");
  std::map<std::string, double> radii;
  for (const auto& node : glb["nodes"])
    if (node.contains("extras")) radii[node["name"]] = node["extras"]["radius_m"];
  EXPECT_EQ(radii, (std::map<std::string, double>{{"collider 4", 1}, {"collider 9", 0}}));
  ASSERT_EQ(run("vestige record --colliders g.glb --rate 100 --duration 0.2 -o back.mcap").exit_code, 0);
  const auto radii_of = [&](const std::string& trace) {
    return run("vestige export " + trace + " -o - --format csv --what colliders | cut -d, -f1,3,7").standard_output;
  };
  EXPECT_EQ(radii_of("back.mcap"), radii_of("growing.mcap"));
  ASSERT_EQ(run("vestige record --colliders g.glb --rate 100 --duration 0.2 --radius mesh -o mesh.mcap").exit_code, 0);
  EXPECT_THAT(radii_of("mesh.mcap"), HasSubstr("0,9,0.01\n")) << "a point is drawn as a sphere of 1 cm";
}

TEST_F(Radius, OfZeroAmongTheRadiiOfASphereIsSaidToBeLostInAGltf) {
  write("c.csv", "time_s,id,x,y,z,radius_m\n0,4,0,1,1,0.05\n0.1,4,0,1,0.5,0\n");
  ASSERT_EQ(run("vestige record --colliders c.csv --rate 100 --duration 0.1 -o c.mcap").exit_code, 0);
  const auto exported = run("vestige export c.mcap -o c.glb");
  EXPECT_EQ(exported.exit_code, 0) << "the sphere never shrinks to 0 in a frame: " << exported.standard_error;
  write("z.csv", "time_s,id,x,y,z,radius_m\n0,4,0,1,1,0.05\n0.05,4,0,1,0.5,0\n0.1,4,0,1,0.5,0\n");
  ASSERT_EQ(run("vestige record --colliders z.csv --rate 100 --duration 0.1 -o z.mcap").exit_code, 0);
  const auto lossy = run("vestige export z.mcap -o z.glb");
  EXPECT_EQ(lossy.exit_code, 3);
  EXPECT_THAT(lossy.standard_error, HasSubstr("radius value"));
}

TEST_F(Radius, MayBeGivenToTheCollidersOfAFile) {
  write("c.csv", "time_s,id,x,y,z\n0,4,0,1,1\n0.1,4,0,1,0.5\n");
  ASSERT_EQ(run("vestige record --colliders c.csv --rate 100 --duration 0.1 --radius 0.03 -o c.mcap").exit_code, 0);
  EXPECT_EQ(version_of("c.mcap"), "2");
  EXPECT_EQ(json_of("vestige inspect c.mcap --json -")["session"]["radius"], "0.03");
  ASSERT_EQ(run("vestige export a.mcap -o folder").exit_code, 0);
  ASSERT_EQ(
      run("vestige import --poses folder/poses.csv --colliders folder/colliders.csv --radius 0.04 -o d.mcap").exit_code,
      0);
  EXPECT_THAT(frames_of("d.mcap"), HasSubstr(R"("radius":0.04)"));
}

TEST_F(Radius, ThatNoneCanHaveIsRefusedWithItsPlace) {
  const auto refused = [&](const std::string& rows, const std::vector<std::string>& words) {
    write("c.csv", rows);
    expect_failure("vestige record --colliders c.csv --duration 0.1 -o c.mcap", 1, words, "c.mcap");
  };
  const std::string head = "time_s,id,x,y,z,radius_m\n0,4,0,1,1,0.05\n";
  refused(head + "0.1,4,0,1,1,-0.05\n", {"c.csv, line 3", "radius_m is negative"});
  refused(head + "0.1,4,0,1,1,nan\n", {"c.csv, line 3", "radius_m is not finite"});
  refused(head + "0.1,4,0,1,1,10.5\n", {"c.csv, line 3", "radius_m is larger than 10 m"});
  refused(head + "0.1,4,0,1,1,-1e-50\n", {"c.csv, line 3", "radius_m is negative"});
  refused(head + "0.1,4,0,1,1,1e300\n", {"c.csv, line 3", "radius_m is larger than 10 m"});
  refused(head + "0.1,4,0,1,1,10.0000001\n", {"c.csv, line 3", "radius_m is larger than 10 m"});
  refused(head + "0.1,4,0,1,1,large\n", {"c.csv, line 3", "radius_m is not a number"});
  refused(head + "0.1,4,0,1,1\n", {"c.csv, line 3", "radius_m is not a number"});
  refused(head + "0.1,4,0,1,1,0.05,0\n", {"c.csv, line 3", "is not six numbers"});
  refused("time_s,id,x,y,z,radius\n0,4,0,1,1,0.05\n", {"c.csv, line 1", "radius_m"});
  for (const char* radius : {"-1", "11", "nan", "big", "1cm"})
    expect_failure(fmt::format("vestige record --duration 0.1 --radius={} -o c.mcap", radius), 2, {"--radius", radius},
                   "c.mcap");
  expect_failure("vestige record --duration 0.1 --radius mesh -o c.mcap", 2, {"--radius mesh", ".glb"}, "c.mcap");
}

TEST_F(Radius, OfANodeThatNoneCanHaveIsRefusedWithItsPlace) {
  const auto refused = [&](const std::string& extras, const std::vector<std::string>& words) {
    write("c.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"name":"collider 1","extras":)" + extras + "}]}");
    expect_failure("vestige record --colliders c.gltf --duration 0.1 -o c.mcap", 1, words, "c.mcap");
  };
  refused(R"({"radius_m":-1})", {"nodes[0].extras.radius_m", "is negative"});
  refused(R"({"radius_m":"1"})", {"nodes[0].extras.radius_m", "is not a number"});
  refused(R"({"radius_m":11})", {"nodes[0].extras.radius_m", "is larger than 10 m"});
  write("c.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"name":"collider 1","scale":[9,9,9],"extras":{"radius_m":2}}]})");
  expect_failure("vestige record --colliders c.gltf --duration 0.1 -o c.mcap", 1, {"collider 1", "18 m", "--radius"});
  EXPECT_EQ(run("vestige record --colliders c.gltf --duration 0.1 --radius 0.1 -o d.mcap").exit_code, 0)
      << "what the file says does not matter then";
  expect_failure("vestige record --colliders c.gltf --duration 0.1 --radius mesh -o c.mcap", 1,
                 {"none of the chosen nodes has a mesh", "--radius M"}, "c.mcap");
}

TEST_F(Radius, ThatAGltfReachesLateLeavesTheOldRecordingAlone) {
  write("c.csv", "time_s,id,x,y,z,radius_m\n0,4,0,1,1,1\n0.1,4,0,1,1,9\n");
  ASSERT_EQ(run("vestige record --colliders c.csv --duration 0.1 --rate 100 -o c.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige export c.mcap -o c.glb && sed 's/\"radius_m\":1/\"radius_m\":2/' c.glb > d.glb").exit_code, 0);
  const std::string before = run("sha256sum c.mcap").standard_output;
  expect_failure("vestige record --colliders d.glb --duration 0.1 --rate 100 --force -o c.mcap", 1,
                 {"d.glb", "collider 4", "is larger than 10 m"});
  EXPECT_EQ(run("sha256sum c.mcap").standard_output, before);
}

TEST_F(Radius, OfALiveCollider) {
  record_lines(R"({"colliders":[{"id":1,"position":[0,1,0.5],"radius":0.05},{"id":2,"position":[0,1,1]}]})"
               "\n",
               "live.mcap");
  EXPECT_EQ(version_of("live.mcap"), "2");
  EXPECT_THAT(frames_of("live.mcap"), HasSubstr(R"({"id":1,"position":[0,1,0.5],"radius":0.05},{"id":2,"position")"));
}

}  // namespace
}  // namespace vestige
