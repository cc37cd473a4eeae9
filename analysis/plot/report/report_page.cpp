#include "analysis/plot/report/report_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "analysis/base/html.hpp"
#include "analysis/batch/ranking.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/data/report_words.hpp"
#include "analysis/plot/report/findings.hpp"
#include "analysis/plot/report/report_style.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

template <typename... Arguments>
void add(std::string& out, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(out), text, std::forward<Arguments>(arguments)...);
}

std::string unit_of(const ReportMetric& metric) {
  return metric.unit.empty() ? "" : fmt::format("\u00a0{}", html_text(metric.unit));
}

/// "localisation error (mm)"
std::string title_of(const ReportMetric& metric) {
  const std::string words = html_text(sentence_case(words_of_name(metric.name)));
  return metric.unit.empty() ? words : fmt::format("{} ({})", words, html_text(metric.unit));
}

constexpr std::string_view kModelLabel = "<span class=\"model\">model, not a user study</span>";

std::string value_cell(const std::optional<double>& value) {
  return fmt::format("<td class=\"n\">{}</td>", value ? number_text(*value) : "–");
}

std::string p_cell(const std::optional<double>& p) {
  return fmt::format("<td class=\"n\">{}</td>", p ? p_text(*p) : "–");
}

std::string interval_words(const Estimate& estimate) {
  if (!estimate.has_interval()) return "–";
  return fmt::format("{} to {}", number_text(*estimate.low), number_text(*estimate.high));
}

std::string percent(std::size_t part, std::size_t whole) {
  if (whole == 0) return "–";
  const double share = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  // Nearly none is not none, and nearly all is not all.
  if (part > 0 && share < 0.1) return "under 0.1\u00a0%";
  if (part < whole && share > 99.9) return "over 99.9\u00a0%";
  return fmt::format("{:.1f}\u00a0%", share);
}

std::string figure(const PageFigure& one, std::string_view kind) {
  return fmt::format("<figure class=\"{}\"><div class=\"sheet\">{}</div><figcaption>{}</figcaption></figure>\n", kind,
                     inline_svg(one.svg, one.stem, one.label), html_text(one.caption));
}

/// A table that scrolls by itself, with the keyboard too.
std::string scrolling(std::string_view label, std::string_view table, std::string_view kind = "") {
  return fmt::format("<div class=\"scroll {}\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">\n{}</div>\n", kind,
                     html_text(label), table);
}

class Page {
 public:
  explicit Page(const ReportPage& page) : page_(page), data_(page.data) {}

  std::string html() {
    head();
    ranking();
    changes();
    maps();
    all_metrics();
    definitions();
    per_trace();
    inputs();
    provenance();
    out_ +=
        "</main>\n<footer><p class=\"soft\">Written by <code>vestige plot report</code>. This page needs no network, "
        "because it contains its figures. The folder <code>figures</code> also has them, as SVG and PNG. All scores "
        "are in <code>scores.csv</code>.</p></footer>\n</body>\n</html>\n";
    return std::move(out_);
  }

 private:
  const ReportMetric& headline() const { return data_.metrics[data_.headline]; }
  const Candidate& best() const { return data_.ranking.front(); }
  static std::string name_of(const Candidate& candidate) {
    return fmt::format("{} with {}", html_text(candidate.map), html_text(candidate.law));
  }

  void head() {
    const std::string title = fmt::format("Actuator mappings compared: {} by {}", counted(data_.maps().size(), "map"),
                                          words_of_name(headline().name));
    add(out_,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n"
        "<a class=\"skip\" href=\"#report\">Skip to the report</a>\n<header>\n<h1>Actuator mappings compared</h1>\n",
        html_text(title), kReportStyle);
    lead();
    out_ += "</header>\n<nav aria-label=\"Contents\"><ol>\n";
    for (const auto& [id, name] : {std::pair("ranking", "Ranking"), std::pair("changes", "What would change this"),
                                   std::pair("maps", "Maps on the body"), std::pair("metrics", "All metrics"),
                                   std::pair("definitions", "Definitions"), std::pair("by-trace", "Trace by trace"),
                                   std::pair("inputs", "Traces and failures"), std::pair("provenance", "Provenance")})
      add(out_, "<li><a href=\"#{}\">{}</a></li>\n", id, name);
    out_ += "</ol></nav>\n<main id=\"report\">\n";
  }

