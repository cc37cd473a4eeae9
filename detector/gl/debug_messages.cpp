#include "detector/gl/debug_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace vestige {

namespace {

const char* name_of_type(GLenum type) {
  switch (type) {
    case GL_DEBUG_TYPE_ERROR:
      return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
      return "deprecated";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
      return "undefined behaviour";
    case GL_DEBUG_TYPE_PORTABILITY:
      return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE:
      return "performance";
    case GL_DEBUG_TYPE_MARKER:
      return "marker";
    default:
      return "other";
  }
}

const char* name_of_severity(GLenum severity) {
  switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
      return "high";
    case GL_DEBUG_SEVERITY_MEDIUM:
      return "medium";
    case GL_DEBUG_SEVERITY_LOW:
      return "low";
    default:
      return "notification";
  }
}

// NOLINTNEXTLINE(readability-function-size): OpenGL's signature
void APIENTRY print_message(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length,
                            const GLchar* message, const void* /*unused*/) {
  // A driver may give no length, and may call from a thread of its own.
  std::string text = length < 0 ? std::string(message) : std::string(message, static_cast<std::size_t>(length));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  const std::string line =
      fmt::format("OpenGL debug: {}, {}: {}\n", name_of_type(type), name_of_severity(severity), text);
  static std::mutex mutex;
  static std::set<std::string> printed;
  const std::lock_guard lock(mutex);
  if (printed.insert(line).second) std::fputs(line.c_str(), stderr);
}

}  // namespace

bool gl_messages_wanted() {
  const char* text = std::getenv("VESTIGE_GL_DEBUG");
  return text != nullptr && *text != '\0' && std::string_view(text) != "0";
}

void print_gl_messages(const GlFunctions& gl, const std::string& context) {
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.DebugMessageCallback(print_message, nullptr);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  gl.DebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_MARKER, 0, GL_DEBUG_SEVERITY_NOTIFICATION, -1,
                        ("messages of " + context + " follow").c_str());
}

}  // namespace vestige
