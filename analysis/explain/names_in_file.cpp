#include "analysis/explain/names_in_file.hpp"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "traces/base/csv.hpp"
#include "traces/base/error.hpp"
#include "traces/base/line_reader.hpp"
#include "traces/files/input_file.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/mcap/compression.hpp"

namespace vestige {

namespace {

constexpr const char* kNamesRemedy = "name a CSV, JSON, HDF5 or OpenEXR file that Vestige wrote";
constexpr std::string_view kExrStart = "\x76\x2f\x31\x01";
constexpr std::string_view kMcapStart = "\x89MCAP";
constexpr std::string_view kZstdStart = "\x28\xb5\x2f\xfd";
constexpr std::string_view kHdf5Start = "\x89HDF";

/// The first bytes of a regular file; of anything else, which can be read only once, nothing.
std::string start_of(const std::filesystem::path& path) {
  std::error_code failed;
  if (path == "-" || !std::filesystem::is_regular_file(path, failed)) return {};
  std::array<char, 8> start = {};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  return {start.data(), static_cast<std::size_t>(file.gcount())};
}

/// Collects the paths of a JSON document.
class JsonNames {
 public:
  explicit JsonNames(NamesInFile& names) : names_(names) {}

  void walk(const nlohmann::ordered_json& value, const std::string& path, std::size_t depth) {
    constexpr std::size_t kDeepest = 64;  // deeper than any file of ours
    if (depth > kDeepest) return note(path);
    if (value.is_object() && !value.empty()) {
      for (const auto& [key, member] : value.items()) walk(member, path_of(path, key), depth + 1);
    } else if (value.is_array() && !value.empty()) {
      for (const auto& element : value) walk(element, path, depth + 1);
    } else {
      if (value.is_structured() || value.is_null()) names_.empty_ones.insert(path);
      note(path);
    }
  }

 private:
  void note(const std::string& path) {
    if (seen_.insert(path).second) names_.names.push_back(path);
  }

  NamesInFile& names_;
  std::set<std::string> seen_;
};

/// The whole of a JSON file, or the first thousand lines of a file that has a document in each.
NamesInFile names_in_json(LineReader& lines, std::string_view first, const std::string& file) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  constexpr std::size_t kMostLines = 1000;
  NamesInFile found;
  JsonNames names(found);
  auto json = nlohmann::ordered_json::parse(first, nullptr, false);
  std::string_view line;
  // A trace of one frame is one line, too.
  const bool is_frame = json.is_object() && json.contains("frame") && json.contains("time_s");
  if (json.is_object()) names.walk(json, "", 0);
  bool more = json.is_object() && lines.next(line);
  while (more && line.empty()) more = lines.next(line);
  if (is_frame || more) {
    found.format = FileFormat::kLines;
    for (; more && lines.line() < kMostLines; more = lines.next(line)) {
      if (line.empty()) continue;
      json = nlohmann::ordered_json::parse(line, nullptr, false);
      if (!json.is_object())
        throw Error(fmt::format("{}, line {}", file, lines.line()), "is no JSON object", kNamesRemedy);
      names.walk(json, "", 0);
    }
    return found;
  }
  std::string text(first);
  while (json.is_discarded() && lines.next(line)) {
    text += '\n';
    text += line;
    if (text.size() > kMostBytes) throw Error(file, "is more than 1 GiB of JSON", kNamesRemedy);
  }
  if (json.is_discarded()) json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) throw Error(file, "begins as JSON does, and is not JSON", "write it again");
  if (!json.is_object()) throw Error(file, "is JSON, but no object with names", kNamesRemedy);
  found.format = FileFormat::kJson;
  names.walk(json, "", 0);
  if (json.contains("argv") && json["argv"].is_array() && json["argv"].size() > 1 && json["argv"][1].is_string())
    found.verb = json["argv"][1];
  return found;
}

NamesInFile names_in_header(std::string_view line, const std::string& file) {
  if (line.find('\0') != std::string_view::npos || line.find(',') == std::string_view::npos)
    throw Error(file, "is neither CSV nor JSON", kNamesRemedy);
  return {FileFormat::kCsv, CsvLines(line, file, kNamesRemedy).take_header(), {}, {}};
}

NamesInFile names_in_text(const std::filesystem::path& path) {
  LineReader lines(path);
  const std::string& file = lines.name();
  std::string_view line;
  std::size_t first = std::string_view::npos;
  while (first == std::string_view::npos && lines.next(line)) {
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    first = line.find_first_not_of(" \t\r");
  }
  if (first == std::string_view::npos) throw Error(file, "is empty", kNamesRemedy);
  for (const std::string_view start : {kExrStart, kMcapStart, kHdf5Start, kZstdStart})
    if (line.starts_with(start)) throw Error(file, "is no text, and only text is read from a pipe", "name the file");
  if (line[first] == '{' || line[first] == '[') return names_in_json(lines, std::string(line), file);
  return names_in_header(line, file);
}

NamesInFile names_in_zstd(const std::filesystem::path& path) {
  constexpr std::size_t kHeaderBytes = 65536;
  mcap::RawBuffer expanded;
  const std::string_view text = text_of(
      mcap::decompress_beginning(mcap::name_of(mcap::Compression::kZstd), read_file(path), kHeaderBytes, expanded));
  if (text.empty()) throw Error(path.string(), "holds nothing that zstd can expand", "write it again");
  return names_in_header(text.substr(0, text.find('\n')), path.string());
}

NamesInFile names_in_exr(const std::filesystem::path& path) {
  NamesInFile found;
  found.format = FileFormat::kExr;
  try {
    const Imf::InputFile image(path.c_str());
    const Imf::ChannelList& channels = image.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
      found.names.emplace_back(channel.name());
  } catch (const std::exception& error) {
    throw Error(path.string(), fmt::format("cannot be read as OpenEXR: {}", error.what()), "write it again");
  }
  return found;
}

}  // namespace

NamesInFile names_in_file(const std::filesystem::path& path) {
  const std::string start = start_of(path);
  if (start.starts_with(kMcapStart))
    throw Error(path.string(), "is an MCAP file, such as a trace",
                "'vestige inspect' says what it holds; traces/FORMAT.md describes traces");
  if (start.starts_with(kExrStart)) return names_in_exr(path);
  if (start.starts_with(kHdf5Start)) {
    const std::vector<std::string> names = hdf5_names(path);
    return {FileFormat::kHdf5, names, {names.begin(), names.end()}, {}};  // any of them may be a group
  }
  if (start.starts_with(kZstdStart)) return names_in_zstd(path);
  return names_in_text(path);
}

}  // namespace vestige
