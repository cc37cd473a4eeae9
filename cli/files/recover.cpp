#include "traces/repair/recover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "analysis/base/provenance.hpp"
#include "cli/choices/scene.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

struct RecoverOptions {
  CommonOptions common;
  std::string file;
  std::string output;
  std::vector<std::string> avatars;
  std::vector<std::string> maps;
};

/// The value of a flag that may name a person: "FILE" for the first, "2=FILE" for the second.
struct OfPerson {
  std::size_t person = 0;
  std::string value;
};

OfPerson parse_of_person(const std::string& text, const char* flag) {
  const std::size_t mark = text.find('=');
  const bool has_number = mark != std::string::npos && mark > 0 &&
                          std::ranges::all_of(text.substr(0, mark), [](char c) { return c >= '0' && c <= '9'; });
  if (!has_number) return {0, text};
  std::size_t number = 0;
  std::from_chars(text.data(), text.data() + mark, number);
  if (number < 1 || number > trace_format::kMostPeople)
    throw UsageError(flag, fmt::format("'{}' names no person", text),
                     fmt::format("people are numbered from 1 to {}", trace_format::kMostPeople));
  if (mark + 1 == text.size())
    throw UsageError(flag, fmt::format("'{}' names no file", text), fmt::format("say {} {}=FILE", flag, number));
  return {number - 1, text.substr(mark + 1)};
}

std::vector<OfPerson> parse_people(const std::vector<std::string>& texts, const char* flag) {
  std::vector<OfPerson> parsed;
  for (const std::string& text : texts) {
    parsed.push_back(parse_of_person(text, flag));
    const std::size_t person = parsed.back().person;
    if (std::ranges::count(parsed, person, &OfPerson::person) > 1)
      throw UsageError(flag, fmt::format("is given twice for person {}", person + 1), "give it once for each person");
  }
  return parsed;
}

/// Returns the substitutes that the flags name.
Substitutes read_substitutes(const RecoverOptions& options) {
  Substitutes substitutes;
  using trace_format::attachment_name;
  using trace_format::AttachmentKind;
  for (const auto& [person, avatar] : parse_people(options.avatars, "--avatar"))
    substitutes.avatars.push_back({.person = person,
                                   .from = avatar,
                                   .files = {{attachment_name(AttachmentKind::kAvatar, person), load_avatar(avatar)}}});
  for (const auto& [person, map] : parse_people(options.maps, "--map")) {
    if (map == "none")
      throw UsageError("--map", "'none' puts nothing in the place of a map", "name a map, or leave --map out");
    ActuatorMapFiles files = load_map(map);
    Substitute& substitute = substitutes.maps.emplace_back();
    substitute = {.person = person,
                  .from = map,
                  .files = {{attachment_name(AttachmentKind::kMapImage, person), std::move(files.png)}}};
    const auto json = std::as_bytes(std::span(files.json));
    if (!json.empty())
      substitute.files.emplace(attachment_name(AttachmentKind::kMapText, person),
                               std::vector<std::byte>(json.begin(), json.end()));
  }
  substitutes.refusal =
      refusal_unless_forced({options.output, options.common.json}, options.common, "take another attachment");
  if (!options.common.force) *substitutes.refusal += ", and the new file says so";
  return substitutes;
}

nlohmann::ordered_json to_json(const Recovery& recovery, const RecoverOptions& options) {
  nlohmann::ordered_json json = {{"file", options.file},
                                 {"output", options.output},
                                 {"lost_something", recovery.lost_something()},
                                 {"messages", recovery.messages},
                                 {"messages_lost", nullptr},
                                 {"messages_left_out", recovery.messages_left_out},
                                 {"messages_unverified", recovery.messages_unverified},
                                 {"chunks_whole", recovery.chunks_whole},
                                 {"chunks_partly_lost", recovery.chunks_partly},
                                 {"chunks_lost", recovery.chunks_lost},
                                 {"attachments", recovery.attachments},
                                 {"damaged_attachments", recovery.damaged_attachments},
                                 {"replaced", nlohmann::ordered_json::array()},
                                 {"metadata", recovery.metadata},
                                 {"bytes_lost", recovery.bytes_lost},
                                 {"another_file_at", nullptr},
                                 {"unexplained_change", recovery.unexplained_change},
                                 {"repaired", recovery.repaired}};
  for (const Recovery::Replaced& replaced : recovery.replaced)
    json["replaced"].push_back({{"name", replaced.name},
                                {"from", replaced.from},
                                {"recorded", replaced.is_recorded},
                                {"left_out", replaced.is_left_out}});
  if (recovery.messages_lost) json["messages_lost"] = *recovery.messages_lost;
  if (recovery.another_file_at) json["another_file_at"] = *recovery.another_file_at;
  return json;
}

