#include "analysis/plot/film/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/plot/canvas/headless_window.hpp"
#include "cli/options.hpp"
#include "cli/plot/command.hpp"
#include "cli/plot/draw.hpp"
#include "cli/terminal.hpp"
#include "detector/method.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

namespace {

constexpr double kSlowest = 0.001;
constexpr double kFastest = 1000;

std::optional<double> number_in(const std::string& text) {
  const std::vector<double> numbers = cli::parse_numbers(text);
  if (numbers.size() != 1) return {};
  return numbers.front();
}

/// A number, or a fraction.
double parse_speed(const std::string& text) {
  const std::size_t bar = text.find('/');
  const std::optional<double> above = number_in(text.substr(0, bar));
  const std::optional<double> below = bar == std::string::npos ? 1 : number_in(text.substr(bar + 1));
  const double speed = above && below ? *above / *below : 0;
  if (speed >= kSlowest && speed <= kFastest) return speed;
  throw UsageError("--speed", fmt::format("'{}' is no speed", text),
                   "give a number from 0.001 to 1000, or a fraction such as 1/10");
}

std::filesystem::path output_of(const Options& options) {
  const std::filesystem::path& input = options.inputs.front();
  if (options.output.empty()) {
    if (input == "-") throw UsageError("-o", "a trace from standard input has no name", "name -o FILE.webp");
    return std::filesystem::path(input).replace_extension().string() + "-film.webp";
  }
  if (options.output.extension() != ".webp")
    throw UsageError("-o", fmt::format("'{}' does not end in .webp", options.output.string()),
                     "a film is an animated WebP image: name -o FILE.webp");
  return options.output;
}

FilmOptions film_options(const Options& options) {
  FilmOptions film;
  film.span = {options.moments.from_s, options.moments.to_s, parse_speed(options.speed), options.film_rate_hz};
  require_order(film.span.from_s, film.span.to_s);
  static const std::map<std::string, double> sides = {{"front", 0}, {"left", 90}, {"back", 180}, {"right", -90}};
  if (const auto side = sides.find(options.view); side != sides.end()) film.azimuth_degrees = side->second;
  film.trail_s = options.film_trail_ms / 1000;
  film.width_dots = options.film_width;
  film.law = options.law;
  film.law.check();
  film.method = method_named(options.method);
  return film;
}

/// Warns if there is no motor that contacts could drive. Otherwise throws `Error` if the law cannot be felt.
void check_law(const Options& options, TraceReader& trace, const std::vector<Subject>& people) {
  const bool anybody_feels =
      std::ranges::any_of(people, [](const Subject& person) { return person.map.actuator_count != 0; });
  if (anybody_feels)
    require_spheres(std::span(&options.law.law, 1), trace.has_spheres(), options.inputs.front().string());
  else
    warn(options, "there is no actuator map, so no motor runs");
}

/// Nothing is returned if the user has stopped it.
std::optional<Film> film_of(const Options& options, TraceReader& trace, const std::vector<Subject>& people,
                            const std::filesystem::path& output) {
  cli::Progress progress("film", options.quiet ? cli::Verbosity::kQuiet : cli::Verbosity::kNormal);
  try {
    return make_film(trace, people, film_options(options), options.inputs.front().string(),
                     [&](double share) { return progress.update(share); });
  } catch (const GlUnavailable& error) {
    throw Error(output.string(), fmt::format("cannot be drawn: {}", error.what()),
                "install libegl1 and libgl1-mesa-dri");
  }
}

}  // namespace

int draw_film(const Options& options) {
  const std::string input = options.inputs.front().string();
  const std::filesystem::path output = output_of(options);
  film_options(options);  // refuses what is wrong before the trace is read
  refuse_overwrite(output, overwrite_of(options));
  TraceReader trace(input, People::kSeveral);
  const std::vector<Subject> people = read_people(options, trace);
  check_law(options, trace, people);
  require_frames(trace, input);
  cli::catch_interrupts();
  const std::optional<Film> film = film_of(options, trace, people, output);
  if (!film) throw Error(output.string(), cli::kStopped, cli::kStartAgain);
  const int damage = report_damage(options, trace);
  for (const std::string& note : film->notes) warn(options, fmt::format("{}: {}", input, note));
  OutputFile file(output, overwrite_of(options));
  file.write(film->webp);
  file.commit();
  if (!options.quiet)
    print_message(fmt::format("wrote {}: {}, {:.3g} s, {}, {:.2g} MB\n", output.string(),
                              counted(film->pictures, "picture"), film->length_s, counted(film->contacts, "contact"),
                              static_cast<double>(film->webp.size()) / 1e6));
  return film->notes.empty() ? damage : cli::kDataLost;
}

}  // namespace vestige::plot
