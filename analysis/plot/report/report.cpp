#include "analysis/plot/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "analysis/base/growing_folder.hpp"
#include "analysis/plot/canvas/figure_export.hpp"
#include "analysis/plot/canvas/headless_window.hpp"
#include "analysis/plot/data/report_data.hpp"
#include "analysis/plot/figures/timeline_figure.hpp"
#include "analysis/plot/report/error_figure.hpp"
#include "analysis/plot/report/map_pictures.hpp"
#include "analysis/plot/report/map_view.hpp"
#include "analysis/plot/report/ranking_figure.hpp"
#include "analysis/plot/report/report_page.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "analysis/scoring/contact_recording_file.hpp"
#include "analysis/scoring/scores.hpp"
#include "analysis/view/page.hpp"
#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/input_file.hpp"
#include "traces/files/output_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige::plot {

namespace {

constexpr std::size_t kRankedShown = 40;
/// The best maps that can be watched. Each page takes a megabyte or more.
constexpr std::size_t kMapsWatched = 3;
/// Stands between map and trace in the page's name, and in no name of these.
constexpr char kOfTrace = '+';

/// Thrown where the user stopped; not an error.
struct Stopped {};

/// The contacts of a batch's traces.
struct Contacts {
  std::vector<RecordedContact> all;
  ContactRecording shown;  ///< of the trace with the most
  std::map<std::string, CoveredPlaces> shown_covered;
  std::string shown_trace;

  /// A map's layout, for scoring the contacts that are shown.
  ScoredLayout scored(const ActuatorLayout& layout, const std::string& map) const {
    const auto covered = shown_covered.find(map);
    if (covered == shown_covered.end()) return {&layout};
    for (const CoveredPlace& place : covered->second.places)
      if (place.actuator >= layout.actuator_count())
        throw Error(
            "contacts/" + shown_trace + ".csv",
            fmt::format("names actuator {} of {}, which has only {}", place.actuator + 1, map, layout.actuator_count()),
            kFileRemedy);
    return {&layout, &covered->second};
  }
};

RecordedTrace read_trace_contacts(const std::filesystem::path& file) {
  require_there(file);
  try {
    return read_contact_recording(file.string());
  } catch (const Error& error) {
    throw Error("contacts", error.fault(), kFileRemedy);
  }
}

Contacts read_contacts(const std::filesystem::path& folder, const ReportData& data, const Avatar& avatar) {
  Contacts contacts;
  for (const ReportTrace& trace : data.traces) {
    const std::filesystem::path file = folder / "contacts" / (trace.name + ".csv");
    RecordedTrace recorded = read_trace_contacts(file);
    ContactRecording& recording = recorded.contacts;
    for (std::size_t i = 0; i < recording.contacts.size(); ++i) {
      const Contact& contact = recording.contacts[i];
      if (contact.triangle >= avatar.triangles.size())
        throw Error(
            file.string(),
            fmt::format("names triangle {}, but avatar.glb has only {}", contact.triangle, avatar.triangles.size()),
            kFileRemedy);
      const glm::dvec2& weights = contact.barycentric;
      constexpr double kSlack = 1e-9;
      if (!(weights.x >= 0 && weights.y >= 0 && weights.x + weights.y <= 1 + kSlack))
        throw Error(file.string(), fmt::format("contact {}: u and v are not weights from 0 to 1", i + 1), kFileRemedy);
      RecordedContact one;
      one.triangle = contact.triangle;
      one.barycentric = contact.barycentric;
      contacts.all.push_back(one);
    }
    if (recording.contacts.size() > contacts.shown.contacts.size()) {
      contacts.shown = std::move(recording);
      contacts.shown_covered = std::move(recorded.covered);
      contacts.shown_trace = trace.name;
    }
  }
  return contacts;
}

Avatar read_batch_avatar(const std::filesystem::path& folder, const ReportData& data) {
  const std::string file = (folder / "avatar.glb").string();
  require_there(file);
  const std::vector<std::byte> glb = read_file(file);  // a torn one is told before it is parsed
  require_judged(file, sha256_hex(glb), data.avatar_sha256);
  Avatar avatar = parse_avatar_glb(glb, file);
  take_recorded_facing(avatar.facing, data.avatar_facing);
  return avatar;
}

ActuatorMap read_batch_map(const std::filesystem::path& folder, const ReportData& data, const std::string& map,
                           const Avatar& avatar) {
  const std::string file = (folder / "maps" / (map + ".png")).string();
  require_there(file);
  const ActuatorMapFiles files = read_actuator_map_files(file);
  const auto judged = data.map_sha256.find(map);
  if (judged != data.map_sha256.end())
    require_judged(file + " or its sidecar", sha256_of(files), judged->second);  // one SHA-256 is of both
  return parse_actuator_map(files, avatar, file);
}

/// " belly fires back 1-1, back 2-1 (0.5)."; empty where every region fires its own actuator.
std::string fires_in_words(const ActuatorMap& map) {
  std::string text;
  for (std::uint32_t region = 0; region < map.actuator_count; ++region)
    if (!map.firing.is_own(region))
      text += fmt::format(" {} fires {}.", map.names[region], vestige::describe(map.firing.of(region), map.names));
  return text;
}

/// What the actuators are told over the trace.
Timeline timeline_of(const ContactRecording& recording, const ScoredLayout& layout, IntensityLaw& law) {
  const ActuatorMap& map = layout.layout->map();
  Timeline timeline;
  timeline.actuator_count = map.actuator_count;
  timeline.names = map.names;
  std::uint32_t columns = 0;
  for (const std::uint32_t column : recording.column) columns = std::max(columns, column + 1);
  ContactRow row;
  std::vector<std::size_t> contact_of(columns);
  const auto covered = [&](std::uint32_t column) {
    return layout.covered == nullptr ? std::span<const CoveredPlace>() : layout.covered->of(contact_of[column]);
  };
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) {
    row.clear(columns);
    for (std::size_t i = recording.first[frame]; i < recording.first[frame + 1]; ++i) {
      Contact contact = recording.contacts[i];
      contact.actuator = map.at(contact.triangle, contact.texture_coordinate);
      row[recording.column[i]] = contact;
      contact_of[recording.column[i]] = i;
    }
    const std::vector<double>& amplitude = law.next(recording.time_s[frame], row, covered);
    const bool again = !timeline.time_s.empty() && recording.time_s[frame] <= timeline.time_s.back();
    if (!again) {
      timeline.time_s.push_back(recording.time_s[frame]);
      timeline.duty.resize(timeline.duty.size() + map.actuator_count);
    }
    std::uint8_t* duty = &timeline.duty[timeline.duty.size() - map.actuator_count];
    for (std::size_t i = 0; i < map.actuator_count; ++i)
      duty[i] = std::max(duty[i], static_cast<std::uint8_t>(std::lround(std::clamp(amplitude[i], 0.0, 1.0) * 255)));
  }
  return timeline;
}

