#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/terminal.hpp"
#include "traces/files/output_file.hpp"

namespace vestige::cli {

/// One run of the program: what it was called with, and what it will answer.
struct Invocation {
  std::vector<std::string> argv;
  int exit_code = kDone;
};

/// The flags that every verb has.
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

/// Makes the folder `path` and those above it, unless they exist; what is still empty when the program ends goes again.
void make_output_folder(const std::string& path);

/// Throws `UsageError` for more frames than a trace can hold.
void refuse_too_many_frames(double frames, const char* flag, const char* remedy);

/// Warns of a number of frames that may be a mistyped rate or duration. `way_out`: how to end early.
void warn_of_many_frames(double frames, std::string_view way_out, Verbosity verbosity);

/// Refuses, before any work is done, what could not be written at its end or would destroy what is read: existing files
/// without --force, two results in one place, a result in the place of an input. Empty paths were not asked for.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   const CommonOptions& options);

/// Refuses a list of inputs in which "-" stands twice: standard input can be read once.
void check_inputs(const std::vector<std::string>& inputs);

/// Writes `json` to `path` ("-": standard output), unless `path` is empty.
void write_json(const std::string& path, const nlohmann::ordered_json& json, const CommonOptions& options);

/// Prints what a person wants to read: to standard output, or to standard error when --json - or another result has
/// standard output for itself. With -q, nothing.
void print_summary(std::string_view text, const std::vector<std::string>& output_paths, const CommonOptions& options);

/// "X,Y,Z" in metres. Throws `UsageError` naming `flag`.
glm::dvec3 parse_vector(const std::string& text, const std::string& flag);

/// "1:100", "1,10,40,100", "5:100:5", or any mix: ascending, without repetitions. Throws `UsageError` naming `flag`.
std::vector<std::uint32_t> parse_counts(const std::string& text, const std::string& flag);

/// Splits at commas.
std::vector<std::string> parse_list(const std::string& text);

/// The same, for a list in which each part stands once. Throws `UsageError` naming `flag`.
std::vector<std::string> parse_distinct(const std::string& text, const std::string& flag);

/// The same, for a list of at least one of `known`.
std::vector<std::string> parse_names(const std::string& text, const std::vector<std::string>& known,
                                     const std::string& flag);

}  // namespace vestige::cli
