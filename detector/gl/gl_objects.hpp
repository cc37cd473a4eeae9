#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "detector/gl/gl_functions.hpp"

namespace vestige {

/// A buffer object for repeated uploads. It grows if needed and never shrinks. It belongs to the context whose
/// functions it was made with. That context must be current at every call.
class GlBuffer {
 public:
  explicit GlBuffer(const GlFunctions& gl);
  ~GlBuffer();
  GlBuffer(const GlBuffer&) = delete;
  GlBuffer& operator=(const GlBuffer&) = delete;

  /// `data` may be null. Then the content is undefined.
  void upload(const void* data, std::size_t bytes, GLenum usage);
  GLuint name() const { return name_; }

 private:
  const GlFunctions& gl_;
  GLuint name_ = 0;
  std::size_t capacity_bytes_ = 0;
};

/// Memory of a fixed size that the CPU and the shaders share. What the CPU wrote is there for the next command; what
/// shaders wrote is there after a barrier (GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT) and a fence. It starts as zeros. The
/// context must be current at the construction and the destruction.
class GlMappedBuffer {
 public:
  GlMappedBuffer(const GlFunctions& gl, std::size_t bytes);
  ~GlMappedBuffer();
  GlMappedBuffer(const GlMappedBuffer&) = delete;
  GlMappedBuffer& operator=(const GlMappedBuffer&) = delete;

  GLuint name() const { return name_; }
  std::byte* data() const { return data_; }

 private:
  const GlFunctions& gl_;
  GLuint name_ = 0;
  std::byte* data_ = nullptr;
};

/// A linked program. Its context must be current at the destruction.
class GlProgram {
 public:
  struct Stage {
    GLenum type;
    std::string_view file;  ///< name for error messages
    std::string_view source;
  };

  /// Puts `head` (#version, defines) in front of every stage. `captured`, unless empty, is the one varying that
  /// transform feedback captures. Throws `Error` with the compiler's message.
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

/// kAsleep: the system wakes the thread. kActive: the thread asks again and again, as a GPU is done before the system
/// would wake it.
enum class FenceWait { kAsleep, kActive };

/// Waits until the work before a fence is done, and deletes the fence. Throws `Error` if the driver cannot wait.
void await_fence(const GlFunctions& gl, GLsync fence, FenceWait how);

/// Returns one of the driver's limits.
GLint gl_limit(const GlFunctions& gl, GLenum name);

/// Throws `Error` with the OpenGL error, if one occurred since the last call.
void check_gl(const GlFunctions& gl, std::string_view doing);

}  // namespace vestige
