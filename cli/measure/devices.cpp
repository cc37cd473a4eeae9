#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "cli/verbs.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_limits.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

/// A context that this machine offers, or the reason why it does not.
struct Offer {
  std::string name;
  GlInfo info;
  std::vector<GlLimit> limits;
  std::string unusable;
  std::optional<EglDevice> device;
  int device_number = -1;
};

Offer try_context(const std::string& name, const std::function<std::unique_ptr<GlContext>()>& make) {
  Offer offer;
  offer.name = name;
  try {
    const auto context = make();
    offer.info = context->info();
    offer.limits = gl_limits(*context);
  } catch (const Error& error) {
    offer.unusable = std::string(error.what()).substr(0, std::string_view(error.what()).find('\n'));
  }
  return offer;
}

std::vector<Offer> try_all() {
  std::vector<Offer> offers = {try_context("egl-surfaceless", make_egl_surfaceless_context)};
  const std::vector<EglDevice> devices = list_egl_devices();
  for (int i = 0; i < static_cast<int>(devices.size()); ++i) {
    offers.push_back(try_context(fmt::format("egl-device-{}", i), [i] { return make_egl_device_context(i); }));
    offers.back().device = devices[static_cast<std::size_t>(i)];
    offers.back().device_number = i;
  }
  offers.push_back(try_context("osmesa", make_osmesa_context));
  return offers;
}

/// What `--context auto` takes; empty when there is nothing.
GlInfo automatic_context() {
  try {
    return make_gl_context(ContextKind::kAuto, -1)->info();
  } catch (const Error&) {
    return {};
  }
}

/// What `paper` lacks there; empty when it has all it needs.
std::string shortcomings(const Offer& offer) {
  std::string text;
  for (const GlLimit& limit : offer.limits)
    if (limit.value < limit.needed)
      text += fmt::format("{}{} is {}, {} needed", text.empty() ? "" : "; ", limit.name, limit.value, limit.needed);
  return text;
}

/// Why `geometry` is refused there; empty if it is not.
std::string refusal(const Offer& offer) {
  return offer.unusable.empty() ? breaks_proofs(offer.info.arithmetic, offer.info.probe_refusal) : "";
}

nlohmann::ordered_json to_json(const Offer& offer) {
  nlohmann::ordered_json json = {{"context", offer.name}};
  if (offer.unusable.empty()) {
    json.update(vestige::to_json(offer.info));
    for (const GlLimit& limit : offer.limits) json["limits"][limit.name] = limit.value;
    const std::string lacks = shortcomings(offer);
    const std::string broken = refusal(offer);
    json["geometry_refused"] = broken.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(broken);
    json["paper_lacks"] = lacks.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(lacks);
  } else {
    json["unusable"] = offer.unusable;
  }
  if (offer.device) {
    const EglDevice& device = *offer.device;
    json["egl_device"] = {{"number", offer.device_number},     {"software", device.software},
                          {"vendor", device.vendor},           {"drm_node", device.drm_node},
                          {"render_node", device.render_node}, {"extensions", device.extensions}};
    json["egl_device"]["cuda_device"] =
        device.cuda_device < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(device.cuda_device);
  }
  return json;
}

std::string describe(const EglDevice& device) {
  std::vector<std::string> parts;
  for (const std::string& part : {device.vendor, device.drm_node, device.render_node})
    if (!part.empty()) parts.push_back(part);
  if (device.cuda_device >= 0) parts.push_back(fmt::format("CUDA device {}", device.cuda_device));
  if (device.software) parts.emplace_back("software");
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Returns one line for each stage.
std::vector<std::string> describe(const std::vector<StageArithmetic>& stages) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& name, const StageArithmetic& stage) {
    const bool keeps = stage.keeps_denormal_operands && stage.keeps_denormal_results;
    lines.push_back(fmt::format("{} shaders: {}{}, {} denormals, {}, divide to {:.2g} ulp", name,
                                stage.misrounded.empty() ? "to " : "", stage.rounding, keeps ? "keep" : "flush",
                                stage.contracts ? "use fma" : "no fma", stage.division_error_ulp));
  };
  for (const StageArithmetic& stage : stages) add(stage.stage, stage);
  return lines;
}

std::string describe(const Offer& offer, const std::string& automatic) {
  const auto line = [](const std::string& text) { return text.empty() ? "" : fmt::format("{:20}{}\n", "", text); };
  const char mark = offer.name == automatic ? '*' : ' ';
  std::string text;
  if (offer.unusable.empty()) {
    text = fmt::format("{} {:<16}  {}: {}\n", mark, offer.name, offer.info.software ? "software" : "hardware",
                       offer.info.renderer);
    text += line(fmt::format("OpenGL {}; vendor {}", offer.info.version, offer.info.vendor));
    for (const std::string& measured : describe(offer.info.arithmetic)) text += line(measured);
  } else {
    text = fmt::format("{} {:<16}  unusable: {}\n", mark, offer.name, offer.unusable);
  }
  if (offer.device) text += line("EGL device: " + describe(*offer.device));
  const std::string lacks = shortcomings(offer);
  const std::string broken = refusal(offer);
  if (!broken.empty()) text += line("'geometry' is refused there: " + broken);
  return text + line(lacks.empty() ? "" : "'paper' cannot run there: " + lacks);
}

bool same_limits(const Offer& a, const Offer& b) {
  return std::ranges::equal(a.limits, b.limits, {}, &GlLimit::value, &GlLimit::value);
}

/// A row a limit, a column a context. Contexts with the same limits share one.
std::string limits_table(const std::vector<Offer>& offers) {
  std::vector<const Offer*> columns;
  std::string shared;
  for (const Offer& offer : offers) {
    if (offer.limits.empty()) continue;
    const auto same = std::ranges::find_if(columns, [&](const Offer* other) { return same_limits(offer, *other); });
    if (same == columns.end()) {
      columns.push_back(&offer);
    } else {
      shared += fmt::format("  {} has the limits of {}\n", offer.name, (*same)->name);
    }
  }
  if (columns.empty()) return "";
  std::string text = fmt::format("\n{:<36}", "Limits");
  for (const Offer* offer : columns) text += fmt::format(" {:>15}", offer->name);
  text += '\n';
  for (std::size_t i = 0; i < columns.front()->limits.size(); ++i) {
    text += fmt::format("  {:<34}", columns.front()->limits[i].meaning);
    for (const Offer* offer : columns) text += fmt::format(" {:>15}", offer->limits[i].value);
    text += '\n';
  }
  return text + shared;
}

void run_devices(const CommonOptions& options, const Invocation& invocation) {
  check_outputs({options.json}, {}, options);
  const std::vector<Offer> offers = try_all();
  const GlInfo automatic = automatic_context();
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["auto"] = vestige::to_json(automatic);
  json["contexts"] = nlohmann::ordered_json::array();
  std::string text;
  for (const Offer& offer : offers) {
    json["contexts"].push_back(to_json(offer));
    text += describe(offer, automatic.context);
  }
  text +=
      automatic.context.empty()
          ? "This machine offers no OpenGL 4.5 context: 'paper' and 'geometry' cannot run. 'cpu' needs no context.\n"
          : "* marks the context that --context auto takes.\n";
  write_json(options.json, json, options);
  print_summary(text + limits_table(offers), {options.json}, options);
}

}  // namespace

void add_devices(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App* verb = add_verb(program, "devices", "List the OpenGL contexts that this machine offers",
                            "  vestige devices\n"
                            "  vestige devices --json -\n");
  add_common_options(*verb, *options);
  verb->callback([options, &invocation] { run_devices(*options, invocation); });
}

}  // namespace vestige::cli
