#include "analysis/plot/data/stress_data.hpp"

#include "analysis/base/json_field.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a folder that 'vestige stress' wrote, or run it again";
constexpr double kMostCases = 1e15;
constexpr double kMostMagnitude = 1e30;

StressCell read_cell(const JsonField& field) {
  StressCell cell;
  cell.detector = field.at("detector").text();
  cell.method = field.at("method").text();
  cell.cases = field.at("cases").within(1, kMostCases);
  cell.missed = field.at("false_negatives").within(0, cell.cases);
  cell.false_contacts = field.at("false_positives").within(0, cell.cases);
  cell.elsewhere = field.at("wrong_triangle").within(0, cell.cases) + field.at("wrong_actuator").within(0, cell.cases);
  if (cell.error_rate() > 1) field.refuse("has more errors than cases");
  if (field.has("felt_share_low") && field.has("felt_share_high")) {
    cell.low = field.at("felt_share_low").within(0, 1);
    cell.high = field.at("felt_share_high").within(*cell.low, 1);
  }
  return cell;
}

void read_machine(const std::filesystem::path& file, StressResult& result) {
  const nlohmann::json json = read_json(file, kRemedy);
  const JsonField document(json, file, kRemedy);
  if (document.has("gl")) result.renderer = phrase(document.at("gl"), {{"renderer", ""}, {"version", ""}});
  if (document.has("machine"))
    result.machine = phrase(document.at("machine"), {{"processor", ""}, {"cores", " cores"}});
  result.commit = commit_of(document);
}

}  // namespace

StressResult read_stress(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "stress.json";
  const nlohmann::json json = read_json(file, kRemedy);
  const JsonField families = JsonField(json, file, kRemedy).at("families");
  StressResult result;
  for (std::size_t i = 0; i < families.count(); ++i) {
    const JsonField field = families.at(i);
    StressLine line = {field.at("name").text(),
                       field.at("variant").text(),
                       field.at("magnitude").within(-kMostMagnitude, kMostMagnitude),
                       {}};
    const bool continues = !result.lines.empty() && result.lines.back().name == line.name &&
                           result.lines.back().variant == line.variant &&
                           result.lines.back().magnitude == line.magnitude;
    if (!continues) result.lines.push_back(std::move(line));
    result.lines.back().cells.push_back(read_cell(field));
  }
  const std::filesystem::path run = folder / "run.json";
  if (std::filesystem::exists(run)) read_machine(run, result);
  return result;
}

}  // namespace vestige::plot
