#include <fmt/format.h>

#include <memory>

#include "analysis/base/provenance.hpp"
#include "cli/verbs.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/utf8.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/scene/facing.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/trace_file/session_check.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

struct InspectOptions {
  CommonOptions common;
  std::string trace;
};

/// Returns what the session, if there is one, records of a person under this key.
std::string recorded(const McapSummary& summary, std::string_view key, std::size_t person) {
  return summary.session ? recorded_of(*summary.session, key, person) : "";
}

/// Returns the axis that the session records; empty if it records none.
std::string facing_of(const McapSummary& summary, std::size_t person) {
  const std::string facing = recorded(summary, trace_format::kFacingKey, person);
  return facing_named(facing) ? facing : "";
}

std::vector<std::string> names_of(const McapSummary& summary) {
  std::vector<std::string> names;
  for (std::size_t person = 0; person < summary.people; ++person)
    names.push_back(recorded(summary, trace_format::kNameKey, person));
  return names_of_people(names);
}

nlohmann::ordered_json people_json(const McapSummary& summary) {
  const std::vector<std::string> names = names_of(summary);
  nlohmann::ordered_json people = nlohmann::ordered_json::array();
  for (std::size_t person = 0; person < summary.people; ++person)
    people.push_back({{"name", names[person]},
                      {"avatar", trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, person)},
                      {"topic", trace_format::numbered("/pose", person)},
                      {"facing", facing_of(summary, person)}});
  return people;
}

std::string describe_people(const McapSummary& summary) {
  const std::vector<std::string> names = names_of(summary);
  std::string text;
  for (std::size_t person = 0; person < summary.people; ++person) {
    const std::string facing = facing_of(summary, person);
    const std::string label = summary.people == 1 ? "avatar faces" : fmt::format("person {}", person + 1);
    if (summary.people > 1)
      text += fmt::format("  {:<20} '{}'{}\n", label, names[person], facing.empty() ? "" : ", faces " + facing);
    else if (!facing.empty())
      text += fmt::format("  {:<20} {}, {}\n", label, facing, in_words(AvatarFacing::By::kTrace));
  }
  return text;
}

nlohmann::ordered_json to_json(const McapSummary& summary) {
  nlohmann::ordered_json channels = nlohmann::ordered_json::array();
  for (const auto& channel : summary.channels)
    channels.push_back({{"topic", channel.topic},
                        {"encoding", channel.encoding},
                        {"schema", channel.schema},
                        {"messages", channel.messages},
                        {"rate_hz", channel.rate_hz}});
  nlohmann::ordered_json attachments = nlohmann::ordered_json::array();
  for (const auto& attachment : summary.attachments) {
    attachments.push_back(
        {{"name", attachment.name}, {"bytes", attachment.bytes}, {"sha256", attachment.sha256}, {"recorded", nullptr}});
    if (attachment.is_recorded) attachments.back()["recorded"] = *attachment.is_recorded;
  }
  std::string compression;
  for (const std::string& name : summary.compression) compression += (compression.empty() ? "" : ",") + name;
  nlohmann::ordered_json json = {{"profile", summary.profile},
                                 {"library", summary.library},
                                 {"bytes", summary.file_bytes},
                                 {"messages", summary.messages},
                                 {"channels", channels},
                                 {"chunks", summary.chunks},
                                 {"compression", compression},
                                 {"compressed_bytes", summary.compressed_bytes},
                                 {"uncompressed_bytes", summary.uncompressed_bytes},
                                 {"attachments", attachments},
                                 {"duration_s", summary.duration_s},
                                 {"dropped", summary.dropped},
                                 {"dropped_by_topic", summary.dropped_by_topic},
                                 {"complete", summary.complete},
                                 {"recovered", summary.recovered},
                                 {"warnings", summary.warnings}};
  json["people"] = summary.is_trace ? people_json(summary) : nlohmann::ordered_json::array();
  if (summary.session) json["session"] = *summary.session;
  return json;
}

std::string describe(const McapSummary& summary, const std::string& path, bool verbose) {
  std::string text = fmt::format("{}: {}, profile '{}', written by {}\n", path,
                                 summary.complete ? "complete" : "NOT complete", summary.profile, summary.library);
  text += fmt::format("{} in {:.3f} s, {}, {} bytes\n", counted(summary.messages, "message"), summary.duration_s,
                      counted(summary.chunks, "chunk"), summary.file_bytes);
  for (const auto& channel : summary.channels)
    text +=
        fmt::format("  {:<20} {:>9} {:<8} {:>10.1f} Hz  {} ({})\n", channel.topic, channel.messages,
                    channel.messages == 1 ? "message" : "messages", channel.rate_hz, channel.schema, channel.encoding);
  for (const auto& attachment : summary.attachments)
    text += fmt::format("  {:<20} {:>9} bytes     sha256 {}{}\n", attachment.name, attachment.bytes, attachment.sha256,
                        attachment.is_recorded.value_or(true) ? "" : " (not the recorded one)");
  text += describe_people(summary);
  if (summary.dropped != 0) {
    text += fmt::format("lost {} while recording\n", counted(summary.dropped, "message"));
    for (const auto& [topic, count] : summary.dropped_by_topic)
      text += fmt::format("  {:<20} {:>9} {} lost\n", topic, count, count == 1 ? "message" : "messages");
  }
  if (!summary.recovered.empty()) text += fmt::format("the file {}\n", summary.recovered);
  if (verbose && summary.session)
    for (const auto& [key, value] : *summary.session)
      text += fmt::format("  {}: {}\n", in_one_line(key), in_one_line(value));
  return text;
}

void run_inspect(const InspectOptions& options, Invocation& invocation) {
  check_outputs({options.common.json}, {options.trace}, options.common);
  const McapSummary summary = summarise_mcap(options.trace);
  for (const std::string& warning : summary.warnings) warn(warning, options.common.verbosity());
  write_json(options.common.json, with_provenance(invocation.argv, to_json(summary)), options.common);
  print_summary(describe(summary, options.trace, options.common.verbose), {options.common.json}, options.common);
  if (!summary.complete) invocation.exit_code = kDataLost;
}

}  // namespace

void add_inspect(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* verb = add_verb(program, "inspect", "Say what a trace, or any MCAP file, holds",
                            "  vestige inspect man.mcap\n"
                            "  vestige inspect man.mcap --json inspect.json\n");
  verb->add_option("TRACE", options->trace, "The file, or '-' for standard input")->required();
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_inspect(*options, invocation); });
}

}  // namespace vestige::cli
