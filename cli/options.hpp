#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/terminal.hpp"
#include "traces/files/output_file.hpp"

namespace vestige::cli {

/// One run of the program: its arguments and its exit code.
struct Invocation {
  std::vector<std::string> argv;
  int exit_code = kDone;
};

/// The flags of almost every verb.
struct CommonOptions {
  std::string json;
  bool quiet = false;
  bool verbose = false;
  bool force = false;
  std::uint64_t seed = 1;

  Verbosity verbosity() const {
    if (quiet) return Verbosity::kQuiet;
    return verbose ? Verbosity::kVerbose : Verbosity::kNormal;
  }
  Overwrite overwrite() const { return force ? Overwrite::kAllow : Overwrite::kRefuse; }
};

/// Adds --json, -q, -v, --seed and --force.
void add_common_options(CLI::App& verb, CommonOptions& options);

/// Makes the folder `path` and its parents, unless they exist. When the program ends, the new folders that are still
/// empty are removed.
void make_output_folder(const std::string& path);

/// Throws `UsageError` if a trace cannot hold this many frames.
void refuse_too_many_frames(double frames, const char* flag, const char* remedy);

/// Warns of a number of frames, rate times duration, that may come from a mistyped rate or duration: very many, or less
/// than one. `way_out` says how to end early.
void warn_of_frame_count(double frames, std::string_view way_out, Verbosity verbosity);

/// Throws `Error`, before any work is done, for outputs that could not be written at the end, or that would destroy an
/// input: existing files without --force, two results in one place, or a result in the place of an input. Empty paths
/// are outputs that were not requested.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   const CommonOptions& options);

/// Returns the remedy for something that is refused unless --force accepts it; nothing if --force accepts it. While it
/// overwrites one of `outputs`, it does not: whoever means the one must not get the other. `accepted` says what it
/// would do: "take another attachment".
std::optional<std::string> refusal_unless_forced(const std::vector<std::string>& outputs, const CommonOptions& options,
                                                 std::string_view accepted);

/// Throws `UsageError` if "-" occurs twice in a list of inputs: standard input can be read once.
void check_inputs(const std::vector<std::string>& inputs);

/// Writes `json` to `path` ("-": standard output), unless `path` is empty.
void write_json(const std::string& path, const nlohmann::ordered_json& json, const CommonOptions& options);

/// Prints text for people to standard output. If --json - or another result uses standard output, prints it to standard
/// error. With -q, prints nothing.
void print_summary(std::string_view text, const std::vector<std::string>& output_paths, const CommonOptions& options);

/// Parses finite numbers separated by commas. Returns nothing if a part is none.
std::vector<double> parse_numbers(const std::string& text);

/// Parses "X,Y,Z" in metres. Throws `UsageError` with the name of the flag.
glm::dvec3 parse_vector(const std::string& text, const std::string& flag);

/// Parses "1:100", "1,10,40,100", "5:100:5", or any mix. Returns the counts in ascending order, without repetitions.
/// Throws `UsageError` with the name of the flag.
std::vector<std::uint32_t> parse_counts(const std::string& text, const std::string& flag);

/// Splits at commas.
std::vector<std::string> parse_list(const std::string& text);

/// Splits at commas. Throws `UsageError` with the name of the flag if a part occurs twice.
std::vector<std::string> parse_distinct(const std::string& text, const std::string& flag);

/// As above. Throws also if a part is not in `known`, or if there is no part.
std::vector<std::string> parse_names(const std::string& text, const std::vector<std::string>& known,
                                     const std::string& flag);

}  // namespace vestige::cli
