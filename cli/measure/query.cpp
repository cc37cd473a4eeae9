#include "analysis/stress/query.hpp"

#include <fmt/format.h>

#include <memory>

#include "analysis/base/provenance.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

constexpr std::size_t kMostLinesShown = 10;

enum class Arithmetic { kDouble, kFp32 };

struct QueryOptions {
  CommonOptions common;
  DetectorChoice choice;
  std::vector<std::string> files;
  bool round_fp32 = false;

  Arithmetic arithmetic() const { return round_fp32 ? Arithmetic::kFp32 : Arithmetic::kDouble; }
};

QueryResponder make_responder(const QueryOptions& options) {
  const std::string& detector = options.choice.detector;
  const Method method = options.choice.method_kind();
  if (options.arithmetic() == Arithmetic::kFp32)
    return whole_detector([&](const Avatar& avatar, const ActuatorMap& map) {
      return make_detector(detector, options.choice.context, options.choice, avatar, map, PlaneSet());
    });
  if (detector == "geometry" || detector == "compute")
    throw UsageError("--detector", fmt::format("'{}' takes fp32 numbers only", detector),
                     "add --round-fp32, or choose cpu or exact");
  return detector == "exact" ? exact_truth(method) : deciding_code(method);
}

/// The file's own truth holds for `ccd`, and for a triangle at rest; not for numbers that were rounded since.
QueryTruth truth_of(const QueryFile& file, const QueryOptions& options) {
  const bool same_question = options.choice.method_kind() == Method::kCcd || file.kind == QueryKind::kSegmentTriangle;
  return same_question && options.arithmetic() == Arithmetic::kDouble ? QueryTruth::kFile : QueryTruth::kExact;
}

const char* name_of(QueryTruth truth) {
  return truth == QueryTruth::kFile ? "file" : "exact";
}

void warn_of(const QueryScore& score, const std::vector<std::size_t>& lines, std::string_view kind,
             Verbosity verbosity) {
  if (lines.empty()) return;
  const std::span shown(lines.data(), std::min(lines.size(), kMostLinesShown));
  warn(fmt::format("{}: {}, in the queries that begin in lines {}{}", score.name, counted(lines.size(), kind),
                   fmt::join(shown, ", "), shown.size() < lines.size() ? ", ..." : ""),
       verbosity);
}

void run_query(const QueryOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_outputs({options.common.json}, options.files, options.common);
  const QueryResponder responder = make_responder(options);
  const bool rounded = options.arithmetic() == Arithmetic::kFp32;
  std::vector<QueryFile> files;
  files.reserve(options.files.size());
  for (const std::string& path : options.files) {
    QueryFile file = read_query_file(path, rounded ? Inexact::kRound : Inexact::kRefuse);
    if (!file.ends_in_newline) warn(fmt::format("{}: ends within a line; was it cut off?", path), verbosity);
    if (truth_of(file, options) == QueryTruth::kExact && options.choice.detector == "exact" && !rounded)
      warn(fmt::format("{}: has no truth for --method static, so 'exact' is compared with itself", path), verbosity);
    files.push_back(rounded ? rounded_to_fp32(std::move(file)) : std::move(file));
  }

  catch_interrupts();
  std::vector<QueryScore> scores;
  scores.reserve(files.size());
  QueryScore total;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  {
    Progress progress("Answering", verbosity);
    for (const QueryFile& file : files) {
      const QueryTruth truth = truth_of(file, options);
      const auto before = static_cast<double>(scores.size());
      scores.push_back(answer_queries(file, options.choice.method_kind(), truth, responder, [&](double share) {
        return progress.update((before + share) / static_cast<double>(files.size()));
      }));
      total.add(scores.back());
      list.push_back(to_json(scores.back()));
      list.back()["truth"] = name_of(truth);
      if (interrupted()) throw Error("query", "was stopped before its end", "start it again");
    }
  }

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["detector"] = options.choice.detector;
  json["method"] = options.choice.method;
  json["arithmetic"] = rounded ? "fp32" : "double";
  json["files"] = list;
  json["total"] = to_json(total);
  write_json(options.common.json, json, options.common);
  for (const QueryScore& score : scores) {
    warn_of(score, score.false_positives, "false contact", verbosity);
    warn_of(score, score.false_negatives, "missed contact", verbosity);
  }
  print_summary(query_table(scores, total), {options.common.json}, options.common);
  if (!total.all_right()) invocation.exit_code = kCheckFailed;
}

}  // namespace

void add_query(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<QueryOptions>();
  options->choice.detector = "cpu";
  options->choice.method = "ccd";
  CLI::App* verb = add_verb(program, "query", "Answer point/triangle queries whose truth is known",
                            "  vestige query queries.csv\n"
                            "  vestige query queries.csv --detector exact --round-fp32 --json -\n");
  verb->add_option(
          "CSV", options->files,
          "Files of queries. A query is eight rows (the point and the triangle's corners at t = 0, then at t = 1) of "
          "x, y, z as numerator,denominator and the truth; or one row with a segment and a triangle, as hexadecimal "
          "doubles")
      ->required()
      ->type_name("FILE");
  verb->add_option("--detector", options->choice.detector,
                   "The detector that answers; geometry and compute need --round-fp32")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->check(CLI::IsMember({"cpu", "exact", "geometry", "compute"}));
  verb->add_option("--context", options->choice.context, "OpenGL context that geometry and compute run in")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}));
  verb->add_option("--method", options->choice.method,
                   "ccd: point and triangle both move; static: the point's way against the triangle at t = 1; if the "
                   "file's truth is for ccd, the truth comes from exact arithmetic")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->check(CLI::IsMember({"static", "ccd"}));
  verb->add_flag(
          "--round-fp32", options->round_fp32,
          "Round every coordinate to fp32 and ask the whole detector that replay runs; the truth then comes from "
          "exact arithmetic")
      ->group(kDetectorGroup);
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_query(*options, invocation); });
}

}  // namespace vestige::cli