class Report {
 public:
  Report(const std::filesystem::path& batch, const ReportOptions& options, const std::function<bool(double)>& progress)
      : batch_(batch), options_(options), progress_(progress) {}

  ReportOutcome write() {
    const std::filesystem::path page_file = options_.output / "report.html";
    const ReportData data = read_report(batch_);
    make_folder(options_.output);
    refuse_overwrite(page_file, options_.overwrite);
    folder_.emplace(options_.output / "figures", options_.overwrite);
    outcome_.page = page_file;

    const Avatar avatar = read_batch_avatar(batch_, data);
    const Contacts contacts = read_contacts(batch_, data, avatar);
    const std::vector<std::string> maps = data.maps();
    const std::size_t pictured = std::min(options_.top, maps.size());
    figures_expected_ = 1 + pictured * (4 + data.laws.size());

    ReportPage page = {data, {}, {}, contacts.shown_trace};
    if (data.ranking.front().headline.mean) {
      std::string caption = "Each combination of map and law: mean over traces";
      caption += data.has_intervals() ? ", and its 95\u00a0% interval. Filled: cannot be distinguished from the first."
                                      : ", without an interval.";
      if (data.ranking.size() > kRankedShown) caption += fmt::format(" The best {} are drawn.", kRankedShown);
      page.ranking.push_back(draw("ranking", *ranking_figure(data, kRankedShown), caption));
    }
    const MapPictures pictures(avatar, contacts.all);
    for (std::size_t i = 0; i < pictured; ++i) {
      page.maps.push_back(
          section(data, maps[i], avatar, contacts, pictures, read_batch_map(batch_, data, maps[i], avatar)));
      if (i < kMapsWatched) page.maps.back().view = watch(data, data.best_of(maps[i]));
    }

    const std::string html = report_html(page);
    folder_->commit([](const std::filesystem::path&) { return false; });
    remove_other_views(page.maps, maps);
    remove_figures(std::span(maps).subspan(pictured), data.laws);
    OutputFile file(page_file, options_.overwrite);
    file.write(html);
    file.commit();
    return std::move(outcome_);
  }

