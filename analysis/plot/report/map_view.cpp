#include "analysis/plot/report/map_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/batch/batch_plan.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "analysis/plot/studio/subject_run.hpp"
#include "analysis/view/page.hpp"
#include "analysis/view/trace_page.hpp"
#include "detector/actuators/law_maker.hpp"
#include "traces/base/error.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

namespace {

/// Returns the file of a trace if it is there as it was judged, otherwise "". A recorded scenario lies in the batch's
/// folder.
std::string file_of(const std::filesystem::path& batch, const ReportTrace& trace) {
  std::vector<std::filesystem::path> places = {trace.given, batch / ".." / trace.given};
  if (trace.seed) places = {batch / "traces" / (trace.name + ".mcap")};
  for (const std::filesystem::path& place : places) try {
      std::error_code ignored;
      if (!std::filesystem::is_regular_file(place, ignored)) continue;
      if (trace.sha256.empty() || sha256_of_file(place.string()) == trace.sha256) return place.string();
    } catch (const Error&) {  // it cannot be read
    }
  return "";
}

LawFlags law_flags(const std::filesystem::path& batch, const ReportData& data, const std::string& law) {
  LawFlags flags;
  flags.law = law;
  flags.hold_ms = data.law_options.hold_s * 1e3;
  for (std::size_t i = 0; i < flags.parameters.size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    const std::optional<double>& value = data.law_options.*known.option;
    if (value && known.belongs_to(law)) flags.parameters[i] = *value * known.per_unit;
  }
  if (data.actuators) flags.actuator = (batch / "actuator.json").string();
  return flags;
}

std::vector<Subject> read_people(const TraceReader& reader, const std::string& file, const std::string& map,
                                 std::size_t person) {
  if (person >= reader.people().size())
    throw Error(file, fmt::format("has no person {}", person + 1), "draw the report where the batch's traces are");
  std::vector<Subject> people;
  for (std::size_t i = 0; i < reader.people().size(); ++i)
    people.push_back(read_subject(reader, file, i == person ? map : "", i));
  return people;
}

}  // namespace

TellingTrace telling_trace(const std::filesystem::path& batch, const ReportData& data, const Candidate& candidate) {
  std::vector<TellingTrace> traces;
  for (std::size_t i = 0; i < data.traces.size(); ++i) {
    const ReportTrace& trace = data.traces[i];
    if (trace.contacts == 0) continue;
    const bool has_results = candidate.by_trace.size() == data.traces.size();
    traces.push_back({&trace, "", has_results ? candidate.by_trace[i] : std::nullopt});
  }
  const bool higher_is_worse = data.metrics[data.headline].better == "lower";
  std::ranges::stable_sort(traces, [&](const TellingTrace& a, const TellingTrace& b) {
    if (a.value.has_value() != b.value.has_value()) return a.value.has_value();
    if (a.value != b.value) return (*a.value > *b.value) == higher_is_worse;
    return a.trace->contacts > b.trace->contacts;
  });
  std::vector<std::string> not_there;
  for (TellingTrace& trace : traces) {
    trace.file = file_of(batch, *trace.trace);
    if (trace.file.empty()) {
      not_there.push_back(trace.trace->name);
      continue;
    }
    trace.not_there = std::move(not_there);
    return trace;
  }
  return {nullptr, "", {}, std::move(not_there)};
}

std::optional<std::string> map_view(const std::filesystem::path& batch, const ReportData& data,
                                    const Candidate& candidate, const TellingTrace& telling,
                                    const std::function<bool(double)>& progress) {
  TraceReader reader(telling.file, People::kSeveral);
  const std::string map = (batch / "maps" / (candidate.map + ".png")).string();
  const std::vector<Subject> people = read_people(reader, telling.file, map, telling.trace->person);
  const LawFlags law = law_flags(batch, data, candidate.law);
  SeenRun run = make_run(people, reader.collider_ids(), law, data.method, kPagePlanes);
  std::vector<PagePerson> bodies;
  for (std::size_t i = 0; i < people.size(); ++i)
    bodies.push_back({reader.people()[i].name, people[i].avatar, people[i].map, i, 0});
  PagePacker packer(bodies, {}, reader.collider_ids());
  if (!pack_trace(reader, std::array{&run}, packer, progress)) return {};
  PageContent content = packer.finish();
  content.head["about"] = {"map " + candidate.map, fmt::format("law {}, hold {:g} ms", law.law, law.hold_ms),
                           fmt::format("detector {}, {}", run.detector(), vestige::name_of(data.method)),
                           "vestige " + commit().substr(0, 10)};
  for (std::string& damage : damage_of(reader, telling.trace->given)) content.warn(std::move(damage));
  for (std::string& note : notes_of(run, people.size())) content.warn(std::move(note));
  return make_page(telling.trace->name, content);
}

}  // namespace vestige::plot
