#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/scene/scene_moments.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "cli/facing_flag.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/files/output_file.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// The options of the command line, for every kind of figure.
struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string avatar;
  cli::FacingChoice facing;
  std::string map;
  std::size_t person = 0;  ///< counted from 1; 0: not chosen
  std::filesystem::path contacts;
  std::filesystem::path measured;
  std::string actuators;
  std::string animation;
  std::size_t poses = 6;
  MomentChoice moments;
  double trail_ms = 100;
  std::string colour_by = "kind";
  LawFlags law;
  double rate_hz = 60;
  std::uint64_t every = 0;  ///< 0: by `rate_hz`
  std::size_t top = 12;
  std::string counts;
  std::string speed = "1";
  double film_rate_hz = 25;
  double film_trail_ms = 150;
  std::size_t film_width = 640;
  std::string view = "auto";
  std::string method = "static";
  bool force = false;
  bool quiet = false;
};

inline Overwrite overwrite_of(const Options& options) {
  return options.force ? Overwrite::kAllow : Overwrite::kRefuse;
}

/// Prints "vestige: warning: …" to standard error; with -q, prints nothing.
void warn(const Options& options, std::string_view text);
void warn(const Options& options, const std::vector<std::string>& texts);

/// Warns of all that is doubtful about a subject.
void warn_of(const Options& options, const Subject& subject);

/// Reads all people of a trace, the input, and warns of what is doubtful about them. Throws `UsageError` if --map is
/// given for several.
std::vector<Subject> read_people(const Options& options, const TraceReader& trace);

/// Warns of what is wrong with the input, a trace that was read to its end. Returns its part of the exit code.
int report_damage(const Options& options, const TraceReader& trace);

/// Writes a file and prints its path, unless -q is given.
void write_file(const Options& options, const std::filesystem::path& path, std::string_view bytes);

/// Writes STEM.svg and STEM.png. Without OpenGL, it leaves out the PNG and returns `cli::kDataLost`.
int write_figure(const Options& options, const std::filesystem::path& stem,
                 const std::function<std::unique_ptr<Figure>()>& make_figure);

/// Returns OUT of `-o OUT`, without .svg or .png. Without -o, returns the input's name without its extension.
std::filesystem::path stem_of(const Options& options);

}  // namespace vestige::plot
