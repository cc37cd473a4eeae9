#pragma once

#include <string>

#include "detector/gl/gl_functions.hpp"

namespace vestige {

/// Returns whether the environment asks for the driver's messages: VESTIGE_GL_DEBUG is set, and neither empty nor "0".
bool gl_messages_wanted();

/// From now on, what the driver of the current context says (KHR_debug) goes to standard error. Each text is printed
/// once in a process: "OpenGL debug: error, high: GL_INVALID_ENUM in glEnable". The first line is a marker with the
/// name of the context. Its absence shows that this driver passes no messages on.
void print_gl_messages(const GlFunctions& gl, const std::string& context);

}  // namespace vestige