  void lead() {
    const ReportMetric& metric = headline();
    const std::string words = html_text(words_of_name(metric.name));
    add(out_, "<p class=\"lead\">{}</p>\n", quotable_sentence(data_));
    if (best().headline.mean) add(out_, "<p>{}</p>\n", others_in_words(data_));
    double contacts = 0;
    double frames = 0;
    for (const ReportTrace& trace : data_.traces) {
      contacts += trace.contacts;
      frames += trace.frames;
    }
    add(out_, "<p>Compared: {} × {} over {} ({}, {}), by the mean over traces of {}{}; {} is better.</p>\n",
        counted(data_.maps().size(), "map"), counted(data_.laws.size(), "intensity law"),
        counted(data_.traces.size(), "trace"), grouped_count(frames, "frame"), grouped_count(contacts, "contact"),
        words, metric.unit.empty() ? "" : fmt::format(" in {}", html_text(metric.unit)), html_text(metric.better));
    cautions();
  }

  void cautions() {
    const std::vector<std::string> all = vestige::plot::cautions(data_);
    if (all.empty()) return;
    out_ += "<div class=\"caution\" role=\"note\"><ul>\n";
    for (const std::string& caution : all) add(out_, "<li>{}</li>\n", caution);
    out_ += "</ul></div>\n";
  }

  void ranking() {
    out_ += "<section aria-labelledby=\"ranking\">\n<h2 id=\"ranking\">Ranking</h2>\n";
    for (const PageFigure& one : page_.ranking) out_ += figure(one, "ranking");
    std::string table = "<table>\n";
    add(table,
        "<caption><span>{}, mean over traces. Highlighted rows cannot be distinguished from the first at 95\u00a0%. "
        "Felt: share of a trace's contacts for which an actuator vibrates, mean over traces.</span></caption>\n"
        "<thead><tr><th scope=\"col\" class=\"n\">Rank</th><th scope=\"col\">Map</th><th scope=\"col\">Law</th>"
        "<th scope=\"col\" class=\"n\">{}</th><th scope=\"col\">95\u00a0% interval</th><th scope=\"col\">Against the "
        "first</th><th scope=\"col\" class=\"n\">p</th><th scope=\"col\" class=\"n\">p, Holm</th><th scope=\"col\" "
        "class=\"n\">Traces</th><th scope=\"col\" class=\"n\">Felt</th></tr></thead>\n<tbody>\n",
        title_of(headline()), title_of(headline()));
    for (std::size_t i = 0; i < data_.ranking.size(); ++i) {
      const Candidate& one = data_.ranking[i];
      const auto felt = data_.felt_share(one);
      add(table,
          "<tr{}><td class=\"n\">{}</td><th scope=\"row\" class=\"name\">{}</th><td>{}</td>{}<td "
          "class=\"interval\">{}</td><td>{}</td>{}{}<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
          one.is_level() && data_.has_intervals() ? " class=\"level\"" : "",
          one.rank ? fmt::format("{}", *one.rank) : "–", html_text(one.map), html_text(one.law),
          value_cell(one.headline.mean), interval_words(one.headline), against_first(one, i == 0),
          p_cell(i == 0 ? std::nullopt : one.p), p_cell(i == 0 ? std::nullopt : one.p_holm), one.headline.traces,
          felt ? fmt::format("{:.1f}\u00a0%", 100 * *felt) : "–");
    }
    out_ += scrolling("Ranking", table + "</tbody>\n</table>\n", "tall");
    if (data_.has_intervals()) add(out_, "<p class=\"soft\">Intervals: {}.</p>\n", html_text(data_.interval));
    by_scenario();
    out_ += "</section>\n";
  }

