#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "cli/rewriting.hpp"
#include "cli/verbs.hpp"
#include "traces/definitions.hpp"
#include "traces/error.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/message_text.hpp"

namespace vestige::cli {

namespace {

using mcap::Opcode;

struct CatOptions {
  CommonOptions common;
  std::string file;
  std::vector<std::string> topics;
};

/// Prints messages as they come, of the topics asked for.
class Printer {
 public:
  Printer(const CatOptions& options, Definitions definitions)
      : options_(options), definitions_(std::move(definitions)) {
    for (const auto& [id, schema] : definitions_.schemas) streams_.add(schema);
    for (const auto& [id, channel] : definitions_.channels) streams_.add(channel);
  }

  /// False when nobody reads any more.
  bool take(const mcap::StreamRecord& record);
  /// Throws `Error` where a topic asked for is in no channel.
  void require_topics() const;

  std::uint64_t messages() const { return messages_; }
  const std::vector<mcap::Damage>& damages() const { return damages_; }

 private:
  bool print(const mcap::StreamRecord& record);

  const CatOptions& options_;
  Definitions definitions_;
  StreamTable streams_;
  MessageText text_;
  std::uint64_t messages_ = 0;
  std::vector<mcap::Damage> damages_;
};

bool Printer::take(const mcap::StreamRecord& record) {
  try {
    if (record.opcode == Opcode::kSchema) {
      mcap::Schema schema = mcap::decode_schema(record.content);
      streams_.add(schema);
    } else if (record.opcode == Opcode::kChannel) {
      const mcap::Channel channel = mcap::decode_channel(record.content);
      streams_.add(channel);
      definitions_.channels.try_emplace(channel.id, channel);
    } else if (record.opcode == Opcode::kMessage) {
      return print(record);
    }
  } catch (const mcap::Malformed& malformed) {
    // Once for what is alike.
    const std::string what = fmt::format("a Message: {}", malformed.what());
    if (record.opcode == Opcode::kMessage && (damages_.empty() || damages_.back().what != what))
      damages_.push_back({record.offset, 0, what});
  }
  return true;
}

bool Printer::print(const mcap::StreamRecord& record) {
  const mcap::Message message = mcap::decode_message(record.content);
  const auto channel = definitions_.channels.find(message.channel_id);
  if (channel == definitions_.channels.end())
    throw mcap::Malformed(fmt::format("nothing defines its channel {}", message.channel_id));
  const auto& topics = options_.topics;
  if (!topics.empty() && std::find(topics.begin(), topics.end(), channel->second.topic) == topics.end()) return true;
  const std::string line = text_.line(message, channel->second, streams_.stream_of(message.channel_id)) + "\n";
  if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size()) {
    if (errno == EPIPE) return false;  // `| head` has seen enough
    throw system_error("standard output", "could not write", errno);
  }
  ++messages_;
  return true;
}

void Printer::require_topics() const {
  std::set<std::string> known;
  for (const auto& [id, channel] : definitions_.channels) known.insert(channel.topic);
  for (const std::string& topic : options_.topics)
    if (!known.contains(topic))
      throw Error(options_.file, fmt::format("has no channel {}", topic),
                  fmt::format("it has: {}", fmt::join(known, ", ")));
}

void run_cat(const CatOptions& options, Invocation& invocation) {
  check_outputs({"-", options.common.json}, {options.file}, options.common);
  const mcap::FileSource source(options.file);
  mcap::StreamReader reader(source);
  Printer printer(options, gather_definitions(source));
  catch_interrupts();
  mcap::StreamRecord record;
  bool wanted = true;
  while (wanted && !interrupted() && reader.next(record)) wanted = printer.take(record);
  if (!wanted) return;
  if (interrupted()) throw Error(options.file, "printing it was stopped", "");
  printer.require_topics();
  std::vector<mcap::Damage> damages = reader.damages();
  damages.insert(damages.end(), printer.damages().begin(), printer.damages().end());
  warn_of_damage(options.file, damages, options.common.verbosity());
  write_json(options.common.json,
             {{"file", options.file}, {"messages", printer.messages()}, {"complete", damages.empty()}}, options.common);
  if (!damages.empty()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_cat(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<CatOptions>();
  CLI::App* verb = add_verb(program, "cat", "Print a trace's messages, or any MCAP file's, one line of JSON each",
                            "  vestige cat man.mcap --topic /colliders\n"
                            "  vestige cat man.mcap > man.ndjson\n");
  verb->add_option("FILE", options->file, "The trace, or any MCAP file, or '-' for standard input")->required();
  verb->add_option("--topic", options->topics, "Print only messages of this topic; may stand there several times")
      ->type_name("TOPIC")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_cat(*options, invocation); });
}

}  // namespace vestige::cli
