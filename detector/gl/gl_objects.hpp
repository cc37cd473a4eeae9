#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "detector/gl/gl_functions.hpp"

namespace vestige {

/// A buffer object that is filled again and again: it grows when needed and is then kept. Belongs to the context whose
/// functions it was made with, which must be current.
class GlBuffer {
 public:
  explicit GlBuffer(const GlFunctions& gl);
  ~GlBuffer();
  GlBuffer(const GlBuffer&) = delete;
  GlBuffer& operator=(const GlBuffer&) = delete;

  /// `data` may be null: then the content is undefined.
  void upload(const void* data, std::size_t bytes, GLenum usage);
  GLuint name() const { return name_; }

 private:
  const GlFunctions& gl_;
  GLuint name_ = 0;
  std::size_t capacity_bytes_ = 0;
};

/// A linked program; deleted with its context current.
class GlProgram {
 public:
  struct Stage {
    GLenum type;
    std::string_view file;  ///< stands in errors
    std::string_view source;
  };

  /// Puts `head` (#version, defines) in front of every stage. `captured`, unless empty, is the one varying that
  /// transform feedback captures. Throws `Error` with the compiler's words.
  GlProgram(const GlFunctions& gl, std::string_view head, std::initializer_list<Stage> stages,
            std::string_view captured = {});
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;
  GLuint name() const { return name_; }

 private:
  const GlFunctions& gl_;
  GLuint name_ = 0;
};

/// One of the driver's limits.
GLint gl_limit(const GlFunctions& gl, GLenum name);

/// Throws `Error` naming the OpenGL error, if there was one since the last call.
void check_gl(const GlFunctions& gl, std::string_view doing);

}  // namespace vestige