  /// Who is first on each scenario alone, and how far behind the first of all is there.
  void by_scenario() {
    if (data_.by_scenario.empty()) return;
    std::string table = fmt::format(
        "<table>\n<caption><span>The first on each kind of trace alone, and where {} is there. All of it is in "
        "<code>ranking_by_scenario.csv</code>.</span></caption>\n<thead><tr><th scope=\"col\">Traces</th><th "
        "scope=\"col\" class=\"n\">Count</th><th scope=\"col\">First</th><th scope=\"col\" class=\"n\">{}</th><th "
        "scope=\"col\" class=\"n\">Rank of {}</th><th scope=\"col\" class=\"n\">{}</th><th scope=\"col\">Against the "
        "first</th></tr></thead>\n<tbody>\n",
        name_of(best()), title_of(headline()), name_of(best()), title_of(headline()));
    for (const ReportScenario& scenario : data_.by_scenario) {
      const Candidate& first = scenario.ranking.front();
      const Candidate& ours = *scenario.find(best());
      add(table,
          "<tr><th scope=\"row\" class=\"name\">{}</th><td class=\"n\">{}</td><td class=\"name\">{}</td>{}<td "
          "class=\"n\">{}</td>{}<td>{}</td></tr>\n",
          html_text(scenario.name), scenario.traces, name_of(first), value_cell(first.headline.mean),
          ours.rank ? fmt::format("{}", *ours.rank) : "–", value_cell(ours.headline.mean),
          against_first(ours, ours.rank == 1U));
    }
    out_ += "<h3>Scenario by scenario</h3>\n";
    if (!data_.reversals.empty()) add(out_, "<p>{}.</p>\n", html_text(sentence_case(data_.reversals)));
    out_ += scrolling("Scenario by scenario", table + "</tbody>\n</table>\n");
  }

  void changes() {
    const std::vector<std::string> paragraphs = what_would_change(data_);
    out_ += "<section aria-labelledby=\"changes\">\n<h2 id=\"changes\">What would change this result?</h2>\n";
    if (paragraphs.empty()) out_ += "<p>Traces with contacts that are felt.</p>\n";
    for (const std::string& paragraph : paragraphs) add(out_, "<p>{}</p>\n", paragraph);
    out_ += "</section>\n";
  }

  /// The headline of each trace, for the best.
  void per_trace() {
    constexpr std::size_t kMostColumns = 16;
    constexpr std::size_t kMostRows = 300;
    const std::size_t columns = std::min(kMostColumns, data_.ranking.size());
    const std::size_t rows = std::min(kMostRows, data_.traces.size());
    out_ += "<section aria-labelledby=\"by-trace\">\n<h2 id=\"by-trace\">Trace by trace</h2>\n";
    if (best().by_trace.size() != data_.traces.size()) {
      out_ += "<p>The folder has no <code>scores.json</code>, which holds the results of each trace.</p>\n</section>\n";
      return;
    }
    std::string table = fmt::format(
        "<table class=\"all\">\n<caption><span>{} of {} on {}, best first. <code>scores.csv</code> has every metric, "
        "map, "
        "law and trace.</span></caption>\n<thead><tr><th scope=\"col\">Trace</th>",
        title_of(headline()),
        columns == data_.ranking.size() ? "each map and law" : fmt::format("the best {} maps and laws", columns),
        rows == data_.traces.size() ? "each trace" : fmt::format("the first {} traces", rows));
    for (std::size_t c = 0; c < columns; ++c)
      add(table, "<th scope=\"col\" class=\"n\">{}</th>", name_of(data_.ranking[c]));
    table += "</tr></thead>\n<tbody>\n";
    for (std::size_t trace = 0; trace < rows; ++trace) {
      add(table, "<tr><th scope=\"row\" class=\"name\">{}</th>", html_text(data_.traces[trace].name));
      for (std::size_t c = 0; c < columns; ++c) table += value_cell(data_.ranking[c].by_trace[trace]);
      table += "</tr>\n";
    }
    out_ += scrolling("Results of each trace", table + "</tbody>\n</table>\n", "tall") + "</section>\n";
  }

