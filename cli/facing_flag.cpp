#include "cli/facing_flag.hpp"

#include <optional>
#include <vector>

namespace vestige::cli {

CLI::Option* add_facing_option(CLI::App& verb, FacingChoice& choice) {
  std::vector<std::string> axes(kFacingNames.begin(), kFacingNames.end());
  axes.emplace_back("auto");
  return verb
      .add_option("--facing", choice.axis,
                  "Which way the avatar faces at rest: auto finds it by its joints' names, its feet or VRM; it decides "
                  "what is left and what is front")
      ->capture_default_str()
      ->check(CLI::IsMember(axes));
}

void settle_facing(Avatar& avatar, const FacingChoice& choice, const std::string& name, Verbosity verbosity) {
  for (const std::string& warning : vestige::settle_facing(avatar.facing, choice.axis, std::nullopt, name))
    warn(warning, verbosity);
}

}  // namespace vestige::cli