/// Returns which flag replaces a damaged attachment, unless something already takes its place.
std::string remedy_for(const std::string& name, const Recovery& recovery) {
  const auto id = trace_format::attachment_id(name);
  if (!id || std::ranges::count(recovery.replaced, name, &Recovery::Replaced::name) > 0) return "";
  return fmt::format("; {}{} puts an intact one in its place",
                     id->kind == trace_format::AttachmentKind::kAvatar ? "--avatar" : "--map",
                     id->person == 0 ? "" : fmt::format(" {}=…", id->person + 1));
}

void warn_of_losses(const Recovery& recovery, const RecoverOptions& options) {
  const auto say = [&](const std::string& text) {
    warn(fmt::format("{}: {}", options.file, text), options.common.verbosity());
  };
  if (recovery.bytes_lost > 0) say(fmt::format("lost {}", counted(recovery.bytes_lost, "byte")));
  if (const auto at = recovery.another_file_at)
    say(fmt::format("a second MCAP file begins at byte {} and is left out: `tail -c +{} {} > SECOND.mcap` extracts it",
                    *at, *at + 1, options.file));
  if (recovery.chunks_lost > 0) say(fmt::format("lost {}", counted(recovery.chunks_lost, "chunk")));
  if (recovery.chunks_partly > 0)
    say(fmt::format("kept {} of {}, not verified by any CRC", counted(recovery.messages_unverified, "message"),
                    counted(recovery.chunks_partly, "damaged chunk")));
  if (recovery.messages_lost.value_or(0) > 0) say(fmt::format("lost {}", counted(*recovery.messages_lost, "message")));
  if (recovery.messages_left_out > 0)
    say(fmt::format("left out {} that contradicted the rest", counted(recovery.messages_left_out, "message")));
  for (const std::string& name : recovery.damaged_attachments)
    say(fmt::format("the attachment {0} is damaged; it is kept as {0}.damaged{1}", name, remedy_for(name, recovery)));
  for (const Recovery::Replaced& replaced : recovery.replaced) {
    if (replaced.is_recorded) continue;
    say(replaced.is_left_out
            ? fmt::format("the attachment {} is left out, because {} has no sidecar", replaced.name, replaced.from)
            : fmt::format("{} takes the place of the attachment {}, and is not verified to be the recorded one",
                          replaced.from, replaced.name));
  }
  for (const std::string& unused : recovery.unused)
    say(fmt::format("{} is not used, because the trace has an intact one", unused));
  if (recovery.unexplained_change)
    say("a byte of its header, definitions, metadata or indexes has changed; it is not known which byte");
}

void run_recover(const RecoverOptions& options, Invocation& invocation) {
  std::vector<std::string> inputs = {options.file};
  for (const OfPerson& avatar : parse_people(options.avatars, "--avatar")) inputs.push_back(avatar.value);
  for (const OfPerson& map : parse_people(options.maps, "--map")) {
    inputs.push_back(map.value);
    inputs.push_back(sidecar_path(map.value).string());
  }
  check_outputs({options.output, options.common.json}, inputs, options.common);
  check_trace_name(options.output);
  if (options.output == "-") refuse_terminal("-o -");
  const mcap::FileSource source(options.file);
  catch_interrupts();
  const Substitutes substitutes = read_substitutes(options);
  OutputFile file(options.output, options.common.overwrite());
  Recovery recovery;
  {
    Progress progress("Recovering", options.common.verbosity());
    recovery = recover_mcap(
        source, [&](mcap::Bytes bytes) { file.write(bytes); }, [&](double share) { return progress.update(share); },
        substitutes);
  }
  file.commit();
  warn_of_losses(recovery, options);
  write_json(options.common.json, with_provenance(invocation.argv, to_json(recovery, options)), options.common);
  std::string text =
      fmt::format("{}: {}, {}{}\n", options.output, counted(recovery.messages, "message"),
                  counted(recovery.attachments, "attachment"), recovery.lost_something() ? "" : "; nothing was lost");
  for (const std::string& repair : recovery.repaired) text += fmt::format("  repaired: {}\n", repair);
  print_summary(text, {options.output, options.common.json}, options.common);
  if (recovery.lost_something()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_recover(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<RecoverOptions>();
  CLI::App* verb = add_verb(program, "recover", "Write a complete file from the readable parts of a damaged one",
                            "  vestige recover man.mcap -o mended.mcap\n"
                            "  vestige recover man.mcap --avatar builtin -o mended.mcap\n");
  verb->add_option("FILE", options->file,
                   "The damaged trace, or any MCAP file, or '-' for standard input. Exit code 3: something was lost")
      ->required();
  verb->add_option("-o,--output", options->output, "The file to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  verb->add_option(
          "--avatar", options->avatars,
          "Put this avatar in the place of a damaged or missing one. It must be the recorded one (by its "
          "SHA-256); --force takes any other as well, if it overwrites no file, and the new file says so. 2=FILE "
          "is for the second person; repeat the flag for more people")
      ->type_name("[K=]builtin|FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_option("--map", options->maps, "Likewise for the actuator map, with its sidecar FILE.json if that exists")
      ->type_name("[K=]builtin|FILE.png")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_recover(*options, invocation); });
}

}  // namespace vestige::cli