  std::string against_first(const Candidate& one, bool is_first) const {
    if (!one.rank) return "no value";
    if (is_first) return "first";
    if (one.rank == 1U) return "the same";
    const Estimate& difference = one.difference_from_best;
    if (!difference.has_interval()) return data_.has_intervals() ? "unknown: too few traces" : "unknown: no interval";
    const std::string interval = fmt::format(" <span class=\"interval\">({}{})</span>",
                                             html_text(difference_text(difference)), unit_of(headline()));
    return (one.distinguishable_from_best ? "worse" : "not distinguishable") + interval;
  }

  static std::string difference_text(const Estimate& difference) {
    const auto with_sign = [](double value) { return (value > 0 ? "+" : "") + number_text(value); };
    return fmt::format("{} to {}", with_sign(*difference.low), with_sign(*difference.high));
  }

  void maps() {
    out_ += "<section aria-labelledby=\"maps\">\n<h2 id=\"maps\">Maps on the body</h2>\n";
    add(out_,
        "<p>Best first. Densities count the contacts of all traces and have one scale, so that maps can be compared. "
        "Skin without an actuator is not felt, under any law.{}</p>\n",
        page_.shown_trace.empty()
            ? " No trace has a contact."
            : fmt::format(" Errors and timelines are of the trace <strong>{}</strong>, which has the most contacts.",
                          html_text(page_.shown_trace)));
    for (std::size_t i = 0; i < page_.maps.size(); ++i) map_section(page_.maps[i], i);
    const std::vector<std::string> all = data_.maps();
    if (all.size() > page_.maps.size())
      add(out_, "<p class=\"soft\">{} more: they rank behind these and have no pictures here. --top draws more.</p>\n",
          counted(all.size() - page_.maps.size(), "map"));
    out_ += "</section>\n";
  }

  void map_section(const MapSection& map, std::size_t index) {
    const Candidate& best = data_.best_of(map.map);
    add(out_, "<section aria-labelledby=\"map-{0}\">\n<h3 id=\"map-{0}\">{1}</h3>\n", index + 1, html_text(map.map));
    add(out_,
        "<p>{}; best law {}: {}. On skin with an actuator: {} of {}, all traces "
        "together.</p>\n",
        counted(map.actuators.size(), "actuator"), html_text(best.law),
        html_text(estimate_text(best.headline, headline())), percent(map.contacts - map.unmapped, map.contacts),
        grouped_count(static_cast<double>(map.contacts), "contact"));
    for (const std::string& warning : map.warnings) add(out_, "<p class=\"caution\">{}</p>\n", html_text(warning));
    if (map.view) watch(*map.view, best);
    out_ += "<div class=\"figures\">\n";
    for (const PageFigure& one : map.bodies) out_ += figure(one, "pair");
    out_ += "</div>\n";
    for (const PageFigure& one : map.errors) out_ += figure(one, "wide");
    for (std::size_t i = 0; i < map.timelines.size(); ++i) {
      if (i == 1) add(out_, "<details><summary>Timelines under the other laws</summary>\n");
      out_ += figure(map.timelines[i], "wide");
    }
    if (map.timelines.size() > 1) out_ += "</details>\n";
    actuators(map);
    out_ += "</section>\n";
  }

  void watch(const MapView& view, const Candidate& candidate) {
    const std::string gone = html_text(fmt::format("{}", fmt::join(view.not_there, ", ")));
    if (view.file.empty()) {
      if (view.problem.empty() && gone.empty()) return;
      const std::string why = view.problem.empty() ? fmt::format("the files of {} are gone or have changed", gone)
                                                   : html_text(view.problem);
      add(out_, "<p class=\"soft\">There is no page on which it moves: {}.</p>\n", why);
      return;
    }
    const std::string why = view.value ? fmt::format("in which {} does worst: {}{}", html_text(candidate.law),
                                                     number_text(*view.value), unit_of(headline()))
                                       : "which has the most contacts";
    const std::string but =
        gone.empty() ? "" : fmt::format(", if {} is left out, whose file is gone or has changed", gone);
    add(out_, "<p><a href=\"{}\">Watch it move</a>: the trace <strong>{}</strong>, {}{}.</p>\n", html_text(view.file),
        html_text(view.trace), why, but);
  }