 private:
  PageFigure draw(const std::string& stem, const Figure& figure, std::string caption) {
    if (!progress_(static_cast<double>(outcome_.figures) / static_cast<double>(figures_expected_))) throw Stopped();
    PageFigure page = {stem, svg_of(figure), figure.description(), std::move(caption)};
    write_file(stem + ".svg", page.svg);
    if (outcome_.has_pictures) {
      try {
        write_file(stem + ".png", png_of(figure));
      } catch (const GlUnavailable& error) {
        outcome_.has_pictures = false;
        outcome_.warnings.push_back(fmt::format("{}: PNG files are left out: {}\n  install libegl1 and libgl1-mesa-dri",
                                                (options_.output / "figures").string(), error.what()));
      }
    }
    ++outcome_.figures;
    return page;
  }

  void write_file(const std::string& name, std::string_view bytes) {
    OutputFile file(folder_->path() / name, Overwrite::kAllow);
    file.write(bytes);
    file.commit();
  }

  /// Draws the page on which a map is watched, if there is a trace for it.
  MapView watch(const ReportData& data, const Candidate& candidate) {
    if (data.approximate)
      return {"", "", std::nullopt, {}, "the batch's detector puts simpler shapes in place of the skin"};
    TellingTrace telling = telling_trace(batch_, data, candidate);
    MapView view = {"", "", telling.value, std::move(telling.not_there)};
    if (telling.trace == nullptr) return view;
    view.trace = telling.trace->name;
    draw_view(data, candidate, telling, view);
    return view;
  }

  void draw_view(const ReportData& data, const Candidate& candidate, const TellingTrace& telling, MapView& view) {
    const double done = static_cast<double>(outcome_.figures) / static_cast<double>(figures_expected_);
    const std::string name = fmt::format("{}{}{}.html", candidate.map, kOfTrace, view.trace);
    try {
      const std::optional<std::string> page =
          map_view(batch_, data, candidate, telling, [&](double) { return progress_(done); });
      if (!page) throw Stopped();
      if (page->size() <= kLargePage_bytes) {
        write_file(name, *page);
        view.file = "figures/" + name;
        return;
      }
      view.problem = fmt::format("of {} it would have {:.0f} MB", view.trace, static_cast<double>(page->size()) / 1e6);
    } catch (const Error& error) {
      view.problem = fmt::format("{} cannot be drawn", view.trace);
      outcome_.warnings.push_back(fmt::format("{}: no page on which it moves: {}", view.trace, error.what()));
    }
  }

  /// Removes the pages of an earlier report, which this one does not show.
  void remove_other_views(const std::vector<MapSection>& maps, const std::vector<std::string>& names) const {
    std::set<std::string> shown;
    for (const MapSection& map : maps)
      if (map.view) shown.insert(std::filesystem::path(map.view->file).filename().string());
    std::vector<std::filesystem::path> others;
    for (const auto& entry : std::filesystem::directory_iterator(options_.output / "figures")) {
      const std::string file = entry.path().filename().string();
      const bool is_view = file.ends_with(".html") && std::ranges::any_of(names, [&](const std::string& map) {
                             return file.starts_with(map + kOfTrace);
                           });
      if (is_view && !shown.contains(file)) others.push_back(entry.path());
    }
    std::error_code ignored;
    for (const std::filesystem::path& other : others) std::filesystem::remove(other, ignored);
  }

  /// Removes the figures that an earlier report drew of these maps.
  void remove_figures(std::span<const std::string> maps, const std::vector<std::string>& laws) const {
    std::vector<std::string> kinds = {"regions", "contacts", "not-felt", "errors"};
    kinds.reserve(kinds.size() + laws.size());
    for (const std::string& law : laws) kinds.push_back("timeline-" + law);
    std::error_code ignored;
    for (const std::string& map : maps)
      for (const std::string& kind : kinds)
        for (const char* extension : {"svg", "png"})
          std::filesystem::remove(options_.output / "figures" / fmt::format("{}-{}.{}", map, kind, extension), ignored);
  }

