#include "detector/gl/draw_timer.hpp"

#include <chrono>

#include "detector/gl/gl_context.hpp"

namespace vestige {

DrawTimer::~DrawTimer() {
  if (query_ != 0) gl_.DeleteQueries(1, &query_);
}

void DrawTimer::begin(StageClock& clock) {
  if (query_ == 0) {
    gl_.CreateQueries(GL_TIME_ELAPSED, 1, &query_);
    GLint counter_bits = 0;
    gl_.GetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &counter_bits);
    const GLubyte* renderer = gl_.GetString(GL_RENDERER);
    has_timer_ = counter_bits > 0 && !is_software_renderer(reinterpret_cast<const char*>(renderer));
  }
  clock.enter(Stage::kDraw);
  if (has_timer_) gl_.BeginQuery(GL_TIME_ELAPSED, query_);
}

void DrawTimer::end(StageClock& clock) {
  if (has_timer_) {
    gl_.EndQuery(GL_TIME_ELAPSED);
    gl_.Finish();
  }
  const std::chrono::nanoseconds wall = clock.leave();
  GLuint64 drawn_ns = 0;
  if (has_timer_) gl_.GetQueryObjectui64v(query_, GL_QUERY_RESULT, &drawn_ns);
  clock.note_draw(wall, std::chrono::nanoseconds(drawn_ns));
}

}  // namespace vestige