  void actuators(const MapSection& map) {
    if (map.actuators.empty()) return;
    std::string table = fmt::format(
        "<table>\n<caption><span>Actuators of {}, and the contacts on their skin in all "
        "traces</span></caption>\n<thead><tr><th "
        "scope=\"col\" class=\"n\">Number</th><th scope=\"col\">Name</th><th scope=\"col\" "
        "class=\"n\">Contacts</th><th "
        "scope=\"col\" class=\"n\">Share</th></tr></thead>\n<tbody>\n",
        html_text(map.map));
    for (std::size_t i = 0; i < map.actuators.size(); ++i)
      add(table,
          "<tr><td class=\"n\">{}</td><th scope=\"row\" class=\"name\">{}</th><td class=\"n\">{}</td><td "
          "class=\"n\">{}</td></tr>\n",
          i + 1, html_text(map.actuators[i].name), grouped(static_cast<double>(map.actuators[i].contacts)),
          percent(map.actuators[i].contacts, map.contacts));
    add(out_, "<details><summary>Contacts of each actuator</summary>\n{}</details>\n",
        scrolling(fmt::format("Actuators of {}", map.map), table + "</tbody>\n</table>\n", "tall"));
  }

  void all_metrics() {
    out_ += "<section class=\"metrics\" aria-labelledby=\"metrics\">\n<h2 id=\"metrics\">All metrics</h2>\n";
    std::string table =
        "<table class=\"all\">\n<caption><span>Mean over traces and, below it, its 95\u00a0% "
        "interval</span></caption>\n<thead><tr><th "
        "scope=\"col\">Map</th><th scope=\"col\">Law</th>";
    for (const ReportMetric& metric : data_.metrics)
      add(table, "<th scope=\"col\" class=\"n\" style=\"white-space:normal\">{}{}</th>", title_of(metric),
          metric.model_based ? fmt::format("<br>{}", kModelLabel) : "");
    table += "</tr></thead>\n<tbody>\n";
    for (const Candidate& one : data_.ranking) {
      add(table, "<tr><th scope=\"row\" class=\"name\">{}</th><td>{}</td>", html_text(one.map), html_text(one.law));
      for (const Estimate& estimate : one.metrics) {
        add(table, "<td class=\"n\">{}", estimate.mean ? number_text(*estimate.mean) : "–");
        if (estimate.has_interval()) add(table, "<br><span class=\"interval\">{}</span>", interval_words(estimate));
        table += "</td>";
      }
      table += "</tr>\n";
    }
    out_ += scrolling("All metrics", table + "</tbody>\n</table>\n", "tall") + "</section>\n";
  }

  void definitions() {
    out_ += "<section aria-labelledby=\"definitions\">\n<h2 id=\"definitions\">Definitions</h2>\n";
    std::string table =
        "<table>\n<caption><span>How each metric is computed, and where it comes from. Metrics marked as a model rest "
        "on a model of perception, motors or link; no user was asked.</span></caption>\n<thead><tr><th "
        "scope=\"col\">Metric</th><th "
        "scope=\"col\">Unit</th><th scope=\"col\">Better</th><th scope=\"col\">Formula</th><th "
        "scope=\"col\">Source</th></tr></thead>\n<tbody>\n";
    for (const ReportMetric& metric : data_.metrics)
      add(table,
          "<tr><th scope=\"row\">{}{}<br><code>{}</code></th><td>{}</td><td>{}</td><td class=\"formula\">{}</td><td "
          "class=\"source\">{}</td></tr>\n",
          html_text(sentence_case(words_of_name(metric.name))),
          metric.model_based ? fmt::format("<br>{}", kModelLabel) : "", html_text(metric.name),
          metric.unit.empty() ? "–" : html_text(metric.unit), html_text(metric.better), html_text(metric.formula),
          html_text(metric.source));
    out_ += scrolling("Definitions of the metrics", table + "</tbody>\n</table>\n");
    out_ += "<h3>Intensity laws</h3>\n<dl>\n";
    for (const std::string& law : data_.laws) {
      const auto known = std::ranges::find(laws(), law, &LawInfo::name);
      if (known != laws().end()) add(out_, "<dt>{}</dt><dd>{}</dd>\n", html_text(law), html_text(known->explanation));
    }
    add(out_, "</dl>\n<p>A contact is held for {:g} ms. {}</p>\n</section>\n", 1e3 * data_.law_options.hold_s,
        data_.actuator.empty()
            ? std::string("Motors follow their commands at once.")
            : fmt::format(
                  "Scores and errors are those of the motors in {}; the timelines show the laws without motors.",
                  html_text(data_.actuator)));
  }

