#include "traces/repair/recover.hpp"

#include <fmt/format.h>

#include <memory>

#include "cli/verbs.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

struct RecoverOptions {
  CommonOptions common;
  std::string file;
  std::string output;
};

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
                                 {"metadata", recovery.metadata},
                                 {"bytes_lost", recovery.bytes_lost},
                                 {"another_file_at", nullptr},
                                 {"unexplained_change", recovery.unexplained_change},
                                 {"repaired", recovery.repaired}};
  if (recovery.messages_lost) json["messages_lost"] = *recovery.messages_lost;
  if (recovery.another_file_at) json["another_file_at"] = *recovery.another_file_at;
  return json;
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
    say(fmt::format("the attachment {0} is damaged; it is kept as {0}.damaged", name));
  if (recovery.unexplained_change)
    say("a byte of its header, definitions, metadata or indexes has changed; it is not known which byte");
}

void run_recover(const RecoverOptions& options, Invocation& invocation) {
  check_outputs({options.output, options.common.json}, {options.file}, options.common);
  if (options.output == "-") refuse_terminal("-o -");
  const mcap::FileSource source(options.file);
  catch_interrupts();
  OutputFile file(options.output, options.common.overwrite());
  Recovery recovery;
  {
    Progress progress("Recovering", options.common.verbosity());
    recovery = recover_mcap(
        source, [&](mcap::Bytes bytes) { file.write(bytes); }, [&](double share) { return progress.update(share); });
  }
  file.commit();
  warn_of_losses(recovery, options);
  write_json(options.common.json, to_json(recovery, options), options.common);
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
                            "  vestige recover man.mcap -o mended.mcap --json recovery.json\n");
  verb->add_option("FILE", options->file,
                   "The damaged trace, or any MCAP file, or '-' for standard input. Exit code 3: something was lost")
      ->required();
  verb->add_option("-o,--output", options->output, "The file to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_recover(*options, invocation); });
}

}  // namespace vestige::cli
