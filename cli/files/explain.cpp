#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/explain/explained_file.hpp"
#include "analysis/explain/reference_page.hpp"
#include "cli/verbs.hpp"

namespace vestige::cli {

namespace {

struct ExplainOptions {
  CommonOptions common;
  std::vector<std::string> files;
};

nlohmann::ordered_json head_of(const FileKind& kind) {
  return {{"kind", kind.name}, {"what", kind.what}, {"written_by", kind.written_by}};
}

nlohmann::ordered_json to_json(std::string_view path, const Field& field) {
  return {{"name", path}, {"unit", field.unit}, {"meaning", field.meaning}};
}

nlohmann::ordered_json to_json(const ExplainedFile& explained, const std::string& file) {
  nlohmann::ordered_json json = {{"file", file}};
  json.update(head_of(*explained.kind));
  json["names"] = nlohmann::ordered_json::array();
  for (const PlacedField& name : explained.names) json["names"].push_back(to_json(name.path, *name.field));
  json["unexplained"] = explained.unexplained;
  return json;
}

nlohmann::ordered_json to_json(const FileKind& kind) {
  nlohmann::ordered_json json = head_of(kind);
  json["names"] = nlohmann::ordered_json::array();
  for (const FieldGroup& group : kind.groups)
    for (const Field& field : group.fields) json["names"].push_back(to_json(path_of(group.below, field.name), field));
  return json;
}

std::string describe(const ExplainedFile& explained, const std::string& file) {
  std::string text = fmt::format("{}: {} ({})\n", file, explained.kind->what, explained.kind->written_by);
  std::size_t width = 0;
  for (const PlacedField& name : explained.names) width = std::max(width, name.path.size());
  width = std::min<std::size_t>(width, 32);  // of a few long names, the meaning begins later
  for (const auto& [path, field] : explained.names)
    fmt::format_to(std::back_inserter(text), "  {:<{}}  {}{}\n", path, width, field->meaning,
                   field->unit.empty() ? "" : fmt::format(" [{}]", field->unit));
  return text;
}

void run_explain(const ExplainOptions& options, Invocation& invocation) {
  check_inputs(options.files);
  check_outputs({options.common.json}, options.files, options.common);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const std::string& file : options.files) {
    const ExplainedFile explained = explain_file(file);
    list.push_back(to_json(explained, file));
    text += describe(explained, file);
    if (explained.unexplained.empty()) continue;
    warn(fmt::format("{}: no file of this kind has {}", file, fmt::join(explained.unexplained, ", ")),
         options.common.verbosity());
    invocation.exit_code = kDataLost;
  }
  if (options.files.empty()) {
    for (const FileKind& kind : file_kinds()) list.push_back(to_json(kind));
    text = reference_page();
  }
  write_json(options.common.json, with_provenance(invocation.argv, {{"files", list}}), options.common);
  print_summary(text, {options.common.json}, options.common);
}

}  // namespace

void add_explain(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* verb = add_verb(program, "explain", "Say what the names in a file mean: columns, channels, fields of JSON",
                            "  vestige explain contacts.csv\n"
                            "  vestige explain compared/ranking.csv compared/scores.csv\n");
  verb->add_option(
      "FILE", options->files,
      "CSV, JSON, HDF5 or OpenEXR files that Vestige wrote; '-' for standard input (text) [default: prints a page "
      "about all kinds of files, as Markdown]");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_explain(*options, invocation); });
}

}  // namespace vestige::cli
