#include "analysis/plot/film/film.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <thread>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/duty_raster.hpp"
#include "analysis/plot/canvas/figure_export.hpp"
#include "analysis/plot/film/duty_columns.hpp"
#include "analysis/plot/film/felt_trace.hpp"
#include "analysis/plot/film/film_figure.hpp"
#include "analysis/plot/film/webp_animation.hpp"
#include "analysis/plot/scene/crowd.hpp"
#include "analysis/plot/scene/moment_picture.hpp"
#include "analysis/plot/scene/trails.hpp"

namespace vestige::plot {

namespace {

constexpr Colour kIdle = {238, 238, 238};  ///< of a motor in the timeline
/// Lines and marks of the scene are this much larger than in printed figures, of which several stand on a page.
constexpr double kScenePt = 1.5;
/// What scenes that are painted at a time may hold in memory.
constexpr double kMostSceneBytes = 2e9;

Camera camera_of(const std::vector<Subject>& people, const FilmOptions& options) {
  const double azimuth_degrees =
      options.azimuth_degrees.value_or(people.size() > 1 ? kAzimuthOfSeveralDegrees : kAzimuthDegrees);
  return Camera::from(azimuth_degrees, kElevationDegrees, people.front().avatar.facing.axis);
}

/// Returns nothing if `go_on` returned false.
std::optional<Raster> draw_duties(FeltTrace& felt, const FilmPlan& plan, const FilmLayout& layout,
                                  const std::vector<FilmLine>& lines, const std::function<bool()>& go_on) {
  if (lines.empty()) return Raster(1, 1, kIdle);
  DutyColumns columns(lines.size(), layout.timeline_width_dots(), plan.begin_s, plan.end_s);
  felt.rewind();
  while (felt.next()) {
    if (!go_on()) return {};
    columns.add(felt.frame().time_s(), felt.duty());
    if (felt.frame().index == plan.last_frame) break;
  }
  columns.finish();
  return duty_raster(columns.highest(), layout.timeline_width_dots(), layout.timeline_height_dots(),
                     [&](std::size_t actuator, std::uint8_t duty) {
                       return blend(kIdle, lines[actuator].colour, duty / double{kFullDuty});
                     });
}

/// How long contacts are shown. Two pictures at least: then one that came right after the picture before is still half
/// to be seen.
double fade_of(const FilmOptions& options) {
  return std::max(options.trail_s, 2 * options.span.speed / options.span.rate_hz);
}

/// The memory that painting a scene takes: there are 9 samples in a dot.
double scene_bytes(const FilmLayout& layout) {
  return 40.0 * 9 * static_cast<double>(layout.width_dots()) * static_cast<double>(layout.body_height_dots());
}

/// Returns how many scenes are painted at a time.
std::size_t scenes_at_a_time(const FilmLayout& layout) {
  const auto fitting = static_cast<std::size_t>(kMostSceneBytes / scene_bytes(layout));
  return std::max<std::size_t>(1, std::min<std::size_t>(std::thread::hardware_concurrency(), fitting));
}

FilmSheet sheet_of(const std::vector<Subject>& people, const FilmPlan& plan, const FilmOptions& options) {
  FilmSheet sheet;
  sheet.title = people.front().title;
  sheet.speed = options.span.speed;
  sheet.step_s = options.span.speed / options.span.rate_hz;
  sheet.fade_s = fade_of(options);
  sheet.follows = plan.sight.follows;
  sheet.lines = film_lines(people);
  sheet.begin_s = plan.begin_s;
  sheet.end_s = plan.end_s;
  return sheet;
}

/// What is gathered between one picture and the next.
class Moments {
 public:
  Moments(const FilmOptions& options, std::size_t duties)
      : fade_s_(fade_of(options)), trails_(options.trail_s), duty_(duties) {}

  void add(const FeltTrace& felt) {
    const double time_s = felt.frame().time_s();
    trails_.add(felt.frame());
    contacts_.insert(contacts_.end(), felt.contacts().begin(), felt.contacts().end());
    while (!contacts_.empty() && time_s - contacts_.front().time_s > fade_s_) contacts_.pop_front();
    for (std::size_t i = 0; i < duty_.size(); ++i) duty_[i] = std::max(duty_[i], felt.duty()[i]);
  }

  Moment moment_of(const TraceFrame& frame) const {
    const double time_s = frame.time_s();
    return {frame.index, time_s, frame.poses, trails_.paths(time_s), {contacts_.begin(), contacts_.end()}};
  }

  /// Returns the highest duties since the last call.
  std::vector<std::uint8_t> take_duty() { return std::exchange(duty_, std::vector<std::uint8_t>(duty_.size())); }

 private:
  double fade_s_;
  Trails trails_;
  std::deque<RecordedContact> contacts_;
  std::vector<std::uint8_t> duty_;
};

/// Draws the scene of a picture.
class ScenePainter {
 public:
  ScenePainter(const std::vector<Subject>& people, const FilmPlan& plan, const FilmLayout& layout,
               const FilmOptions& options)
      : people_(people), plan_(plan), layout_(layout), poser_(people) {
    style_.trail_s = options.trail_s;
    style_.fade_s = fade_of(options);
    style_.marks = ContactMarks::kFading;
    style_.borders = Borders::kRegions;  // two motors that run have the same colour
    style_.dots_per_pt = kScenePt * layout.dots_per_pt();
    style_.path_colours = {kBlue};
    style_.contact_colours = {kVermillion};
    for (const Subject& person : people) {
      first_duty_.push_back(duties_);
      duties_ += person.map.actuator_count;
    }
  }

