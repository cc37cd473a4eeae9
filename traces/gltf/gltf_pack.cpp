#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/glb_container.hpp"
#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_meshopt.hpp"
#include "traces/gltf/json/gltf_json.hpp"
#include "traces/gltf/json/gltf_uri.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {

namespace {

using gltf::Json;
using gltf::Report;
using nlohmann::json;

constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

/// Whether `content` is a .gltf: text that starts with a brace after white space and perhaps a byte order mark.
bool is_text(std::string_view content) {
  const std::size_t start = content.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return start != std::string_view::npos && content[start] == '{';
}

/// Concatenates the buffers that are read.
class BufferPacker {
 public:
  /// `bin` is the content of a first buffer without a uri; empty if the file is not a GLB.
  BufferPacker(std::filesystem::path folder, std::span<const std::byte> bin, Report& report)
      : folder_(std::move(folder)), bin_(bin), report_(report) {}

  /// Adds a buffer and returns its offset in `bytes`. A buffer that several entries name is packed once.
  std::size_t add(const Json& source, const json& buffer, std::size_t index) {
    const std::string path = fmt::format("buffers[{}]", index);
    const auto byte_length = buffer["byteLength"].get<std::size_t>();
    const Place place = place_of(source, buffer, index, path);
    if (place.size < byte_length)
      report_.fail(path + ".byteLength", fmt::format("says {} bytes, but there are only {}", byte_length, place.size));
    return place.start;
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  struct Place {
    std::size_t start = 0;
    std::size_t size = 0;
  };

  Place place_of(const Json& source, const json& buffer, std::size_t index, const std::string& path) {
    if (!buffer.contains("uri")) {
      if (index != 0 || bin_.empty())
        report_.fail(path, "has no uri: there is no data", "export a .glb, or a .gltf together with its .bin");
      return append(bin_);
    }
    const std::string_view uri = source.buffer_uri(index, buffer, report_);
    if (gltf::is_data_uri(uri)) return append(gltf::decode_data_uri(uri, path + ".uri", report_));
    const std::filesystem::path file = gltf::decode_relative_uri(uri, path + ".uri", report_);
    const auto known = packed_.find(file);
    if (known == packed_.end() && !std::filesystem::exists(folder_ / file))
      report_.fail(path + ".uri", fmt::format("names '{}', which does not exist", (folder_ / file).string()),
                   "put that file beside the glTF, or export a .glb, which holds everything");
    return known != packed_.end() ? known->second
                                  : packed_.emplace(file, append(read_file(folder_ / file))).first->second;
  }

  Place append(std::span<const std::byte> content) {
    const std::size_t start = (bytes_.size() + 3) / 4 * 4;
    if (content.size() + start > kMostBytes)
      report_.fail("buffers", "bring the file to more than the 4 GiB that a GLB can hold",
                   "remove the parts that the avatar does not need");
    if (content.size() > bytes_.size()) bytes_.reserve(start + content.size());
    bytes_.resize(start);
    bytes_.insert(bytes_.end(), content.begin(), content.end());
    return {start, content.size()};
  }

  std::filesystem::path folder_;
  std::span<const std::byte> bin_;
  Report& report_;
  std::map<std::filesystem::path, Place> packed_;
  std::vector<std::byte> bytes_;
};

/// Packs the parts of a file that are read into one GLB.
class Packer {
 public:
  Packer(const Json& source, std::span<const std::byte> bin, const std::filesystem::path& path, Report& report)
      : source_(source), packer_(path.parent_path(), bin, report), report_(report) {}

  std::vector<std::byte> pack() {
    find_what_is_read();
    pack_buffers();
    std::string text = "{";
    for (const auto& [name, value] : source_.head().items())
      text += fmt::format("{}:{},", json(name).dump(), value.dump());
    for (const char* name : {"accessors", "animations", "meshes", "nodes", "scenes", "skins"})
      add_list(name, text, [](json&, std::size_t) {});
    if (packer_.bytes().empty()) {
      text.back() = '}';
    } else {
      add_list("bufferViews", text, [&](json& view, std::size_t i) { redirect(view, i); });
      text += fmt::format("\"buffers\":[{{\"byteLength\":{}}}]}}", packer_.bytes().size());
    }
    return gltf::join_glb(text, packer_.bytes(), report_);
  }

