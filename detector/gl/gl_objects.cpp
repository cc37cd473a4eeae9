#include "detector/gl/gl_objects.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr const char* kFaultRemedy =
    "this is a bug in Vestige or in the GL driver: try another --context, and report it";

/// Returns the info log of a shader or a program, depending on the two functions.
template <typename GetIv, typename GetLog>
std::string info_log(GLuint name, GetIv get_iv, GetLog get_log) {
  GLint length = 0;
  get_iv(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  get_log(name, length, nullptr, log.data());
  return log.substr(0, log.find('\0'));
}

}  // namespace

GlBuffer::GlBuffer(const GlFunctions& gl) : gl_(gl) {
  gl_.CreateBuffers(1, &name_);
}

GlBuffer::~GlBuffer() {
  gl_.DeleteBuffers(1, &name_);
}

void GlBuffer::upload(const void* data, std::size_t bytes, GLenum usage) {
  if (bytes > capacity_bytes_) {
    gl_.NamedBufferData(name_, static_cast<GLsizeiptr>(bytes), data, usage);
    capacity_bytes_ = bytes;
  } else if (data != nullptr && bytes != 0) {
    gl_.NamedBufferSubData(name_, 0, static_cast<GLsizeiptr>(bytes), data);
  }
}

GlMappedBuffer::GlMappedBuffer(const GlFunctions& gl, std::size_t bytes) : gl_(gl) {
  constexpr GLbitfield kShared = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto size = static_cast<GLsizeiptr>(bytes);
  gl_.CreateBuffers(1, &name_);
  const std::vector<std::byte> zeros(bytes);
  gl_.NamedBufferStorage(name_, size, zeros.data(), kShared);
  data_ = static_cast<std::byte*>(gl_.MapNamedBufferRange(name_, 0, size, kShared));
  if (data_ != nullptr) return;
  gl_.DeleteBuffers(1, &name_);
  for (int i = 0; i < 2; ++i) gl_.GetError();  // of the two calls: whoever checks later must not report them again
  throw Error("OpenGL", fmt::format("the driver does not share {} bytes with shaders", bytes), kFaultRemedy);
}

GlMappedBuffer::~GlMappedBuffer() {
  gl_.DeleteBuffers(1, &name_);
}

GlProgram::GlProgram(const GlFunctions& gl, std::string_view head, std::initializer_list<Stage> stages,
                     std::string_view captured)
    : gl_(gl), name_(gl.CreateProgram()) {
  std::vector<GLuint> shaders;
  std::string failure;
  for (const Stage& stage : stages) {
    const GLuint shader = gl_.CreateShader(stage.type);
    shaders.push_back(shader);
    const std::array<const GLchar*, 2> sources = {head.data(), stage.source.data()};
    const std::array<GLint, 2> lengths = {static_cast<GLint>(head.size()), static_cast<GLint>(stage.source.size())};
    gl_.ShaderSource(shader, 2, sources.data(), lengths.data());
    gl_.CompileShader(shader);
    GLint compiled = GL_FALSE;
    gl_.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE && failure.empty())
      failure = fmt::format("{}: {}", stage.file, info_log(shader, gl_.GetShaderiv, gl_.GetShaderInfoLog));
    gl_.AttachShader(name_, shader);
  }
  if (failure.empty()) {
    if (!captured.empty()) {
      const std::string varying(captured);
      const GLchar* varyings = varying.c_str();
      gl_.TransformFeedbackVaryings(name_, 1, &varyings, GL_INTERLEAVED_ATTRIBS);
    }
    gl_.LinkProgram(name_);
    GLint linked = GL_FALSE;
    gl_.GetProgramiv(name_, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE)
      failure = fmt::format("linking: {}", info_log(name_, gl_.GetProgramiv, gl_.GetProgramInfoLog));
  }
  for (const GLuint shader : shaders) gl_.DeleteShader(shader);  // kept alive by the program
  if (failure.empty()) return;
  gl_.DeleteProgram(name_);
  throw Error("OpenGL", "the driver does not accept a shader: " + failure, kFaultRemedy);
}

GlProgram::~GlProgram() {
  gl_.DeleteProgram(name_);
}

void await_fence(const GlFunctions& gl, GLsync fence, FenceWait how) {
  constexpr GLuint64 kSecond_ns = 1000000000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED)
    state = gl.ClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, how == FenceWait::kActive ? 0 : kSecond_ns);
  gl.DeleteSync(fence);
  if (state == GL_WAIT_FAILED)
    throw Error("OpenGL", "the driver cannot wait for its own work", "try another --context");
}

GLint gl_limit(const GlFunctions& gl, GLenum name) {
  GLint value = 0;
  gl.GetIntegerv(name, &value);
  return value;
}

void check_gl(const GlFunctions& gl, std::string_view doing) {
  const GLenum error = gl.GetError();
  if (error == GL_NO_ERROR) return;
  const char* remedy = error == GL_OUT_OF_MEMORY ? "use fewer colliders or a smaller avatar" : kFaultRemedy;
  throw Error("OpenGL", fmt::format("error {:#06x} while {}", error, doing), remedy);
}

}  // namespace vestige
