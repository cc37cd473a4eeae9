#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "analysis/base/provenance.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/repair/trace_check.hpp"

namespace vestige::cli {

namespace {

struct DoctorOptions {
  CommonOptions common;
  std::vector<std::string> files;
};

int exit_code_of(const TraceCheck& check) {
  if (check.problems.count() == 0) return kDone;
  return check.readable() ? kDataLost : kFailed;
}

/// The worst of several: nothing can be read, then problems, then none.
int worse(int a, int b) {
  if (a == kFailed || b == kFailed) return kFailed;
  return std::max(a, b);
}

nlohmann::ordered_json to_json(const TraceCheck& check, const std::string& file) {
  nlohmann::ordered_json problems = nlohmann::ordered_json::array();
  for (const mcap::Problem& problem : check.problems.kept()) {
    nlohmann::ordered_json shown = {{"offset", problem.offset}, {"bytes", problem.bytes}};
    if (problem.offset_in_chunk) shown["offset_in_chunk"] = *problem.offset_in_chunk;
    shown["problem"] = problem.what;
    shown["consequence"] = problem.consequence;
    problems.push_back(std::move(shown));
  }
  nlohmann::ordered_json json = {{"file", file},
                                 {"trace", check.is_trace},
                                 {"readable", check.readable()},
                                 {"has_footer", check.container.has_footer},
                                 {"messages", check.container.messages},
                                 {"chunks", check.container.chunks},
                                 {"damaged_chunks", check.container.damaged_chunks},
                                 {"attachments", check.container.attachments}};
  if (check.is_trace) {
    json["frames"] = check.frames;
    json["dropped"] = check.dropped;
    nlohmann::ordered_json attachments = nlohmann::ordered_json::array();
    for (const TraceCheck::Attachment& attachment : check.attachments) {
      attachments.push_back({{"name", attachment.name}, {"sha256", attachment.sha256}, {"recorded", nullptr}});
      if (attachment.is_recorded) attachments.back()["recorded"] = *attachment.is_recorded;
    }
    json["attachment_checks"] = std::move(attachments);
  }
  json["problem_count"] = check.problems.count();
  json["problems"] = std::move(problems);
  return json;
}

/// Says which attachments have the recorded SHA-256. The problems say it of all others.
std::string describe_attachments(const TraceCheck& check, const std::string& file) {
  std::string recorded;
  std::string unknown;
  for (const TraceCheck::Attachment& attachment : check.attachments) {
    std::string& list = attachment.is_recorded ? recorded : unknown;
    if (attachment.is_recorded.value_or(true)) list += (list.empty() ? "" : ", ") + attachment.name;
  }
  std::string text;
  if (!recorded.empty()) text += fmt::format("{}: SHA-256 as recorded: {}\n", file, recorded);
  if (!unknown.empty()) text += fmt::format("{}: no SHA-256 recorded: {}\n", file, unknown);
  return text;
}

std::string describe(const TraceCheck& check, const std::string& file) {
  std::string text;
  for (const mcap::Problem& problem : check.problems.kept()) {
    text += fmt::format("{}: at byte {}", file, problem.offset);
    if (problem.offset_in_chunk) text += fmt::format(", {} bytes into its chunk", *problem.offset_in_chunk);
    text += fmt::format(": {}\n  {}\n", problem.what, problem.consequence);
  }
  const std::uint64_t shown = check.problems.kept().size();
  if (check.problems.count() > shown) text += fmt::format("{}: and {} more\n", file, check.problems.count() - shown);
  text += describe_attachments(check, file);
  const std::string content = check.is_trace
                                  ? fmt::format("{} can be read", counted(check.frames, "frame"))
                                  : fmt::format("{}, {}; not a trace of Vestige, so only the framing was checked",
                                                counted(check.container.messages, "message"),
                                                counted(check.container.attachments, "attachment"));
  const std::uint64_t count = check.problems.count();
  text += fmt::format("{}: {}; {}\n", file, count == 0 ? "no problem" : counted(count, "problem"),
                      check.readable() || count == 0 ? content : "nothing in it can be read");
  return text;
}

void run_doctor(const DoctorOptions& options, Invocation& invocation) {
  check_outputs({options.common.json}, options.files, options.common);
  check_inputs(options.files);
  catch_interrupts();
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::string& file : options.files) {
    TraceCheck check;
    try {
      const mcap::FileSource source(file);
      Progress progress("Checking", options.common.verbosity());
      check = check_trace(source, [&](double share) { return progress.update(share); });
    } catch (const Error& error) {
      if (interrupted()) throw;
      print_message(fmt::format("vestige: error: {}\n", error.what()));
      invocation.exit_code = worse(invocation.exit_code, kFailed);
      json.push_back({{"file", file}, {"readable", false}, {"error", error.what()}});
      continue;
    }
    invocation.exit_code = worse(invocation.exit_code, exit_code_of(check));
    json.push_back(to_json(check, file));
    print_summary(describe(check, file), {options.common.json}, options.common);
  }
  write_json(options.common.json, with_provenance(invocation.argv, {{"files", json}}), options.common);
}

}  // namespace

void add_doctor(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* verb = add_verb(program, "doctor", "Say what is wrong with a trace, or any MCAP file, byte by byte",
                            "  vestige doctor man.mcap\n"
                            "  vestige doctor man.mcap --json doctor.json\n");
  verb->add_option("FILE", options->files,
                   "Files to check, or '-' for standard input. Exit code 0: no problem; 3: problems, but something can "
                   "be read; 1: nothing can be read")
      ->required();
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_doctor(*options, invocation); });
}

}  // namespace vestige::cli
