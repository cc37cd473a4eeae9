#include "analysis/explain/reference_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "analysis/explain/fields.hpp"
#include "analysis/explain/file_kinds.hpp"

namespace vestige {

namespace {

/// Fields that many kinds have, which the page lists once.
struct SharedFields {
  std::string_view heading;
  std::string_view link;
  std::span<const Field> fields;
};

std::span<const SharedFields> shared() {
  static const std::array<SharedFields, 3> all = {{{"Origin", "[the origin](#origin)", origin_fields()},
                                                   {"OpenGL", "[OpenGL](#opengl)", gl_fields()},
                                                   {"Avatar", "[the avatar](#avatar)", avatar_fields()}}};
  return all;
}

/// Text within a table and outside of code, where Markdown would take some signs for markup.
std::string in_cell(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    if (std::string_view("|*_<\\").find(c) != std::string_view::npos) cell += '\\';
    cell += c;
  }
  return cell;
}

void add_row(std::string& page, std::string_view below, const Field& field) {
  fmt::format_to(std::back_inserter(page), "| `{}` | {} | {} |\n", path_of(below, field.name), in_cell(field.unit),
                 in_cell(field.meaning));
}

constexpr std::string_view kTableHead = "\n| name | unit | says |\n|---|---|---|\n";

std::string section_of(const FileKind& kind) {
  std::string section = fmt::format("\n## {}\n\n{}. `{}`\n", kind.name, kind.what, kind.written_by);
  std::string rows;
  std::string links;
  for (const FieldGroup& group : kind.groups) {
    const auto known =
        std::ranges::find(shared(), group.fields.data(), [](const SharedFields& s) { return s.fields.data(); });
    if (known != shared().end() && known->fields.size() == group.fields.size()) {
      fmt::format_to(std::back_inserter(links), "{}{}{}", links.empty() ? "" : ", ", known->link,
                     group.below.empty() ? "" : fmt::format(" below `{}`", group.below));
      continue;
    }
    for (const Field& field : group.fields) add_row(rows, group.below, field);
  }
  section += std::string(kTableHead) + rows;
  if (!links.empty()) section += fmt::format("\nBeside them: {}.\n", links);
  return section;
}

}  // namespace

std::string reference_page() {
  std::string page =
      "# Files\n\n<!-- The program writes this page (explain): do not edit it. -->\n\n"
      "What the names in files mean: columns of CSV, channels of OpenEXR, tables of HDF5, and paths of JSON, in which "
      "lists have no name of their own.\n`vestige explain FILE` prints those of one file. `*` stands for any text.\n";
  for (const FileKind& kind : file_kinds()) page += section_of(kind);
  for (const SharedFields& one : shared()) {
    page += fmt::format("\n## {}\n{}", one.heading, kTableHead);
    for (const Field& field : one.fields) add_row(page, "", field);
  }
  return page;
}

}  // namespace vestige
