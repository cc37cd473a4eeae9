#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "traces/avatar_gltf.hpp"
#include "traces/glb_container.hpp"
#include "traces/gltf_document.hpp"
#include "traces/gltf_json.hpp"
#include "traces/gltf_uri.hpp"
#include "traces/input_file.hpp"

namespace vestige {

namespace {

using gltf::Report;
using nlohmann::json;

constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

/// A .gltf is text, and starts with a brace after white space and perhaps a byte order mark.
bool is_text(std::string_view content) {
  const std::size_t start = content.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return start != std::string_view::npos && content[start] == '{';
}

/// Puts the buffers that are read one behind the other.
class BufferPacker {
 public:
  BufferPacker(std::filesystem::path folder, const Report& report) : folder_(std::move(folder)), report_(report) {}

  /// Where in `bytes` this buffer starts. A buffer that several entries name is packed once.
  std::size_t add(const json& buffer, const std::string& path) {
    const auto uri = buffer.find("uri");
    if (uri == buffer.end())
      report_.fail(path, "has no uri: there is no data", "export a .glb, or a .gltf together with its .bin");
    const auto& text = uri->get_ref<const std::string&>();
    const auto byte_length = buffer["byteLength"].get<std::size_t>();
    auto known = packed_.find(text);
    if (known == packed_.end()) known = packed_.emplace(text, append(text, path + ".uri")).first;
    if (known->second.size < byte_length)
      report_.fail(path + ".byteLength",
                   fmt::format("says {} bytes, but there are only {}", byte_length, known->second.size));
    return known->second.start;
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  struct Place {
    std::size_t start = 0;
    std::size_t size = 0;
  };

  Place append(const std::string& uri, const std::string& path) {
    const std::vector<std::byte> content = gltf::is_data_uri(uri)
                                               ? gltf::decode_data_uri(uri, path, report_)
                                               : read_file(folder_ / gltf::decode_relative_uri(uri, path, report_));
    const std::size_t start = (bytes_.size() + 3) / 4 * 4;
    if (content.size() > kMostBytes - start)
      report_.fail(path, "takes the file beyond the 4 GiB that a GLB can hold",
                   "leave out what the avatar does not need");
    bytes_.resize(start);
    bytes_.insert(bytes_.end(), content.begin(), content.end());
    return {start, content.size()};
  }

  std::filesystem::path folder_;
  const Report& report_;
  std::map<std::string, Place> packed_;
  std::vector<std::byte> bytes_;
};

/// Makes all views that are read refer to the one buffer of a GLB. Views of other buffers held images; nothing refers
/// to them any more, but they keep their place so that the others keep their number.
void redirect_views(json& document, const std::vector<bool>& is_read, const std::vector<std::size_t>& start,
                    const Report& report) {
  const auto views = document.find("bufferViews");
  if (views == document.end()) return;
  for (std::size_t i = 0; i < views->size(); ++i) {
    json& view = (*views)[i];
    const auto buffer = view["buffer"].get<std::size_t>();
    const auto offset = view.value("byteOffset", std::size_t{0});
    const auto length = view["byteLength"].get<std::size_t>();
    const auto byte_length = document["buffers"][buffer]["byteLength"].get<std::size_t>();
    view["buffer"] = 0;
    if (!is_read[buffer]) {
      view = {{"buffer", 0}, {"byteLength", 1}};
      continue;
    }
    if (offset + length > byte_length)
      report.fail(fmt::format("bufferViews[{}]", i),
                  fmt::format("{} bytes from byte {} on do not lie inside buffers[{}] of {} bytes", length, offset,
                              buffer, byte_length));
    view["byteOffset"] = start[buffer] + offset;
  }
}

std::vector<std::byte> pack(std::string_view text, const std::filesystem::path& path) {
  Report report(path.string());
  json document = gltf::parse_json(text, report);
  const std::vector<bool> is_read = gltf::buffers_read(document);
  BufferPacker packer(path.parent_path(), report);
  std::vector<std::size_t> start(is_read.size());
  for (std::size_t i = 0; i < is_read.size(); ++i)
    if (is_read[i]) start[i] = packer.add(document["buffers"][i], fmt::format("buffers[{}]", i));
  redirect_views(document, is_read, start, report);
  if (packer.bytes().empty()) {
    document.erase("buffers");
    document.erase("bufferViews");
  } else {
    document["buffers"] = json::array({{{"byteLength", packer.bytes().size()}}});
  }
  return gltf::join_glb(document.dump(), packer.bytes(), report);
}

}  // namespace

std::vector<std::byte> read_avatar_glb(const std::filesystem::path& path) {
  std::vector<std::byte> content = read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  return is_text(text) ? pack(text, path) : content;
}

}  // namespace vestige
