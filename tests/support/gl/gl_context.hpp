#pragma once

#include <charconv>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "detector/gl/gl_context.hpp"
#include "traces/base/error.hpp"

namespace vestige::test {

/// What the environment says about the context that tests run in. VESTIGE_TEST_CONTEXT has the words of --context,
/// VESTIGE_TEST_DEVICE the number of --device.
struct ContextChoice {
  std::string context;  ///< "auto", "egl", "osmesa"; empty if the environment says nothing
  int device = -1;
};

/// Throws `Error` with the words that are allowed if the environment has another one.
inline ContextChoice context_choice() {
  const auto value_of = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  ContextChoice choice = {value_of("VESTIGE_TEST_CONTEXT")};
  if (!choice.context.empty() && choice.context != "auto" && choice.context != "egl" && choice.context != "osmesa")
    throw Error("VESTIGE_TEST_CONTEXT", "'" + choice.context + "' is no context", "write auto, egl or osmesa");
  const std::string device = value_of("VESTIGE_TEST_DEVICE");
  if (device.empty()) return choice;
  const char* const end = device.data() + device.size();
  const auto [read_to, failure] = std::from_chars(device.data(), end, choice.device);
  if (failure != std::errc() || read_to != end || choice.device < 0 || choice.context == "osmesa")
    throw Error("VESTIGE_TEST_DEVICE", "'" + device + "' is no EGL device",
                "write its number in 'vestige devices', with the context auto or egl or none");
  if (choice.context.empty()) choice.context = "egl";
  return choice;
}

/// Makes the context that tests run in: the one that the environment names, otherwise EGL without a device. A test that
/// is about another context says so where it makes that.
inline std::unique_ptr<GlContext> make_context() {
  const ContextChoice choice = context_choice();
  if (choice.context.empty()) return make_egl_surfaceless_context();
  if (choice.context == "osmesa") return make_gl_context(ContextKind::kOsMesa, -1);
  return make_gl_context(choice.context == "egl" ? ContextKind::kEgl : ContextKind::kAuto, choice.device);
}

/// Returns the flags of `vestige` for the context that the environment names, after a space. If it names none, they are
/// " --context" and `otherwise`, or nothing: then the program chooses.
inline std::string gl_flags(std::string_view otherwise = "") {
  ContextChoice choice = context_choice();
  if (choice.context.empty()) choice.context = otherwise;
  std::string flags = choice.context.empty() ? "" : " --context " + choice.context;
  if (choice.device >= 0) flags += " --device " + std::to_string(choice.device);
  return flags;
}

}  // namespace vestige::test
