#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "tests/support/gl/gl_context.hpp"

namespace vestige::test {

/// Limits that a driver might have, by their GL_MAX_ names. A viewport has both of its sides from one number.
using Limits = std::map<GLenum, GLint>;

/// Whether a driver accepts the probe of its shaders' arithmetic.
enum class Probe { kAccepted, kRefused };

/// The context of all tests, but its driver says that some of its limits are lower. It clamps viewports, as drivers do.
/// It says that a program does not link whose head defines a SHARE_SEGMENTS above `largest_share`, or that is a probe
/// which it refuses, and why, on many lines. Only one may live at a time.
class LimitedContext final : public GlContext {
 public:
  static std::unique_ptr<GlContext> make(Limits limits, int largest_share = 1 << 30, Probe probe = Probe::kAccepted) {
    largest_share_ = largest_share;
    probe_ = probe;
    return loaded(std::unique_ptr<GlContext>(new LimitedContext(std::move(limits))), "limited");
  }
  ~LimitedContext() override { leave(); }

  /// Lets the driver of the latest of these contexts lose a dispatch or a draw: that after `others` more.
  static void lose_work_after(int others) { before_lost_ = others; }

  /// How many dispatches of compute shaders the latest of these contexts was asked for.
  static int dispatches() { return dispatches_; }

  /// Lets the driver of the latest of these contexts compile `to` wherever it is given `from`, and count how often.
  static void misread_shaders(std::string from, std::string to) {
    misread_ = std::move(from);
    misread_as_ = std::move(to);
  }
  static int times_misread() { return times_misread_; }

  /// The largest buffer that was ever made in the latest of these contexts.
  static GLsizeiptr largest_buffer_bytes() { return largest_buffer_bytes_; }

 private:
  explicit LimitedContext(Limits limits) : real_(make_context()) {
    limits_ = std::move(limits);
    real_functions_ = &real_->gl();
    largest_buffer_bytes_ = 0;
    before_lost_ = -1;
    misread_.clear();
    times_misread_ = 0;
    dispatches_ = 0;
  }

  void bind() override { real_->make_current(); }
  void unbind() override {}  // the next context takes its place
  void* address_of(const char* function) const override {
    const std::string_view name = function;
    if (name == "glGetIntegerv") return reinterpret_cast<void*>(get_integer);
    if (name == "glGetInteger64v") return reinterpret_cast<void*>(get_integer_64);
    if (name == "glViewport") return reinterpret_cast<void*>(viewport);
    if (name == "glNamedBufferData") return reinterpret_cast<void*>(named_buffer_data);
    if (name == "glDispatchCompute") return reinterpret_cast<void*>(dispatch_compute);
    if (name == "glDispatchComputeIndirect") return reinterpret_cast<void*>(dispatch_compute_indirect);
    if (name == "glDrawArrays") return reinterpret_cast<void*>(draw_arrays);
    if (name == "glShaderSource") return reinterpret_cast<void*>(shader_source);
    if (name == "glGetProgramiv") return reinterpret_cast<void*>(get_program);
    if (name == "glGetProgramInfoLog") return reinterpret_cast<void*>(get_program_log);
#define VESTIGE_TEST_FIND(type, member) \
  if (name == "gl" #member) return reinterpret_cast<void*>(real_->gl().member);
    VESTIGE_GL_FUNCTIONS(VESTIGE_TEST_FIND)
#undef VESTIGE_TEST_FIND
    return nullptr;
  }

  static void APIENTRY get_integer(GLenum name, GLint* value) {
    real_functions_->GetIntegerv(name, value);
    const auto limit = limits_.find(name);
    if (limit == limits_.end()) return;
    value[0] = limit->second;
    if (name == GL_MAX_VIEWPORT_DIMS) value[1] = limit->second;
  }
  static void APIENTRY get_integer_64(GLenum name, GLint64* value) {
    real_functions_->GetInteger64v(name, value);
    if (const auto limit = limits_.find(name); limit != limits_.end()) value[0] = limit->second;
  }

  static void APIENTRY viewport(GLint x, GLint y, GLsizei width, GLsizei height) {
    const auto limit = limits_.find(GL_MAX_VIEWPORT_DIMS);
    const GLsizei most = limit == limits_.end() ? std::max(width, height) : limit->second;
    real_functions_->Viewport(x, y, std::min(width, most), std::min(height, most));
  }
  static void APIENTRY named_buffer_data(GLuint buffer, GLsizeiptr bytes, const void* data, GLenum usage) {
    largest_buffer_bytes_ = std::max(largest_buffer_bytes_, bytes);
    real_functions_->NamedBufferData(buffer, bytes, data, usage);
  }

  static bool loses_work() {
    return before_lost_ >= 0 && before_lost_-- == 0;
  }
  static void APIENTRY dispatch_compute(GLuint x, GLuint y, GLuint z) {
    ++dispatches_;
    if (!loses_work()) real_functions_->DispatchCompute(x, y, z);
  }
  static void APIENTRY dispatch_compute_indirect(GLintptr offset) {
    ++dispatches_;
    if (!loses_work()) real_functions_->DispatchComputeIndirect(offset);
  }
  static void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count) {
    if (!loses_work()) real_functions_->DrawArrays(mode, first, count);
  }

