#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "analysis/base/provenance.hpp"
#include "cli/files/range_choice.hpp"
#include "cli/files/rewriting.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "traces/mcap/indexed_reader.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/repair/message_text.hpp"
#include "traces/trace_file/definitions.hpp"

namespace vestige::cli {

namespace {

using mcap::Opcode;

struct CatOptions {
  CommonOptions common;
  std::string file;
  std::vector<std::string> topics;
  RangeChoice range;
  std::string order = "file";
};

/// Prints messages as they come, of the topics asked for.
class Printer {
 public:
  Printer(const CatOptions& options, const mcap::TimeRange& range, Definitions definitions)
      : options_(options), range_(range), definitions_(std::move(definitions)) {
    for (const auto& [id, schema] : definitions_.schemas) streams_.add(schema);
    for (const auto& [id, channel] : definitions_.channels) streams_.add(channel);
  }

  /// False when nobody reads any more.
  bool take(const mcap::StreamRecord& record);
  bool take(const mcap::Message& message, std::uint64_t offset);
  /// Throws `Error` where a topic asked for is in no channel.
  void require_topics() const;
  /// As soon as it is sure that nothing else will be defined.
  void require_known_topics() const {
    const auto& statistics = definitions_.statistics;
    if (statistics && statistics->channel_count == definitions_.channels.size()) require_topics();
  }

  std::uint64_t messages() const { return messages_; }
  const mcap::DamageList& damages() const { return damages_; }

 private:
  bool print(const mcap::Message& message);

  const CatOptions& options_;
  mcap::TimeRange range_;
  Definitions definitions_;
  StreamTable streams_;
  MessageText text_;
  std::uint64_t messages_ = 0;
  mcap::DamageList damages_;
  std::string last_damage_;
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
      return take(mcap::decode_message(record.content), record.offset);
    }
  } catch (const mcap::Malformed&) {
    return true;  // the reader notes records whose fields do not fit
  }
  return true;
}

bool Printer::take(const mcap::Message& message, std::uint64_t offset) {
  try {
    return !range_.contains(message.log_time) || print(message);
  } catch (const mcap::Malformed& malformed) {
    // Once for what is alike.
    const std::string what = fmt::format("a Message: {}", malformed.what());
    if (std::exchange(last_damage_, what) != what) damages_.add({offset, 0, what});
    return true;
  }
}

bool Printer::print(const mcap::Message& message) {
  const auto channel = definitions_.channels.find(message.channel_id);
  if (channel == definitions_.channels.end())
    throw mcap::Malformed(fmt::format("its channel {} is not defined", message.channel_id));
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
                  fmt::format("choose from: {}", fmt::join(known, ", ")));
}

/// What could not be read; nothing when nobody reads any more.
std::optional<mcap::DamageList> print_in_file_order(const mcap::ByteSource& source, Printer& printer) {
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (!interrupted() && reader.next(record))
    if (!printer.take(record)) return {};
  return reader.damages();
}

std::optional<mcap::DamageList> print_in_order_of_time(const mcap::ByteSource& source, Printer& printer,
                                                       const mcap::TimeRange& range) {
  mcap::IndexedReader reader(source, range, [&](const mcap::InnerRecord& record) {
    printer.take({.opcode = record.opcode, .content = record.content, .offset = 0, .in_chunk = true});
  });
  if (!mcap::leads_to_everything(source, reader.summary()))
    throw Error(source.name(), "its index does not cover all of its content",
                "leave out '--order time', or rewrite the file with 'vestige recompress'");
  mcap::Message message;
  while (!interrupted() && reader.next(message))
    if (!printer.take(message, reader.chunk_offset())) return {};
  return reader.damages();
}

void run_cat(const CatOptions& options, Invocation& invocation) {
  const mcap::TimeRange range = range_of(options.range);
  check_outputs({"-", options.common.json}, {options.file}, options.common);
  const mcap::FileSource source(options.file);
  Printer printer(options, range, gather_definitions(source));
  printer.require_known_topics();
  catch_interrupts();
  auto damages =
      options.order == "time" ? print_in_order_of_time(source, printer, range) : print_in_file_order(source, printer);
  if (!damages) return;
  if (interrupted()) throw Error(options.file, "printing was stopped", "");
  if (printer.messages() == 0 && (options.range.from_s || options.range.to_s))
    warn(fmt::format("{}: no message matches in the requested time; 'vestige inspect' says how long the file lasts",
                     options.file),
         options.common.verbosity());
  printer.require_topics();
  damages->add(printer.damages());
  warn_of_damage(options.file, *damages, options.common.verbosity());
  write_json(
      options.common.json,
      with_provenance(invocation.argv,
                      {{"file", options.file}, {"messages", printer.messages()}, {"complete", damages->empty()}}),
      options.common);
  if (!damages->empty()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_cat(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<CatOptions>();
  CLI::App* verb = add_verb(program, "cat", "Print each message of a trace, or of any MCAP file, as a line of JSON",
                            "  vestige cat man.mcap --topic /colliders\n"
                            "  vestige cat man.mcap --from 0.5 --to 0.6 > moment.ndjson\n");
  verb->add_option("FILE", options->file, "The trace, or any MCAP file, or '-' for standard input")->required();
  verb->add_option("--topic", options->topics, "Print only messages of this topic. Repeat the flag for more topics")
      ->type_name("TOPIC")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_range_options(*verb, options->range, "Print");
  verb->add_option("--order", options->order,
                   "file: in the order of the file; time: by time, which needs the file's index and reads no chunk "
                   "outside --from and --to")
      ->capture_default_str()
      ->check(CLI::IsMember({"file", "time"}));
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_cat(*options, invocation); });
}

}  // namespace vestige::cli
