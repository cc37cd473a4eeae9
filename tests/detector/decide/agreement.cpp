// The deciding code against the slow truth on as many seeded pairs as one likes:
// agreement --method static|ccd [--spheres] --pairs N --seed K --threads N [--family NAME]. Prints JSON; exits 4 where
// anything differs. Which pairs are asked about depends on --seed, --pairs and --family alone.

#include "tests/support/pairs/agreement.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "analysis/base/provenance.hpp"
#include "tests/support/pairs/contact_cases.hpp"

namespace {

using vestige::test::Agreement;

struct Settings {
  vestige::Method method = vestige::Method::kStatic;
  bool spheres = false;
  std::uint64_t pairs = 1'000'000;
  std::uint64_t seed = 1;
  unsigned threads = 1;
  std::vector<std::string> families;
};

constexpr std::uint64_t kPart = 4096;  // pairs of one seed

/// The families take turns. Exact arithmetic on `extreme` takes a hundred times as long as on others: its turn comes
/// more rarely.
const std::string& family_of(std::uint64_t part, const Settings& settings) {
  constexpr std::uint64_t kRarity = 32;
  const std::size_t count = settings.families.size();
  const std::string& family = settings.families[part % count];
  const bool skipped = family == "extreme" && part / count % kRarity != 0;
  return skipped ? settings.families[(part + 1) % count] : family;
}

std::map<std::string, Agreement> compare(const Settings& settings) {
  const std::uint64_t parts = (settings.pairs + kPart - 1) / kPart;
  std::map<std::string, Agreement> by_family;
  std::mutex mutex;
  std::atomic<std::uint64_t> next = 0;
  const auto work = [&] {
    for (std::uint64_t part = next++; part < parts; part = next++) {
      const std::string& family = family_of(part, settings);
      const std::uint64_t pairs = std::min(kPart, settings.pairs - part * kPart);
      constexpr std::uint64_t kMostParts = std::uint64_t{1} << 32;
      const auto compare_part =
          settings.spheres ? vestige::test::compare_spheres_with_truth : vestige::test::compare_with_truth;
      const Agreement agreement = compare_part(settings.method, family, settings.seed * kMostParts + part, pairs);
      const std::lock_guard lock(mutex);
      by_family[family].add(agreement);
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(settings.threads);
  for (unsigned i = 0; i < settings.threads; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return by_family;
}

nlohmann::ordered_json to_json(const Agreement& agreement) {
  return {{"pairs", agreement.pairs},
          {"contacts", agreement.contacts},
          {"decided_exactly", agreement.exact_arithmetic},
          {"differences", agreement.differences},
          {"slowest_us", 1e6 * agreement.slowest_s}};
}

}  // namespace

int main(int argc, char** argv) {
  const auto all = vestige::test::case_families();
  Settings settings;
  settings.families.assign(all.begin(), all.end());
  CLI::App app("Compares the deciding code with the slow truth.");
  const std::map<std::string, vestige::Method> methods = {{"static", vestige::Method::kStatic},
                                                          {"ccd", vestige::Method::kCcd}};
  app.add_option("--method", settings.method)->transform(CLI::CheckedTransformer(methods));
  app.add_flag("--spheres", settings.spheres);
  app.add_option("--pairs", settings.pairs)->check(CLI::PositiveNumber);
  app.add_option("--seed", settings.seed);
  app.add_option("--threads", settings.threads)->check(CLI::Range(1, 1024));
  app.add_option("--family", settings.families)->check(CLI::IsMember(settings.families));
  CLI11_PARSE(app, argc, argv);

  std::vector<std::string> arguments(argv, argv + argc);
  arguments.front() = "agreement";  // not where it happens to lie
  nlohmann::ordered_json report = vestige::provenance(arguments);
  report["method"] = vestige::name_of(settings.method);
  if (settings.spheres) report["colliders"] = "spheres";
  report["seed"] = settings.seed;
  Agreement total;
  for (const auto& [family, agreement] : compare(settings)) {
    report["families"][family] = to_json(agreement);
    total.add(agreement);
  }
  report["total"] = to_json(total);
  report["examples"] = total.examples;
  fmt::print("{}\n", report.dump(2));
  return total.differences == 0 ? 0 : 4;
}
