#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "analysis/base/provenance.hpp"
#include "analysis/claims/commands.hpp"
#include "analysis/claims/page.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::cli {

namespace {

struct ClaimsOptions {
  CommonOptions common;
  std::string folder;
  std::string output = "-";
};

std::vector<std::string> json_files_under(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder))
    throw Error(folder.string(), "is not a folder", "name a folder of results");
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

std::vector<Result> read_results(const std::vector<std::string>& files, const std::filesystem::path& folder) {
  std::vector<Result> results;
  for (const std::string& file : files) try {
      auto result = nlohmann::json::parse(read_text_file(file));
      // What holds results only has a run.json beside it, which says where they come from.
      const auto run = std::filesystem::path(file).parent_path() / "run.json";
      if (run != file && result.is_object() && !result.contains("argv") && std::filesystem::exists(run))
        result = with_run(std::move(result), nlohmann::json::parse(read_text_file(run)));
      results.push_back({file, std::filesystem::relative(file, folder).generic_string(), std::move(result)});
    } catch (const nlohmann::json::exception& exception) {
      throw not_ours(file, exception);
    }
  return results;
}

/// One entry for each claim and file that shows it.
nlohmann::ordered_json to_json(const std::vector<Run>& runs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Run& run : runs)
    for (const Claim& claim : run.claims)
      for (const std::string& file : claim.files) {
        const Origin origin = origin_of(*std::ranges::find(run.results, file, &Result::file));
        list.push_back({{"question", heading_of(claim.question)},
                        {"claim", claim.topic.empty() ? claim.text : claim.topic + ": " + claim.text},
                        {"command", origin.command},
                        {"time", origin.time},
                        {"machine", origin.machine + "; " + origin.renderer},
                        {"commit", origin.commit},
                        {"file", file}});
      }
  return {{"claims", list}};
}

void run_claims(const ClaimsOptions& options, const Invocation& invocation) {
  const std::vector<std::string> files = json_files_under(options.folder);
  check_outputs({options.output, options.common.json}, files, options.common);
  const std::vector<Run> runs = runs_of(read_results(files, options.folder));
  if (runs.empty())
    throw Error(options.folder, "holds no result", "write one with 'vestige sweep -o' or 'vestige replay --json'");
  write_json(options.common.json, with_provenance(invocation.argv, to_json(runs)), options.common);
  if (options.output.empty()) return;
  OutputFile file(options.output, options.common.overwrite());
  file.write(claims_page(runs));
  file.commit();
}

}  // namespace

void add_claims(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ClaimsOptions>();
  CLI::App* verb = add_verb(program, "claims", "Say what a folder of results shows, as a page of Markdown",
                            "  vestige claims results\n"
                            "  vestige claims results --force -o results/README.md\n");
  verb->add_option("DIR", options->folder, "Folder of JSON files that the other verbs wrote")->required();
  verb->add_option("-o,--output", options->output, "The page to write, or '-' for standard output")
      ->capture_default_str()
      ->type_name("OUT.md|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] {
    // --json - takes standard output over from the page.
    if (options->common.json == "-" && verb->count("--output") == 0) options->output.clear();
    run_claims(*options, invocation);
  });
}

}  // namespace vestige::cli
