#include "cli/choices/law_choice.hpp"

#include <iterator>
#include <vector>

#include "cli/help/validators.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kLawDescription =
    "How strong actuators are for a contact:\n"
    "  binary   its own, fully (the published law)\n"
    "  speed    its own, by the speed of the impact\n"
    "  phantom  those that it lies between share it, so that it is felt in between\n"
    "  gaussian all near it, by their distance along the skin";

}  // namespace

void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description) {
  const std::vector<std::string> names(std::begin(kLawNames), std::end(kLawNames));
  verb.add_option("--law", flags.law, kLawDescription)
      ->group(group)
      ->capture_default_str()
      ->check(CLI::IsMember(names))
      ->type_name("LAW");
  add_law_parameters(verb, flags, group, hold_description);
}

void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group,
                        const std::string& hold_description) {
  verb.add_option("--full-speed", flags.full_speed_m_per_s,
                  "With --law speed: the speed along the skin's normal that asks for all, in metres per second "
                  "[default: 1]")
      ->group(group)
      ->check(help::kPositive)
      ->type_name("SPEED");
  verb.add_option("--sigma", flags.sigma_mm,
                  "With --law gaussian: how wide a contact is felt, in mm along the skin [default: half the median "
                  "distance between neighbours]")
      ->group(group)
      ->check(help::kPositive)
      ->type_name("MM");
  verb.add_option("--actuator", flags.actuator,
                  "The motors, as JSON: what duty makes what amplitude, and a kick that starts them")
      ->group(group)
      ->type_name("FILE.json");
  verb.add_option("--hold", flags.hold_ms, hold_description)
      ->group(group)
      ->capture_default_str()
      ->check(help::kNotNegative)
      ->type_name("MS");
}

}  // namespace vestige::cli
