#include "cli/choices/law_choice.hpp"

#include <fmt/format.h>

#include <iterator>

#include "cli/help/validators.hpp"

namespace vestige::cli {

namespace {

std::string describe_laws() {
  std::string text = "How strongly a contact drives the actuators:";
  for (const LawInfo& law : laws())
    if (!law.summary.empty()) fmt::format_to(std::back_inserter(text), "\n  {:<8} {}", law.name, law.summary);
  return text;
}

// `vestige plot paraview` explains --hold in the same words.
constexpr const char* kHoldHelp =
    "How long a contact is felt, in ms: a coin motor cannot answer a single frame; 0 gives the raw frames";

}  // namespace

void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_remark) {
  verb.add_option("--law", flags.law, describe_laws())
      ->group(group)
      ->capture_default_str()
      ->check(CLI::IsMember(law_names()))
      ->type_name("LAW");
  add_law_parameters(verb, flags, group, hold_remark);
}

void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_remark) {
  for (std::size_t i = 0; i < flags.parameters.size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    verb.add_option(known.flag, flags.parameters[i], known.help)
        ->group(group)
        ->check(help::kPositive)
        ->type_name(known.type_name);
  }
  verb.add_option("--actuator", flags.actuator,
                  "A description of the motors in JSON: the duty for each amplitude, and a kick that starts them")
      ->group(group)
      ->type_name("FILE.json");
  verb.add_option("--hold", flags.hold_ms, kHoldHelp + hold_remark)
      ->group(group)
      ->capture_default_str()
      ->check(help::kNotNegative)
      ->type_name("MS");
}

}  // namespace vestige::cli
