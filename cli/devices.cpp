#include <fmt/format.h>

#include <functional>
#include <memory>

#include "analysis/provenance.hpp"
#include "cli/verbs.hpp"
#include "detector/gl/gl_context.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

namespace {

void run_devices(const CommonOptions& options) {
  check_outputs({options.json}, {}, options);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  const auto attempt = [&](const std::string& name, const std::function<std::unique_ptr<GlContext>()>& make) {
    try {
      const auto context = make();
      list.push_back(to_json(context->info()));
      text += fmt::format("{:<16} {}, OpenGL {}\n", name, context->info().renderer, context->info().version);
    } catch (const Error& error) {
      const std::string_view reason = error.what();
      const std::string_view line = reason.substr(0, reason.find('\n'));
      list.push_back({{"context", name}, {"unusable", line}});
      text += fmt::format("{:<16} unusable: {}\n", name, line);
    }
  };
  attempt("egl-surfaceless", make_egl_surfaceless_context);
  const std::vector<EglDevice> devices = list_egl_devices();
  for (int i = 0; i < static_cast<int>(devices.size()); ++i)
    attempt(fmt::format("egl-device-{}", i), [i] { return make_egl_device_context(i); });
  attempt("osmesa", make_osmesa_context);
  write_json(options.json, {{"contexts", list}}, options);
  print_summary(text, {options.json}, options);
}

}  // namespace

void add_devices(CLI::App& program, Invocation&) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App* verb = add_verb(program, "devices", "List the OpenGL contexts that this machine offers",
                            "  vestige devices\n"
                            "  vestige devices --json -\n");
  add_common_options(*verb, *options);
  verb->callback([options] { run_devices(*options); });
}

}  // namespace vestige::cli
