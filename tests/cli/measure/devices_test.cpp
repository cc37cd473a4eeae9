// What `vestige devices` says of this machine's OpenGL, and of machines that lack it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "detector/gl/gl_context.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Devices : public test::CommandLineTest {
 protected:
  nlohmann::json contexts(const std::string& environment = "") const {
    return json_of(environment + " vestige devices --json -");
  }
  static nlohmann::json find(const nlohmann::json& json, const std::string& name) {
    for (const auto& context : json["contexts"])
      if (context["context"] == name) return context;
    return nullptr;
  }
};

TEST_F(Devices, AreListedWithLimitsInAHundredColumns) {
  const test::Outcome list = run("vestige devices");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_THAT(list.standard_output,
              AllOf(HasSubstr("egl-surfaceless"), HasSubstr("osmesa"), HasSubstr("* marks the context"),
                    HasSubstr("points from a geometry shader"), HasSubstr("vertex shaders: to nearest even")));
  std::istringstream lines(list.standard_output);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST_F(Devices, SayWhichContextAutoTakesWhetherItIsSoftwareAndThatPaperCanRun) {
  const auto json = contexts();
  ASSERT_TRUE(json["auto"].is_object());
  ASSERT_EQ(run("vestige record --count 5 --rate 60 --duration 0.1 -o t.mcap").exit_code, 0);
  const auto replay = nlohmann::json::parse(run("vestige replay t.mcap --detector paper --json -").standard_output);
  EXPECT_EQ(json["auto"]["context"], replay["gl"]["context"]);
  const auto osmesa = find(json, "osmesa");
  EXPECT_EQ(osmesa["software"], true);
  EXPECT_TRUE(osmesa["paper_lacks"].is_null());
  EXPECT_GE(osmesa["limits"]["geometry_output_vertices"], 256);
  EXPECT_GE(osmesa["limits"]["texture_side"], 4096);
  EXPECT_EQ(find(json, "egl-device-0")["egl_device"]["number"], 0);
  ASSERT_EQ(osmesa["arithmetic"].size(), 3U);
  EXPECT_EQ(osmesa["arithmetic"][1]["stage"], "geometry");
  EXPECT_EQ(osmesa["arithmetic"][1]["rounding"], "nearest even");
  EXPECT_TRUE(osmesa["geometry_refused"].is_null());
  EXPECT_EQ(replay["gl"]["arithmetic"], json["auto"]["arithmetic"]);
}

/// What the CPU skinned is not compared with the CPU.
TEST_F(Devices, AreComparedWithTheCpuOnlyWhereAShaderSkins) {
  ASSERT_EQ(run("vestige record --count 5 --rate 60 --duration 0.1 -o t.mcap").exit_code, 0);
  const auto identical = [&](const std::string& detector) {
    return json_of("vestige replay t.mcap --json - --detector " + detector +
                   test::gl_flags())["skinning"]["identical_to_cpu"];
  };
  EXPECT_TRUE(identical("cpu").is_null());
  EXPECT_TRUE(identical("geometry").is_null());
  EXPECT_GT(identical("geometry --skip off"), 0);
  EXPECT_GT(identical("paper"), 0);
  EXPECT_THAT(run("vestige replay t.mcap --detector geometry" + test::gl_flags()).standard_output,
              AllOf(HasSubstr("skinning by the CPU"), testing::Not(HasSubstr("same bits as on the CPU"))));
  EXPECT_THAT(run("vestige replay t.mcap --detector paper" + test::gl_flags()).standard_output,
              AllOf(HasSubstr("skinning by a shader"), HasSubstr("same bits as on the CPU")));
}

TEST_F(Devices, ThatCannotBeMadeAreListedWithTheReason) {
  // Of two loaders, one is a stub that is no library.
  ASSERT_EQ(run("mkdir none && echo > none/libEGL.so.1").exit_code, 0);
  const std::string hidden = "LD_LIBRARY_PATH=\"$PWD/none\"";
  const auto json = contexts(hidden);
  EXPECT_THAT(find(json, "egl-surfaceless")["unusable"].get<std::string>(), HasSubstr("libEGL.so.1"));
  EXPECT_EQ(json["auto"]["context"], "osmesa");
  EXPECT_THAT(run(hidden + " vestige devices").standard_output,
              AllOf(HasSubstr("unusable: libEGL.so.1: cannot be opened"), HasSubstr("* osmesa")));
  // A driver below OpenGL 4.5.
  const auto old = contexts("MESA_GL_VERSION_OVERRIDE=3.3");
  EXPECT_TRUE(old["auto"].is_null());
  for (const auto& context : old["contexts"]) EXPECT_TRUE(context.contains("unusable")) << context;
}

TEST(SoftwareRenderers, AreKnownByTheirNames) {
  for (const char* name :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "Mesa OffScreen swrast",
        "zink Vulkan 1.3(llvmpipe (LLVM 17))", "ANGLE (Google, Vulkan 1.3 (SwiftShader Device))"})
    EXPECT_TRUE(is_software_renderer(name)) << name;
  for (const char* name : {"NVIDIA H100 80GB HBM3/PCIe/SSE2", "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
                           "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49)", ""})
    EXPECT_FALSE(is_software_renderer(name)) << name;
}

}  // namespace
}  // namespace vestige
