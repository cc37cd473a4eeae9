#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/explain/field.hpp"

namespace vestige {

enum class FileFormat { kCsv, kExr, kHdf5, kJson, kLines };

/// One kind of file that Vestige writes.
struct FileKind {
  std::string_view name;  ///< "contacts.csv": the usual name, or what stands for it
  FileFormat format;
  std::string_view what;        ///< what is in it: "Contacts of a replay"
  std::string_view written_by;  ///< the command: "vestige replay --contacts OUT.csv"
  FieldGroups groups;
};

/// Returns all kinds, in the order of the reference.
std::span<const FileKind> file_kinds();

/// Returns "gl/renderer" for a group's path and a field's name.
std::string path_of(std::string_view below, std::string_view name);

/// A field where it stands in a kind of file.
struct PlacedField {
  std::string path;
  const Field* field = nullptr;  ///< null: the kind has no such name
};

/// Returns the field that explains `name`. One with the very name is preferred to a pattern.
PlacedField find_field(const FileKind& kind, const std::string& name);

/// The names that every file of this kind has: its first, and `schema_version` if the kind has it.
std::vector<std::string> required_names(const FileKind& kind);

/// Whether names of `kind` stand below `path`, so that an empty list, or null, there needs no explanation of its own.
bool holds_fields(const FileKind& kind, std::string_view path);

}  // namespace vestige
