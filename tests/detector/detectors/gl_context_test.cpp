// The context that tests of OpenGL run in, and what its driver says.

#include "detector/gl/gl_context.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/gl/gl_context.hpp"
#include "tests/support/message_of.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// Sets variables of the environment, and restores them at the end.
class Environment {
 public:
  void set(const std::string& name, const std::string& value) {
    const char* before = std::getenv(name.c_str());
    before_.emplace_back(name, before == nullptr ? "" : before);
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (auto one = before_.rbegin(); one != before_.rend(); ++one) {
      if (one->second.empty()) {
        ::unsetenv(one->first.c_str());
      } else {
        ::setenv(one->first.c_str(), one->second.c_str(), 1);
      }
    }
  }

 private:
  std::vector<std::pair<std::string, std::string>> before_;
};

TEST(TestContext, IsNamed) {
  const auto context = test::make_context();
  std::cout << "Tests of OpenGL run on " << context->info().context << ": " << context->info().renderer << '\n';
  EXPECT_FALSE(context->info().renderer.empty());
}

TEST(TestContext, IsTheOneThatTheEnvironmentNamesHereAndInThePrograms) {
  Environment environment;
  environment.set("VESTIGE_TEST_DEVICE", "");
  environment.set("VESTIGE_TEST_CONTEXT", "");
  EXPECT_EQ(test::make_context()->info().context, "egl-surfaceless");
  EXPECT_EQ(test::gl_flags(), "");
  EXPECT_EQ(test::gl_flags("osmesa"), " --context osmesa");
  environment.set("VESTIGE_TEST_CONTEXT", "osmesa");
  EXPECT_EQ(test::make_context()->info().context, "osmesa");
  EXPECT_EQ(test::gl_flags(), " --context osmesa");
  environment.set("VESTIGE_TEST_CONTEXT", "egl");
  EXPECT_THAT(test::make_context()->info().context, StartsWith("egl"));
  EXPECT_EQ(test::gl_flags("osmesa"), " --context egl");
  environment.set("VESTIGE_TEST_DEVICE", "0");
  EXPECT_EQ(test::make_context()->info().context, "egl-device-0");
  EXPECT_EQ(test::gl_flags(), " --context egl --device 0");
}

TEST(TestContext, ThatIsNoneIsRefusedWithTheWordsThatAreAllowed) {
  Environment environment;
  environment.set("VESTIGE_TEST_DEVICE", "");
  environment.set("VESTIGE_TEST_CONTEXT", "gpu");
  const auto refusal = [] { return test::message_of([] { test::make_context(); }); };
  EXPECT_THAT(refusal(), AllOf(HasSubstr("VESTIGE_TEST_CONTEXT: 'gpu'"), HasSubstr("auto, egl or osmesa")));
  environment.set("VESTIGE_TEST_CONTEXT", "");
  environment.set("VESTIGE_TEST_DEVICE", "1st");
  EXPECT_THAT(refusal(), HasSubstr("VESTIGE_TEST_DEVICE: '1st'"));
  environment.set("VESTIGE_TEST_CONTEXT", "osmesa");
  environment.set("VESTIGE_TEST_DEVICE", "0");
  EXPECT_THAT(refusal(), HasSubstr("VESTIGE_TEST_DEVICE: '0'"));
}

/// A test that makes a context of its own tests no GPU. It says why, at most three lines above.
TEST(TestContext, IsMadeNowhereElseWithoutAReason) {
  const std::regex maker("make_(egl_surfaceless|egl_device|osmesa|gl)_context|--context (egl|osmesa)");
  const std::filesystem::path tests = std::filesystem::path(VESTIGE_SOURCE_DIR) / "tests";
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(tests)) {
    const std::filesystem::path file = entry.path();
    if (file.extension() != ".cpp" && file.extension() != ".hpp") continue;
    if (file.stem() == "gl_context" || file.stem() == "gl_context_test") continue;
    std::istringstream lines(read_text_file(file));
    constexpr int kNever = -100;
    int reason = kNever;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      if (line.find("// own context: ") != std::string::npos) reason = number;
      if (!std::regex_search(line, maker)) continue;
      ++found;
      EXPECT_LE(number - reason, 3) << file << ":" << number << ": take test::make_context or test::gl_flags";
    }
  }
  EXPECT_GT(found, 5U);
}

TEST(GlMessages, ArePrintedWithTypeAndSeverityWhereTheEnvironmentWantsThem) {
  const auto said_by = [](ContextKind kind) {
    testing::internal::CaptureStderr();
    const auto context = make_gl_context(kind, -1);
    context->gl().Enable(0x7FFFFFFF);
    context->gl().Enable(0x7FFFFFFF);
    context->gl().Finish();
    return testing::internal::GetCapturedStderr();
  };
  Environment environment;
  for (const char* off : {"", "0"}) {
    environment.set("VESTIGE_GL_DEBUG", off);
    EXPECT_THAT(said_by(ContextKind::kEgl), IsEmpty());
  }
  environment.set("VESTIGE_GL_DEBUG", "1");
  const std::string said = said_by(ContextKind::kEgl);
  EXPECT_THAT(said, StartsWith("OpenGL debug: marker, notification: messages of egl"));
  EXPECT_THAT(said, HasSubstr("OpenGL debug: error, high: GL_INVALID_ENUM"));
  EXPECT_EQ(said.find("GL_INVALID_ENUM"), said.rfind("GL_INVALID_ENUM")) << "the same text twice: " << said;
  EXPECT_THAT(said_by(ContextKind::kOsMesa), StartsWith("OpenGL debug: marker, notification: messages of osmesa"));
}

}  // namespace
}  // namespace vestige
