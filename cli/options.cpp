#include "cli/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "cli/help/help_text.hpp"
#include "cli/help/suggest.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

namespace {

constexpr std::uint32_t kMostCounts = 100000;

template <typename Number>
bool parse_number(std::string_view text, Number& value) {
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size();
}

/// CLI11 itself would wrap -1 around.
const CLI::Validator kSeed(
    [](std::string& text) {
      std::uint64_t value = 0;
      return parse_number(text, value) ? std::string() : fmt::format("'{}' is not a whole number below 2^64", text);
    },
    "");

bool is_standard_output(const std::string& path) {
  return path == "-";
}

}  // namespace

void add_common_options(CLI::App& verb, CommonOptions& options) {
  const auto common = [](CLI::Option* option) { return option->group(help::kCommonGroup); };
  common(verb.add_option("--json", options.json, "Write the result as JSON to FILE, or '-' for standard output"))
      ->type_name("FILE|-");
  common(verb.add_flag("-q,--quiet", options.quiet, "Print errors only"));
  common(verb.add_flag("-v,--verbose", options.verbose, "Print more"));
  common(verb.add_flag("--force", options.force, "Overwrite existing files"));
  common(verb.add_option("--seed", options.seed,
                         "Seed of the random numbers that record, sweep, growth, stress, accuracy and batch use; other "
                         "verbs use none"))
      ->capture_default_str()
      ->check(kSeed);
  common(verb.set_help_flag("-h,--help", "Print this help"));
}

namespace {

/// Folders that this run made. At its end, those in which nothing was put go again.
class MadeFolders {
 public:
  ~MadeFolders() {
    std::error_code not_empty;
    for (const std::filesystem::path& folder : folders_) std::filesystem::remove(folder, not_empty);
  }
  /// To be called before `folder` is made.
  void expect(const std::filesystem::path& folder) {
    std::error_code ignored;
    for (auto path = folder; !path.empty() && !std::filesystem::exists(path, ignored); path = path.parent_path())
      folders_.push_back(std::filesystem::absolute(path, ignored));
  }

 private:
  std::vector<std::filesystem::path> folders_;  // inner ones first
};

}  // namespace

void make_output_folder(const std::string& path) {
  if (path == "-") throw UsageError("-o -", "the results are files in a folder", "name a folder");
  static MadeFolders made;
  made.expect(path);
  make_folder(path);
}

void refuse_too_many_frames(double frames, const char* flag, const char* remedy) {
  if (!(frames <= kMostTraceFrames))
    throw UsageError(
        flag, fmt::format("{:.3g} frames are requested, but a trace holds at most {:.0f}", frames, kMostTraceFrames),
        remedy);
}

void warn_of_frame_count(double frames, std::string_view way_out, Verbosity verbosity) {
  constexpr double kMany = 1e7;
  if (frames > kMany) warn(fmt::format("{:.0f} frames will take long; {}", frames, way_out), verbosity);
  if (frames < 1)
    warn(
        "--duration is shorter than a frame lasts at this --rate, so there is one frame, in which nothing moves; raise "
        "--duration or --rate",
        verbosity);
}

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   const CommonOptions& options) {
  if (std::ranges::count_if(outputs, is_standard_output) > 1)
    throw UsageError("-", "two results cannot share standard output", "give all but one a file name");
  std::set<std::filesystem::path> seen;
  for (const std::string& path : outputs) {
    if (path.empty()) continue;
    for (const std::string& input : inputs) {
      std::error_code missing;
      // A terminal may well be both read and written.
      if (is_standard_output(path) && !std::filesystem::is_regular_file(input, missing)) continue;
      if (std::filesystem::equivalent(is_standard_output(path) ? "/dev/stdout" : path, input, missing))
        throw UsageError(path, "this output would change an input file", "choose another name");
    }
    if (is_standard_output(path)) continue;
    refuse_overwrite(path, options.overwrite());
    if (!seen.insert(std::filesystem::absolute(where_it_leads(path)).lexically_normal()).second)
      throw UsageError(path, "two results cannot share one file", "give each a different name");
  }
}