  void inputs() {
    out_ += "<section aria-labelledby=\"inputs\">\n<h2 id=\"inputs\">Traces and failures</h2>\n";
    std::string table =
        "<table>\n<caption><span>Each trace was run through collision detection once, for all maps and "
        "laws</span></caption>\n<thead><tr><th "
        "scope=\"col\">Trace</th><th scope=\"col\">Given as</th><th scope=\"col\" class=\"n\">Frames</th><th "
        "scope=\"col\" "
        "class=\"n\">Colliders</th><th scope=\"col\" class=\"n\">Contacts</th><th "
        "scope=\"col\">Damage</th></tr></thead>\n<tbody>\n";
    for (const ReportTrace& trace : data_.traces) {
      std::string damage;
      for (const std::string& one : trace.damage) damage += (damage.empty() ? "" : "<br>") + html_text(one);
      add(table,
          "<tr><th scope=\"row\" class=\"name\">{}</th><td class=\"name\">{}</td><td class=\"n\">{}</td><td "
          "class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
          html_text(trace.name), html_text(trace.given), grouped(trace.frames), grouped(trace.colliders),
          grouped(trace.contacts), damage.empty() ? "none" : damage);
    }
    out_ += scrolling("Traces", table + "</tbody>\n</table>\n", "tall");
    out_ += "<h3 id=\"failures\">Failures</h3>\n";
    if (data_.failures.empty()) {
      out_ += "<p>None: every input was used.</p>\n</section>\n";
      return;
    }
    table =
        "<table>\n<caption><span>Inputs that were left out</span></caption>\n<thead><tr><th scope=\"col\">What</th><th "
        "scope=\"col\">Name</th><th scope=\"col\">Given as</th><th scope=\"col\">Cause</th><th "
        "scope=\"col\">Remedy</th></tr></thead>\n<tbody>\n";
    for (const ReportFailure& failure : data_.failures)
      add(table,
          "<tr><td>{}</td><th scope=\"row\" class=\"name\">{}</th><td class=\"name\">{}</td><td "
          "class=\"source\">{}</td><td class=\"source\">{}</td></tr>\n",
          html_text(failure.what), html_text(failure.name), html_text(failure.given), html_text(failure.cause),
          html_text(failure.remedy));
    out_ += scrolling("Failures", table + "</tbody>\n</table>\n") + "</section>\n";
  }

  void provenance() {
    out_ += "<section aria-labelledby=\"provenance\">\n<h2 id=\"provenance\">Provenance</h2>\n<dl>\n";
    for (const auto& [name, value] : data_.provenance)
      add(out_, "<dt>{}</dt><dd>{}</dd>\n", html_text(name),
          name == "Command" ? fmt::format("<code>{}</code>", html_text(value)) : html_text(value));
    out_ += "</dl>\n</section>\n";
  }

  const ReportPage& page_;
  const ReportData& data_;
  std::string out_;
};

}  // namespace

std::string report_html(const ReportPage& page) {
  return Page(page).html();
}

}  // namespace vestige::plot
