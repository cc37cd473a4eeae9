#include "analysis/frequency/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

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
  if (!std::filesystem::is_directory(folder)) throw Error(folder.string(), "is no folder", "name a folder of results");
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

std::vector<Claim> claims_of_files(const std::vector<std::string>& files, const std::filesystem::path& folder) {
  std::vector<Claim> claims;
  for (const std::string& file : files) {
    const std::string name = std::filesystem::relative(file, folder).string();
    try {
      auto result = nlohmann::json::parse(read_text_file(file));
      // What holds results only has a run.json beside it, which says where they come from.
      const auto run = std::filesystem::path(file).parent_path() / "run.json";
      if (run != file && result.is_object() && !result.contains("argv") && std::filesystem::exists(run))
        result = with_run(std::move(result), nlohmann::json::parse(read_text_file(run)));
      const std::vector<Claim> found = claims_of(result, name);
      claims.insert(claims.end(), found.begin(), found.end());
    } catch (const nlohmann::json::exception& exception) {
      throw Error(file, fmt::format("is no result of ours: {}", exception.what()), "remove it, or write it again");
    }
  }
  return claims;
}

nlohmann::ordered_json to_json(const std::vector<Claim>& claims) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Claim& claim : claims)
    list.push_back({{"claim", claim.claim},
                    {"command", claim.command},
                    {"time", claim.time},
                    {"machine", claim.machine},
                    {"commit", claim.commit},
                    {"file", claim.file}});
  return {{"claims", list}};
}

void run_claims(const ClaimsOptions& options) {
  const std::vector<std::string> files = json_files_under(options.folder);
  check_outputs({options.output, options.common.json}, files, options.common);
  const std::vector<Claim> claims = claims_of_files(files, options.folder);
  if (claims.empty())
    throw Error(options.folder, "holds no result", "write one with 'vestige sweep -o' or 'vestige replay --json'");
  write_json(options.common.json, to_json(claims), options.common);
  if (options.output.empty()) return;
  OutputFile file(options.output, options.common.overwrite());
  file.write(
      fmt::format("# Results\n\nWritten by `vestige claims`: what the committed runs show. Frequencies are frames / "
                  "total time over the whole round trip, with\n95 % bootstrap intervals. llvmpipe is software: its "
                  "figures say nothing of a GPU.\n\n{}",
                  claims_table(claims)));
  file.commit();
}

}  // namespace

void add_claims(CLI::App& program, Invocation&) {
  auto options = std::make_shared<ClaimsOptions>();
  CLI::App* verb = add_verb(program, "claims", "Tabulate what a folder of results shows, as Markdown",
                            "  vestige claims results\n"
                            "  vestige claims results --force -o results/README.md\n");
  verb->add_option("DIR", options->folder, "Folder of JSON files that the other verbs wrote")->required();
  verb->add_option("-o,--output", options->output, "The table to write, or '-' for standard output")
      ->capture_default_str()
      ->type_name("OUT.md|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb] {
    // --json - takes standard output over from the table.
    if (options->common.json == "-" && verb->count("--output") == 0) options->output.clear();
    run_claims(*options);
  });
}

}  // namespace vestige::cli
