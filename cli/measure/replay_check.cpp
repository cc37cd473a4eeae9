#include "cli/measure/replay_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "detector/output/recorded_contacts.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/hdf5/hdf5_reader.hpp"

namespace vestige::cli {

std::optional<std::vector<RecordedContact>> read_expected(const std::string& verify, std::size_t people) {
  if (verify.empty() || is_detector(verify)) return {};
  if (!verify.ends_with(".csv") && !has_hdf5_name(verify) && !is_hdf5(verify)) return {};
  return read_contacts(verify, {.people = std::vector<PersonLimits>(people)});
}

Verification load_verification(const ReplayOptions& options, const OpenTrace& trace, const Detector& detector,
                               PlaneSet planes, std::optional<std::vector<RecordedContact>> expected) {
  Verification verification;
  if (options.verify.empty()) return verification;
  if (is_detector(options.verify)) {
    if (options.verify == detector.name())
      throw UsageError("--verify", fmt::format("'{}' would be compared with itself", options.verify),
                       "name another detector, or a file");
    verification.detectors = std::make_unique<DetectorTeam>(
        options.threads, [&] { return make_detectors(options.verify, options.choice, trace.people, planes); });
  } else if (options.verify == "-" || options.verify == "auto") {
    throw UsageError("--verify", fmt::format("'{}' is neither a detector nor a file", options.verify),
                     fmt::format("name {}, or a file that an earlier replay wrote", fmt::join(detector_names(), ", ")));
  } else if (expected) {
    verification.contacts = std::move(*expected);
    verification.by_contacts = true;
  } else {
    const auto json = nlohmann::json::parse(read_text_file(options.verify), nullptr, false);
    if (!json.is_object() || !json.contains("texture_hash") || !json["texture_hash"].is_string())
      throw Error(options.verify,
                  "is neither a detector, nor contacts (.csv, .h5), nor a replay's JSON with a texture_hash",
                  fmt::format("name {}, or a file that 'vestige replay --contacts FILE.csv' or '--json FILE' wrote",
                              fmt::join(detector_names(), ", ")));
    verification.texture_hash = json["texture_hash"].get<std::string>();
  }
  return verification;
}

int report_verification(const ReplayOptions& options, const ReplayResult& result, const Verification& verification,
                        const std::vector<std::string>& outputs) {
  if (options.verify.empty()) return kDone;
  if (result.interrupted) {
    print_summary(fmt::format("verify against {}: stopped before the end\n", options.verify), outputs, options.common);
    return kDataLost;
  }
  const bool by_hash = !result.comparison;
  const bool same = by_hash ? result.texture_hash == verification.texture_hash : result.comparison->differing() == 0;
  std::string text = by_hash ? std::string(same ? "the texture hashes are equal" : "the texture hashes differ")
                             : describe(*result.comparison);
  print_summary(fmt::format("verify against {}: {}\n", options.verify, text), outputs, options.common);
  return same ? kDone : kCheckFailed;
}

}  // namespace vestige::cli
