#include "cli/files/rewriting.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/base/provenance.hpp"
#include "cli/files/export_formats.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/trace_file/trace_index.hpp"

namespace vestige::cli {

void warn_of_damage(const std::string& file, const mcap::DamageList& damages, Verbosity verbosity) {
  constexpr std::size_t kMostTold = 20;
  const std::size_t told = std::min(damages.kept().size(), kMostTold);
  for (std::size_t i = 0; i < told; ++i) warn(vestige::describe(damages.kept()[i], file), verbosity);
  if (damages.count() > told) warn(fmt::format("{}: and {} more", file, damages.count() - told), verbosity);
  if (!damages.empty()) warn(fmt::format("{}: 'vestige recover' may keep more of the file", file), verbosity);
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
  print_summary(fmt::format("{}: {} messages from {} to {} s, {} bytes ({} before)\n", output, result.messages, start_s,
                            end_s, result.bytes, source.size()),
                {output, common.json}, common);
  if (!result.damages.empty()) invocation.exit_code = kDataLost;
}

}  // namespace vestige::cli