  MapSection section(const ReportData& data, const std::string& name, const Avatar& avatar, const Contacts& contacts,
                     const MapPictures& pictures, ActuatorMap map) {
    MapSection section;
    section.map = name;
    section.contacts = contacts.all.size();
    // The batch knows more than the files do: how it made a layout.
    const auto told = data.map_warnings.find(name);
    section.warnings = told == data.map_warnings.end() ? map.warnings : told->second;
    for (const std::string& actuator : map.names)
      section.actuators.push_back(
          {actuator.empty() ? fmt::format("actuator {}", section.actuators.size() + 1) : actuator, 0});
    for (const RecordedContact& contact : contacts.all) {
      const std::uint16_t actuator =
          actuator_at(avatar, map, contact.triangle, contact.barycentric.x, contact.barycentric.y);
      if (actuator == 0)
        ++section.unmapped;
      else
        ++section.actuators[actuator - 1U].contacts;
    }
    section.bodies.push_back(
        draw(name + "-regions", *pictures.regions(map), "Regions and their actuators' numbers." + fires_in_words(map)));
    section.bodies.push_back(draw(name + "-contacts", *pictures.contacts(map), "Where contacts are."));
    section.bodies.push_back(draw(name + "-not-felt", *pictures.unfelt(map),
                                  "Where contacts are on skin without an actuator, which no law lets feel."));
    if (contacts.shown.contacts.empty() || map.actuator_count == 0) return section;

    const auto layout = std::make_shared<const ActuatorLayout>(avatar, std::move(map));
    const ScoredLayout scored = contacts.scored(*layout, name);
    const LawOptions& law_options = data.law_options;
    std::vector<ErrorSeries> errors;
    for (const std::string& law : data.laws) errors.push_back(errors_of(contacts.shown, scored, data, law));
    section.errors.push_back(draw(
        name + "-errors", *error_figure(std::move(errors), contacts.shown.time_s.front(), contacts.shown.time_s.back()),
        fmt::format("Localisation error of each contact of {} over time; line: median. Orange, below: not felt.",
                    contacts.shown_trace)));
    std::vector<std::string> laws = data.laws;
    std::stable_partition(laws.begin(), laws.end(),  // clang 14 does not take std::ranges::stable_partition
                          [&](const std::string& law) { return law == data.best_of(name).law; });
    for (const std::string& law : laws) {
      const std::unique_ptr<IntensityLaw> made = make_law(law, layout, law_options);
      section.timelines.push_back(
          draw(fmt::format("{}-timeline-{}", name, law), *timeline_figure(timeline_of(contacts.shown, scored, *made)),
               fmt::format("Amplitude of each actuator over {} under {} (duty 255 is full), contacts held for {:g} ms.",
                           contacts.shown_trace, law, 1e3 * law_options.hold_s)));
    }
    return section;
  }

  static ErrorSeries errors_of(const ContactRecording& recording, const ScoredLayout& layout, const ReportData& data,
                               const std::string& law) {
    ErrorSeries series;
    series.law = law;
    LawChoice choice;
    choice.name = law;
    choice.options = data.law_options;
    choice.actuators = data.actuators;
    series.error_mm = contact_errors_mm(recording, layout, choice);
    for (std::size_t frame = 0; frame < recording.frames(); ++frame)
      series.time_s.insert(series.time_s.end(), recording.first[frame + 1] - recording.first[frame],
                           recording.time_s[frame]);
    return series;
  }

  const std::filesystem::path& batch_;
  const ReportOptions& options_;
  const std::function<bool(double)>& progress_;
  std::optional<GrowingFolder> folder_;
  std::size_t figures_expected_ = 1;
  ReportOutcome outcome_;
};

}  // namespace

ReportOutcome write_report(const std::filesystem::path& batch, const ReportOptions& options,
                           const std::function<bool(double)>& progress) {
  try {
    return Report(batch, options, progress).write();
  } catch (const Stopped&) {
    ReportOutcome outcome;
    outcome.interrupted = true;
    return outcome;
  }
}

}  // namespace vestige::plot
