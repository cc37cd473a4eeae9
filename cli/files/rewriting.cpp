#include "cli/files/rewriting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "cli/files/export_formats.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/base/number_text.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/trace_file/trace_index.hpp"

namespace vestige::cli {

void warn_of_damage(const std::string& file, const mcap::DamageList& damages, Verbosity verbosity,
                    std::span<const std::string> told) {
  constexpr std::size_t kMostTold = 20;
  std::vector<std::string> news;
  for (const mcap::Damage& damage : damages.kept())
    if (std::string text = vestige::describe(damage, file); std::ranges::find(told, text) == told.end())
      news.push_back(std::move(text));
  const std::uint64_t more = damages.count() - damages.kept().size() + news.size() - std::min(news.size(), kMostTold);
  news.resize(std::min(news.size(), kMostTold));
  if (more > 0) news.push_back(fmt::format("{}: and {} more", file, more));
  if (!news.empty()) news.push_back(fmt::format("{}: 'vestige recover' may keep more of the file", file));
  for (const std::string& one : news) warn(one, verbosity);
}

void run_rewrite(const std::string& file, const std::string& output, const RewriteOptions& how,
                 const std::string& doing, const CommonOptions& common, Invocation& invocation) {
  check_outputs({output, common.json}, {file}, common);
  check_trace_name(output);
  if (output == "-") refuse_terminal("-o -");
  const mcap::FileSource source(file);
  catch_interrupts();
  OutputFile written(output, common.overwrite());
  Rewritten result;
  {
    Progress progress(doing, common.verbosity());
    result = rewrite_mcap(
        source, [&](mcap::Bytes bytes) { written.write(bytes); }, how,
        [&](double share) { return progress.update(share); });
  }
  written.commit();
  warn_of_damage(file, result.damages, common.verbosity());
  const double start_s = static_cast<double>(result.start_ns) / kNanosecondsPerSecond;
  const double end_s = static_cast<double>(result.end_ns) / kNanosecondsPerSecond;
  write_json(common.json,
             with_provenance(invocation.argv, {{"file", file},
                                               {"output", output},
                                               {"messages", result.messages},
                                               {"left_out", result.left_out},
                                               {"start_s", start_s},
                                               {"end_s", end_s},
                                               {"bytes_before", source.size()},
                                               {"bytes", result.bytes},
                                               {"complete", result.damages.empty()}}),
             common);
  print_summary(fmt::format("{}: {} from {} to {} s, {} bytes ({} before)\n", output,
                            counted(result.messages, "message"), start_s, end_s, result.bytes, source.size()),
                {output, common.json}, common);
  if (!result.damages.empty()) invocation.exit_code = kDataLost;
}

}  // namespace vestige::cli
