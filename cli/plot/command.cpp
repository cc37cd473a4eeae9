#include "cli/plot/command.hpp"

#include <fmt/format.h>

#include "analysis/plot/canvas/figure_export.hpp"
#include "analysis/plot/canvas/headless_window.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"

namespace vestige::plot {

void warn(const Options& options, std::string_view text) {
  if (!options.quiet) print_message(fmt::format("vestige: warning: {}\n", text));
}

void warn(const Options& options, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) warn(options, text);
}

void warn_of(const Options& options, const Subject& subject) {
  warn(options, subject.avatar.warnings);
  warn(options, subject.map.warnings);
  warn(options, subject.warnings);
}

std::vector<Subject> read_people(const Options& options, const TraceReader& trace) {
  const std::filesystem::path& input = options.inputs.front();
  if (trace.people().size() > 1 && !options.map.empty())
    throw UsageError("--map", fmt::format("{} holds several people", input.string()), "leave --map out");
  std::vector<Subject> people;
  for (std::size_t i = 0; i < trace.people().size(); ++i)
    warn_of(options, people.emplace_back(read_subject(trace, input, options.map, i)));
  return people;
}

int report_damage(const Options& options, const TraceReader& trace) {
  if (trace.complete()) return cli::kDone;
  warn(options, damage_of(trace, options.inputs.front().string()));
  return cli::kDataLost;
}

void write_file(const Options& options, const std::filesystem::path& path, std::string_view bytes) {
  OutputFile file(path, overwrite_of(options));
  file.write(bytes);
  file.commit();
  if (!options.quiet) print_message(fmt::format("wrote {}\n", path.string()));
}

int write_figure(const Options& options, const std::filesystem::path& stem,
                 const std::function<std::unique_ptr<Figure>()>& make_figure) {
  const std::filesystem::path svg = stem.string() + ".svg";
  const std::filesystem::path png = stem.string() + ".png";
  refuse_overwrite(svg, overwrite_of(options));
  refuse_overwrite(png, overwrite_of(options));
  const std::unique_ptr<Figure> figure = make_figure();
  write_file(options, svg, svg_of(*figure));
  try {
    write_file(options, png, png_of(*figure));
  } catch (const GlUnavailable& error) {
    warn(options, fmt::format("{}: left out: {}\n  install libegl1 and libgl1-mesa-dri, or convert the SVG: "
                              "rsvg-convert -d 300 -p 300",
                              png.string(), error.what()));
    return cli::kDataLost;
  }
  return cli::kDone;
}

std::filesystem::path stem_of(const Options& options) {
  std::filesystem::path stem = options.output;
  if (stem.empty()) return std::filesystem::path(options.inputs.front()).replace_extension();
  if (stem.extension() == ".svg" || stem.extension() == ".png") stem.replace_extension();
  return stem;
}

}  // namespace vestige::plot
