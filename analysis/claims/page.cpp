#include "analysis/claims/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "analysis/claims/commands.hpp"

namespace vestige {

namespace {

constexpr const char* kIntroduction = R"(# Results

This page says what the runs showed. `vestige claims` writes it from their JSON files: no figure is typed by hand. The
last section says [how each file was made](#how-was-each-file-made).

**A renderer marked as software runs on the CPU: its figures say nothing about a GPU.** A detector that is not "on" a
renderer runs without OpenGL. `paper` is the published method. `geometry` and `compute` are exact and use
OpenGL. `cpu` is exact without OpenGL. `embree` is the ray tracer Embree, `embree_default` the same without its robust flag. `boxes`, `capsules`
and `decimated` are approximate: boxes, capsules or fewer triangles stand in for the skin. With `static`, a collider
moves and the skin rests. With `carried`, the collider's start first moves along with the skin. With `ccd`, both move.
Skipping leaves out pairs that cannot touch.

)";

struct Section {
  Question question;
  const char* heading;
  const char* introduction;
};

constexpr Section kSections[] = {
    {Question::kHowFast, "How fast?",
     "Hz are frames / total time over the whole round trip, with 95 % bootstrap intervals."},
    {Question::kHowRight, "How right?", ""},
    {Question::kWhereItBreaks, "Where does it break?",
     "Missed: a contact that is not found. False: one that does not exist. Wrong winner: another triangle or "
     "actuator."},
    {Question::kHowItScales, "How does it scale?", ""},
};

std::string label(const Run& run, const std::string& file) {
  const std::size_t begin = run.folder.empty() ? 0 : run.folder.size() + 1;
  return file.substr(begin, file.size() - begin - (file.ends_with(".json") ? 5 : 0));
}

/// Returns links to the files. If only one part of a file's name differs from the one before, only that part stands.
std::string links(const Run& run, const std::vector<std::string>& files, std::size_t most) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(files.size(), most); ++i) {
    std::string text = label(run, files[i]);
    if (i > 0)
      if (const std::string part = difference(label(run, files[i - 1]), text).of_second; !part.empty()) text = part;
    texts.push_back(fmt::format("[{}]({})", text, files[i]));
  }
  const std::string rest = files.size() > most ? fmt::format(" and {} more", files.size() - most) : "";
  return fmt::format("{}{}", fmt::join(texts, ", "), rest);
}

std::string list_of_claims(const Run& run, Question question) {
  std::vector<Claim> claims;
  std::ranges::copy_if(run.claims, std::back_inserter(claims),
                       [&](const Claim& claim) { return claim.question == question; });
  std::string list;
  for (auto begin = claims.begin(); begin != claims.end();) {
    const auto end = std::find_if(begin + 1, claims.end(), [&](const Claim& claim) {
      return claim.topic.empty() || claim.topic != begin->topic || claim.files != begin->files;
    });
    const std::string shown = links(run, begin->files, begin->links);
    const auto out = std::back_inserter(list);
    if (end - begin == 1) {
      fmt::format_to(out, "- {}{}{} ({})\n", begin->topic, begin->topic.empty() ? "" : ": ", begin->text, shown);
    } else {
      fmt::format_to(out, "- {} ({}):\n", begin->topic, shown);
      for (auto claim = begin; claim != end; ++claim) fmt::format_to(out, "  - {}\n", claim->text);
    }
    begin = end;
  }
  return list;
}

std::string name_of(const Run& run) {
  return run.folder.empty() ? "this folder" : run.folder;
}

/// Returns the value that most results of the run have.
std::string most_common(const Run& run, std::string Origin::*field) {
  std::map<std::string, int> counts;
  for (const Result& result : run.results) ++counts[origin_of(result).*field];
  return std::ranges::max_element(counts, {}, [](const auto& item) { return item.second; })->first;
}

