#include "analysis/explain/names_in_file.hpp"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
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
  if (!std::filesystem::is_regular_file(path, failed)) return {};
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

NamesInFile names_in_json(std::string_view text, const std::string& file) {
  NamesInFile found;
  found.format = FileFormat::kJson;
  auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) {
    found.format = FileFormat::kLines;
    json = nlohmann::ordered_json::parse(text.substr(0, text.find('\n')), nullptr, false);
  }
  if (json.is_discarded()) throw Error(file, "begins as JSON does, and is not JSON", "write it again");
  if (!json.is_object() || json.empty()) throw Error(file, "is JSON without any name", kNamesRemedy);
  JsonNames(found).walk(json, "", 0);
  if (json.contains("argv") && json["argv"].size() > 1 && json["argv"][1].is_string()) found.verb = json["argv"][1];
  return found;
}

NamesInFile names_in_text(std::string_view text, const std::string& file) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) throw Error(file, "is empty", kNamesRemedy);
  if (text[first] == '{' || text[first] == '[') return names_in_json(text, file);
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.find('\0') != std::string_view::npos || line.find(',') == std::string_view::npos)
    throw Error(file, "is neither CSV nor JSON", kNamesRemedy);
  return {FileFormat::kCsv, CsvLines(text, file, kNamesRemedy).take_header(), {}, {}};
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
  const std::string name = path == "-" ? "standard input" : path.string();
  const bool is_long_table =
      !start.empty() && start.find_first_of("{[") == std::string::npos && !start.starts_with(kZstdStart);
  if (is_long_table) {
    LineReader lines(path);
    std::string_view header;
    lines.next(header);
    return names_in_text(header, name);
  }
  const std::vector<std::byte> bytes = read_file(path);
  mcap::RawBuffer expanded;
  constexpr std::size_t kHeaderBytes = 65536;
  std::span<const std::byte> text = bytes;
  if (text_of(bytes).starts_with(kZstdStart))
    text = mcap::decompress_beginning(mcap::name_of(mcap::Compression::kZstd), bytes, kHeaderBytes, expanded);
  return names_in_text(text_of(text), name);
}

}  // namespace vestige