 private:
  void find_what_is_read() {
    gltf::Document document = gltf::parse_document(source_, report_);
    is_read_ = std::move(document.is_buffer_read);
    is_view_read_ = std::move(document.is_view_read);
  }

  void pack_buffers() {
    start_.resize(is_read_.size());
    byte_length_.resize(is_read_.size());
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      const json buffer = source_.element("buffers", i, report_);
      byte_length_[i] = buffer["byteLength"].get<std::size_t>();
      if (is_read_[i]) start_[i] = packer_.add(source_, buffer, i);
    }
  }

  /// Of all extras, only that of nodes that are colliders is ever read.
  void keep_radius(json& element, std::string_view list, std::size_t index) const {
    if (list != "nodes") return;
    const json radius = source_.extra(list, index, "radius_m");
    if (!radius.is_null()) element["extras"]["radius_m"] = radius;
  }

  template <typename Change>
  void add_list(const char* name, std::string& text, const Change& change) {
    if (!source_.has(name)) return;
    text += fmt::format("\"{}\":[", name);
    for (std::size_t i = 0; i < source_.count(name); ++i) {
      json element = source_.element(name, i, report_);
      keep_radius(element, name, i);
      change(element, i);
      text += i > 0 ? "," : "";
      text += element.dump();
    }
    text += "],";
  }

  /// Makes a view refer to the single buffer of the GLB. Views that are not read held images, or are wrong but
  /// harmless. They keep their place, so that the other views keep their index.
  void redirect(json& view, std::size_t index) const {
    if (!is_view_read_[index]) {
      view = {{"buffer", 0}, {"byteLength", 1}};
      return;
    }
    const std::string path = fmt::format("bufferViews[{}]", index);
    if (const auto packed = gltf::read_packed_view(view, path, is_read_.size(), report_)) {
      check_inside(packed->buffer, packed->offset, packed->length, path);
      json& extension = view["extensions"][gltf::kMeshopt];
      extension["buffer"] = 0;
      extension["byteOffset"] = start_[packed->buffer] + packed->offset;
      view["buffer"] = 0;
      view.erase("byteOffset");
      return;
    }
    const auto buffer = view["buffer"].get<std::size_t>();
    const auto offset = view.value("byteOffset", std::size_t{0});
    check_inside(buffer, offset, view["byteLength"].get<std::size_t>(), path);
    view["buffer"] = 0;
    view["byteOffset"] = start_[buffer] + offset;
  }

  void check_inside(std::size_t buffer, std::size_t offset, std::size_t length, const std::string& path) const {
    gltf::check_inside_buffer(offset, length, buffer, byte_length_[buffer], path, report_);
  }

  const Json& source_;
  BufferPacker packer_;
  Report& report_;
  std::vector<bool> is_read_;       ///< for each buffer: whether it is read
  std::vector<bool> is_view_read_;  ///< for each view: whether it is read
  std::vector<std::size_t> start_;
  std::vector<std::size_t> byte_length_;
};

bool names_other_files(const Json& source, Report& report) {
  for (std::size_t i = 0; i < source.count("buffers"); ++i) {
    const json buffer = source.element("buffers", i, report);
    if (buffer.contains("uri") && !gltf::is_data_uri(source.buffer_uri(i, buffer, report))) return true;
  }
  return false;
}

}  // namespace

std::vector<std::byte> read_avatar_glb(const std::filesystem::path& path) {
  return pack_avatar_glb(read_file(path), path);
}

std::vector<std::byte> read_builtin_or_file(const std::string& avatar) {
  return avatar == kBuiltin ? builtin_avatar_glb() : read_avatar_glb(avatar);
}

std::vector<std::byte> pack_avatar_glb(std::vector<std::byte> content, const std::filesystem::path& path) {
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  Report report(path.string());
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    report.fail("", "is UTF-16 text, but glTF is UTF-8", "save the file as UTF-8");
  if (is_text(text)) {
    const Json source(text, report);
    return Packer(source, {}, path, report).pack();
  }
  const gltf::GlbChunks chunks = gltf::split_glb(content, report);
  if (chunks.json.find("\"uri\"") == std::string_view::npos) return content;
  const Json source(chunks.json, report);
  if (!names_other_files(source, report)) return content;
  return Packer(source, chunks.bin, path, report).pack();
}

}  // namespace vestige