std::optional<std::string> refusal_unless_forced(const std::vector<std::string>& outputs, const CommonOptions& options,
                                                 std::string_view accepted) {
  if (!options.force) return "add --force";
  for (const std::string& path : outputs) {
    std::error_code ignored;
    if (!path.empty() && !is_standard_output(path) && std::filesystem::exists(path, ignored))
      return fmt::format("choose a new name for {}: where --force overwrites a file, it does not {}", path, accepted);
  }
  return std::nullopt;
}

void check_inputs(const std::vector<std::string>& inputs) {
  if (std::ranges::count(inputs, "-") > 1)
    throw UsageError("-", "standard input can be read only once", "name standard input once");
}

void write_json(const std::string& path, const nlohmann::ordered_json& json, const CommonOptions& options) {
  if (path.empty()) return;
  OutputFile file(path, options.overwrite());
  file.write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file.commit();
}

void print_summary(std::string_view text, const std::vector<std::string>& output_paths, const CommonOptions& options) {
  if (options.quiet) return;
  std::FILE* out = std::ranges::any_of(output_paths, is_standard_output) ? stderr : stdout;
  const std::string shown = printable(text);
  if (std::fwrite(shown.data(), 1, shown.size(), out) == shown.size() && std::fflush(out) == 0) return;
  // `| head` has seen enough, however long the text is.
  if (errno != EPIPE) throw system_error("standard output", "could not write", errno);
}

std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : parse_list(text)) {
    double number = 0;
    if (!parse_number(part, number) || !std::isfinite(number)) return {};
    numbers.push_back(number);
  }
  return numbers;
}

glm::dvec3 parse_vector(const std::string& text, const std::string& flag) {
  const std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 3)
    throw UsageError(flag, fmt::format("'{}' is not X,Y,Z", text), "give three numbers, in metres: 0,1.5,0");
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<std::uint32_t> parse_counts(const std::string& text, const std::string& flag) {
  const auto fail = [&](std::string_view cause) {
    return UsageError(flag, fmt::format("'{}' {}", text, cause),
                      "give whole numbers as 1,10,40,100, or 1:100, or 5:100:5");
  };
  std::set<std::uint32_t> counts;
  for (const std::string& part : parse_list(text)) {
    std::vector<std::uint32_t> bounds;
    std::istringstream stream(part);
    for (std::string bound; std::getline(stream, bound, ':');) {
      std::uint32_t value = 0;
      if (!parse_number(bound, value)) throw fail("is not a list of whole numbers");
      if (value == 0) throw fail("contains a zero");
      bounds.push_back(value);
    }
    if (bounds.empty() || bounds.size() > 3 || part.ends_with(':')) throw fail("is not a list of whole numbers");
    const std::uint32_t last = bounds.size() > 1 ? bounds[1] : bounds[0];
    const std::uint32_t step = bounds.size() > 2 ? bounds[2] : 1;
    if (last < bounds[0]) throw fail("contains a range that ends below its start");
    if ((last - bounds[0]) / step >= kMostCounts)
      throw fail(fmt::format("contains a range of more than {} counts", kMostCounts));
    for (std::uint64_t count = bounds[0]; count <= last; count += step)
      counts.insert(static_cast<std::uint32_t>(count));
  }
  if (counts.empty()) throw fail("is empty");
  return {counts.begin(), counts.end()};
}

std::vector<std::string> parse_list(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (text.ends_with(',')) parts.emplace_back();
  return parts;
}

std::vector<std::string> parse_distinct(const std::string& text, const std::string& flag) {
  std::vector<std::string> parts = parse_list(text);
  std::set<std::string> seen;
  for (const std::string& part : parts)
    if (!seen.insert(part).second) throw UsageError(flag, fmt::format("'{}' is named twice", part), "name each once");
  return parts;
}

std::vector<std::string> parse_names(const std::string& text, const std::vector<std::string>& known,
                                     const std::string& flag) {
  const std::string remedy = fmt::format("choose from: {}", fmt::join(known, ", "));
  std::vector<std::string> names = parse_distinct(text, flag);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw UsageError(flag, fmt::format("there is no '{}'", name),
                       help::did_you_mean(name, std::vector<std::string_view>(known.begin(), known.end())) + remedy);
  if (names.empty()) throw UsageError(flag, "is empty", remedy);
  return names;
}

}  // namespace vestige::cli