  static void APIENTRY shader_source(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
    constexpr std::string_view kDefine = "#define SHARE_SEGMENTS ";
    const std::string head(texts[0], static_cast<std::size_t>(lengths[0]));
    const std::size_t place = head.find(kDefine);
    latest_is_probe_ = head.find("#define QUESTIONS ") != std::string::npos;
    latest_share_ = place == std::string::npos ? 0 : std::stoi(head.substr(place + kDefine.size()));
    std::string all;
    for (GLsizei i = 0; i < count; ++i) all.append(texts[i], static_cast<std::size_t>(lengths[i]));
    for (std::size_t at = 0; !misread_.empty() && (at = all.find(misread_, at)) != std::string::npos;
         at += misread_as_.size()) {
      all.replace(at, misread_.size(), misread_as_);
      ++times_misread_;
    }
    const GLchar* const text = all.c_str();
    const auto length = static_cast<GLint>(all.size());
    real_functions_->ShaderSource(shader, 1, &text, &length);
  }
  static bool is_refused() {
    return latest_share_ > largest_share_ || (latest_is_probe_ && probe_ == Probe::kRefused);
  }
  static std::string refusal() {
    std::string log = "0:7(2): error: this driver\n\ndoes not like it\n";
    for (int i = 0; i < 100; ++i) log += "0:8(1): error: nor the rest\n";
    return log;
  }
  static void APIENTRY get_program(GLuint program, GLenum name, GLint* value) {
    real_functions_->GetProgramiv(program, name, value);
    if (!is_refused()) return;
    if (name == GL_LINK_STATUS) *value = GL_FALSE;
    if (name == GL_INFO_LOG_LENGTH) *value = static_cast<GLint>(refusal().size()) + 1;
  }
  static void APIENTRY get_program_log(GLuint program, GLsizei size, GLsizei* length, GLchar* log) {
    if (!is_refused()) return real_functions_->GetProgramInfoLog(program, size, length, log);
    log[refusal().copy(log, static_cast<std::size_t>(size) - 1)] = '\0';
  }

  std::unique_ptr<GlContext> real_;
  // Functions of OpenGL have no place for more arguments.
  static inline Limits limits_;
  static inline const GlFunctions* real_functions_ = nullptr;
  static inline GLsizeiptr largest_buffer_bytes_ = 0;
  static inline int before_lost_ = -1;  // dispatches and draws; negative: none is lost
  static inline std::string misread_;
  static inline std::string misread_as_;
  static inline int times_misread_ = 0;
  static inline int dispatches_ = 0;
  static inline int largest_share_ = 0;
  static inline int latest_share_ = 0;
  static inline Probe probe_ = Probe::kAccepted;
  static inline bool latest_is_probe_ = false;
};

}  // namespace vestige::test