std::string table_of_runs(const std::vector<Run>& runs) {
  std::string table = "| run | machine | OpenGL | commit | first and last result |\n|---|---|---|---|---|\n";
  for (const Run& run : runs) {
    std::set<std::string> renderers;
    std::set<std::string> times;
    std::set<std::string> commits;
    for (const Result& result : run.results) {
      const Origin origin = origin_of(result);
      renderers.insert(origin.renderer);
      times.insert(origin.time);
      commits.insert(origin.commit);
    }
    if (renderers.size() > 1) renderers.erase("no GL");
    fmt::format_to(std::back_inserter(table), "| [{}]({}) | {} | {} | {}{} | {}, {} |\n", name_of(run),
                   run.folder.empty() ? "." : run.folder, most_common(run, &Origin::machine),
                   fmt::join(renderers, "; "), most_common(run, &Origin::commit),
                   commits.size() > 1 ? ", unless a command names another" : "", *times.begin(), *times.rbegin());
  }
  return table;
}

/// Returns the times of the files. A date that was just said is left out.
std::string times_of(const Run& run, const std::vector<std::string>& files) {
  std::vector<std::string> times;
  std::string date;
  for (const std::string& file : files) {
    const auto result = std::ranges::find(run.results, file, &Result::file);
    const std::string time = origin_of(*result).time;
    const std::size_t end_of_date = std::min(time.find('T'), time.size());
    times.push_back(time.substr(0, end_of_date) == date ? time.substr(end_of_date + 1) : time);
    date = time.substr(0, end_of_date);
  }
  return fmt::format("{}", fmt::join(times, ", "));
}

std::string list_of_commands(const Run& run) {
  const std::string machine = most_common(run, &Origin::machine);
  const std::string commit = most_common(run, &Origin::commit);
  std::string list;
  for (const Command& command : commands_of(run.results)) {
    const Origin origin = origin_of(*std::ranges::find(run.results, command.files[0], &Result::file));
    fmt::format_to(std::back_inserter(list), "- {}, {}{}{}: `{}`\n", links(run, command.files, command.files.size()),
                   times_of(run, command.files), origin.commit == commit ? "" : ", commit " + origin.commit,
                   origin.machine == machine ? "" : ", " + origin.machine, command.text);
  }
  return list;
}

}  // namespace

std::vector<Run> runs_of(const std::vector<Result>& results) {
  std::map<std::string, std::vector<Result>> by_folder;
  bool is_one_run = false;
  for (const Result& result : results) {
    if (kind_of(result.json) == ResultKind::kOther) continue;
    const std::size_t slash = result.file.find('/');
    is_one_run |= slash == std::string::npos;
    by_folder[result.file.substr(0, slash)].push_back(result);
  }
  if (is_one_run) {
    std::vector<Result> all;
    for (const auto& [folder, of_folder] : by_folder) all.insert(all.end(), of_folder.begin(), of_folder.end());
    by_folder = {{"", std::move(all)}};
  }
  std::vector<Run> runs;
  for (auto& [folder, of_folder] : by_folder) {
    std::vector<Claim> claims = claims_of(of_folder);
    runs.push_back({folder, std::move(of_folder), std::move(claims)});
  }
  return runs;
}

std::string heading_of(Question question) {
  return std::ranges::find(kSections, question, &Section::question)->heading;
}

std::string claims_page(const std::vector<Run>& runs) {
  std::string page = kIntroduction + table_of_runs(runs);
  const auto add = [&](const Run& run, const std::string& list) {
    if (list.empty()) return;
    page += runs.size() > 1 ? fmt::format("\n### {}\n\n{}", name_of(run), list) : "\n" + list;
  };
  for (const Section& section : kSections) {
    if (std::ranges::all_of(runs, [&](const Run& run) { return list_of_claims(run, section.question).empty(); }))
      continue;
    page += fmt::format("\n## {}\n", section.heading);
    if (*section.introduction != '\0') page += fmt::format("\n{}\n", section.introduction);
    for (const Run& run : runs) add(run, list_of_claims(run, section.question));
  }
  page +=
      "\n## How was each file made?\n\n`<a|b>` stands for one run each, in the order of the files. `{a,b}` stands for "
      "both in one run, as in a shell. Times are UTC.\n";
  for (const Run& run : runs) add(run, list_of_commands(run));
  return page;
}

}  // namespace vestige