  /// The number of actuators.
  std::size_t duties() const { return duties_; }

  Raster paint(const Moment& moment, const std::vector<std::uint8_t>& duty) const {
    const Crowd crowd = poser_.pose(moment.poses, plan_.origin_m);
    const View view =
        plan_.sight.view_of(crowd.surface, layout_.width_dots(), layout_.body_height_dots(), layout_.m_per_dot());
    const Skin skin = {people_, [&](std::size_t person, std::uint16_t actuator) {
                         const Colour region = region_skin(people_[person], actuator);
                         if (actuator == 0) return region;
                         const std::uint8_t own = duty[first_duty_[person] + actuator - 1];
                         return blend(region, kRunning, own / double{kFullDuty});
                       }};
    return moment_picture(moment, crowd, plan_.sight, view, style_, skin);
  }

 private:
  const std::vector<Subject>& people_;
  const FilmPlan& plan_;
  const FilmLayout& layout_;
  CrowdPoser poser_;
  MomentStyle style_;
  std::vector<std::size_t> first_duty_;  ///< of each person
  std::size_t duties_ = 0;
};

/// Draws pictures and adds them to the animation in their order. Scenes of several pictures are painted at a time.
class PictureLine {
 public:
  /// `most`: so many scenes at a time.
  PictureLine(const ScenePainter& painter, std::size_t most, FilmFigure& figure, FigureScreen& screen,
              WebpAnimation& animation)
      : painter_(painter), most_(most), figure_(figure), screen_(screen), animation_(animation) {}

  void add(int time_ms, Moment moment, std::vector<std::uint8_t> duty) {
    if (waiting_.size() >= most_) finish_one();
    Waiting& next = waiting_.emplace_back(Waiting{time_ms, std::move(moment), std::move(duty), {}});
    next.scene = std::async(std::launch::async, [this, &next] { return painter_.paint(next.moment, next.duty); });
  }

  void finish() {
    while (!waiting_.empty()) finish_one();
  }

 private:
  struct Waiting {
    int time_ms = 0;
    Moment moment;
    std::vector<std::uint8_t> duty;
    std::future<Raster> scene;  // last: its end waits for what uses the others
  };

  void finish_one() {
    Waiting& first = waiting_.front();
    figure_.show(first.moment.time_s, first.scene.get(), first.duty);
    animation_.add(screen_.raster_of(figure_), first.time_ms);
    waiting_.pop_front();
  }

  const ScenePainter& painter_;
  std::size_t most_;
  FilmFigure& figure_;
  FigureScreen& screen_;
  WebpAnimation& animation_;
  std::deque<Waiting> waiting_;
};

int milliseconds_of(std::uint64_t periods, const FilmSpan& span) {
  return static_cast<int>(std::lround(static_cast<double>(periods) / span.rate_hz * 1000));
}

}  // namespace

std::optional<Film> make_film(TraceReader& trace, const std::vector<Subject>& people, const FilmOptions& options,
                              std::string_view name, const std::function<bool(double)>& progress) {
  FigureScreen screen(FilmLayout::dots_per_inch(options.width_dots));
  FeltTrace felt(trace, people, options.law, options.method);
  const auto go_on = [&] { return progress(0); };
  const std::optional<FilmPlan> plan = plan_film(trace, people, options.span, camera_of(people, options), name, go_on);
  if (!plan) return {};
  const FilmSheet sheet = sheet_of(people, *plan, options);
  const FilmLayout layout(options.width_dots, plan->sight, sheet.lines);
  std::optional<Raster> duties = draw_duties(felt, *plan, layout, sheet.lines, go_on);
  if (!duties) return {};
  FilmFigure figure(sheet, layout, std::move(*duties));
  const ScenePainter painter(people, *plan, layout, options);
  Moments moments(options, painter.duties());
  FilmClock clock(options.span);
  WebpAnimation animation(layout.width_dots(), layout.height_dots());
  PictureLine line(painter, scenes_at_a_time(layout), figure, screen, animation);
  Film film;
  felt.rewind();
  while (felt.next()) {
    if (!progress(static_cast<double>(film.pictures) / static_cast<double>(plan->pictures))) return {};
    const TraceFrame& frame = felt.frame();
    moments.add(felt);
    if (frame.time_s() < plan->begin_s) {
      moments.take_duty();  // what was felt before the film
      continue;
    }
    film.contacts += felt.contacts().size();
    const bool is_last = frame.index == plan->last_frame;
    std::optional<std::uint64_t> period = clock.period_of(frame.time_s());
    if (!period && is_last) period = clock.last_period();
    if (period) {
      line.add(milliseconds_of(*period, options.span), moments.moment_of(frame), moments.take_duty());
      ++film.pictures;
    }
    if (is_last) break;
  }
  line.finish();
  film.notes = felt.notes();
  film.length_s = static_cast<double>(plan->periods) / options.span.rate_hz;
  film.webp = animation.finish(milliseconds_of(plan->periods, options.span));
  return film;
}

}  // namespace vestige::plot
