#include "detector/actuator_map.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/base/strict_json.hpp"
#include "traces/files/input_file.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

namespace {

constexpr std::uint32_t kMaxSide = 16384;  // texels; also what OpenGL offers
constexpr std::size_t kManyActuators = 64;
constexpr std::size_t kFewTexels = 4;  // an editor's soft edge leaves greys with at most this many texels

struct GreyImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint16_t> grey;
  bool is_by_triangle = false;
};

struct PngSource {
  std::span<const std::byte> bytes;
  std::size_t offset = 0;
  std::string failure;
};

/// libpng reports errors through a callback that must not return. The error message needs libpng's text, kept here, and
/// the offset of the failure, which PngSource keeps.
[[noreturn]] void on_png_error(png_structp png, png_const_charp message) {
  auto& source = *static_cast<PngSource*>(png_get_error_ptr(png));
  source.failure = message;
  png_longjmp(png, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

void read_png_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto& source = *static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source.bytes.size() - source.offset) png_error(png, "the file ends too early");
  std::memcpy(out, source.bytes.data() + source.offset, count);
  source.offset += count;
}

class PngReader {
 public:
  explicit PngReader(PngSource& source)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, on_png_error, on_png_warning)),
        info_(png_create_info_struct(png_)) {
    png_set_read_fn(png_, &source, read_png_bytes);
    png_set_user_limits(png_, kMaxSide, kMaxSide);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  png_structp png() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_;
};

/// Reads the header. Returns false if libpng gave up (source.failure has the reason). Between setjmp and the calls that
/// may jump, no object with a destructor is created.
bool read_header(const PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png())) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's own way
  png_read_info(reader.png(), reader.info());
  png_set_expand_gray_1_2_4_to_8(reader.png());
  png_set_swap(reader.png());  // 16-bit samples in the machine's (little-endian) order
  png_set_interlace_handling(reader.png());
  png_read_update_info(reader.png(), reader.info());
  return true;
}

bool read_rows(const PngReader& reader, std::vector<png_bytep>& rows) {
  if (setjmp(png_jmpbuf(reader.png())) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's own way
  png_read_image(reader.png(), rows.data());
  png_read_end(reader.png(), nullptr);
  return true;
}

bool is_by_triangle(const PngReader& reader) {
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png(), reader.info(), &texts, nullptr);
  return std::any_of(texts, texts + count,
                     [](const png_text& text) { return text.key == kMapKeyword && text.text == kTriangleMap; });
}

/// Refuses an image that is too large. libpng would report it as damaged.
void refuse_too_large(std::span<const std::byte> png, std::string_view name) {
  constexpr std::size_t kWidth = 16;  // of IHDR, which comes first, in bytes from the file's beginning
  if (png.size() < kWidth + 8) return;
  const auto number = [&](std::size_t offset) {
    std::uint32_t value = 0;
    for (const std::byte byte : png.subspan(offset, 4)) value = value << 8U | std::to_integer<std::uint32_t>(byte);
    return value;
  };
  const std::uint32_t width = number(kWidth);
  const std::uint32_t height = number(kWidth + 4);
  if (width > kMaxSide || height > kMaxSide)
    throw Error(name, fmt::format("is {} x {} texels; a side must have at most {}", width, height, kMaxSide),
                "export it smaller, without interpolation");
}

GreyImage read_grey_png(std::span<const std::byte> bytes, std::string_view name) {
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0)
    throw Error(name, "is not a PNG file", "export the actuator map as a greyscale PNG");
  refuse_too_large(bytes, name);
  PngSource source = {bytes, 0, {}};
  const PngReader reader(source);
  const auto fail = [&] {
    return Error(fmt::format("{}, byte {}", name, source.offset), fmt::format("damaged PNG: {}", source.failure),
                 "export the actuator map again");
  };
  if (!read_header(reader)) throw fail();
  const int colour = png_get_color_type(reader.png(), reader.info());
  if (colour != PNG_COLOR_TYPE_GRAY)
    throw Error(name, "has colours or an alpha channel; only grey levels mean actuators",
                "convert it to greyscale without alpha (in GIMP: Image > Mode > Greyscale, Layer > Transparency > "
                "Remove Alpha)");
  GreyImage image;
  image.width = png_get_image_width(reader.png(), reader.info());
  image.height = png_get_image_height(reader.png(), reader.info());
  image.is_by_triangle = is_by_triangle(reader);
  const std::size_t sample_bytes = png_get_bit_depth(reader.png(), reader.info()) == 16 ? 2 : 1;
  const std::size_t texels = std::size_t{image.width} * image.height;
  std::vector<png_byte> pixels(texels * sample_bytes);
  std::vector<png_bytep> rows(image.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.data() + y * image.width * sample_bytes;
  if (!read_rows(reader, rows)) throw fail();
  image.grey.resize(texels);
  if (sample_bytes == 2) {
    std::memcpy(image.grey.data(), pixels.data(), pixels.size());
  } else {
    std::ranges::copy(pixels, image.grey.begin());
  }
  return image;
}

struct Sidecar {
  std::size_t triangle_count = 0;
  std::string skin_digest;
  std::optional<Facing> facing;
  std::vector<std::uint16_t> grey;
  std::vector<std::string> names;
  std::vector<std::optional<glm::dvec3>> position_m;
  Firing firing;
};

/// Returns three finite numbers, or nothing if the entry has no position.
std::optional<glm::dvec3> parse_position(const nlohmann::json& entry, const std::string& where) {
  if (!entry.contains("position_m")) return std::nullopt;
  const nlohmann::json& list = entry["position_m"];
  const auto is_finite = [](const nlohmann::json& value) {
    return value.is_number() && std::isfinite(value.get<double>());
  };
  if (!list.is_array() || list.size() != 3 || !std::ranges::all_of(list, is_finite))
    throw Error(
        where, "'position_m' is not three finite numbers",
        R"(write the actuator's middle on the skin in metres, "position_m": [0.08, 1.3, 0.12], or leave it out)");
  return glm::dvec3(list[0].get<double>(), list[1].get<double>(), list[2].get<double>());
}

/// Returns the actuator's name, in a form that a terminal, a CSV and an SVG can show.
std::string parse_name(const nlohmann::json& entry, std::size_t number, const std::string& where) {
  if (!entry.contains("name")) return fmt::format("actuator {}", number);
  constexpr const char* kRemedy = R"(write "name": "chest left", or leave it out)";
  const nlohmann::json& name = entry["name"];
  if (!name.is_string() || name.get<std::string>().empty()) throw Error(where, "'name' is not a text", kRemedy);
  auto text = name.get<std::string>();
  if (std::ranges::any_of(text, [](char letter) { return static_cast<unsigned char>(letter) < ' ' || letter == 0x7F; }))
    throw Error(where, "'name' holds a control character", kRemedy);
  return text;
}

/// Warns of unknown fields: a misspelt field would otherwise have no effect, and nobody would notice.
void warn_of_fields(const nlohmann::json& object, const std::vector<std::string>& known, const std::string& where,
                    std::vector<std::string>& warnings) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      warnings.push_back(fmt::format("{}: the field '{}' has no meaning here; the known fields are: {}.", where, key,
                                     fmt::join(known, ", ")));
}

void warn_of_names(const Sidecar& sidecar, std::string_view name, std::vector<std::string>& warnings) {
  std::map<std::string, std::size_t> first;
  for (std::size_t i = 0; i < sidecar.names.size(); ++i)
    if (const auto [found, is_new] = first.emplace(sidecar.names[i], i); !is_new)
      warnings.push_back(fmt::format("{}, sidecar: actuators {} and {} are both called '{}'.", name, found->second + 1,
                                     i + 1, sidecar.names[i]));
}

Sidecar parse_sidecar(std::string_view json, std::string_view name, std::vector<std::string>& warnings) {
  constexpr const char* kRemedy = R"(write {"actuators": [{"grey": 40, "name": "chest left"}, …]})";
  const nlohmann::json document = parse_strict_json(json, fmt::format("{}, sidecar", name), kRemedy);
  if (!document.is_object() || !document.contains("actuators") || !document["actuators"].is_array())
    throw Error(fmt::format("{}, sidecar", name), "has no list 'actuators'", kRemedy);
  warn_of_fields(document, {"actuators", "triangles", "skin", "facing", "fires"}, fmt::format("{}, sidecar", name),
                 warnings);
  Sidecar sidecar;
  if (document.contains("triangles")) {
    const auto& triangles = document["triangles"];
    if (!triangles.is_number_unsigned() || triangles.get<std::uint64_t>() == 0)
      throw Error(fmt::format("{}, sidecar", name), "'triangles' is not a whole number above 0",
                  "write the number of the avatar's triangles, or leave 'triangles' out if the map is in the avatar's "
                  "UV space");
    sidecar.triangle_count = triangles.get<std::size_t>();
    if (document.contains("skin") && document["skin"].is_string()) sidecar.skin_digest = document["skin"];
  }
  if (document.contains("facing")) {
    const nlohmann::json& facing = document["facing"];
    if (facing.is_string()) sidecar.facing = facing_named(facing.get<std::string>());
    if (!sidecar.facing)
      throw Error(fmt::format("{}, sidecar", name), fmt::format("'facing' is {}, which is no axis", facing.dump()),
                  fmt::format("write one of {}, or leave it out", fmt::join(kFacingNames, ", ")));
  }
  for (const auto& entry : document["actuators"]) {
    const std::string where = fmt::format("{}, sidecar, actuators[{}]", name, sidecar.grey.size());
    if (!entry.is_object() || !entry.contains("grey") || !entry["grey"].is_number_unsigned() ||
        entry["grey"].get<std::uint64_t>() == 0 || entry["grey"].get<std::uint64_t>() > 0xFFFF)
      throw Error(where, "needs a 'grey' from 1 to 65535", kRemedy);
    const auto grey = entry["grey"].get<std::uint16_t>();
    if (std::ranges::find(sidecar.grey, grey) != sidecar.grey.end())
      throw Error(where, fmt::format("grey {} is listed twice", grey), "give every actuator its own grey");
    sidecar.grey.push_back(grey);
    warn_of_fields(entry, {"grey", "name", "position_m"}, where, warnings);
    sidecar.names.push_back(parse_name(entry, sidecar.grey.size(), where));
    sidecar.position_m.push_back(parse_position(entry, where));
  }
  warn_of_names(sidecar, name, warnings);
  if (document.contains("fires"))
    sidecar.firing = Firing(document["fires"], sidecar.names, fmt::format("{}, sidecar", name));
  return sidecar;
}

Sidecar actuators_of(const GreyImage& image, std::string_view name, std::vector<std::string>& warnings) {
  std::map<std::uint16_t, std::size_t> texels;
  for (const std::uint16_t grey : image.grey)
    if (grey != 0) ++texels[grey];
  if (texels.size() > 0xFFFF - 1)
    throw Error(name, "has more than 65534 grey levels", "name a file that is an actuator map");
  Sidecar found;
  std::size_t thin = 0;
  for (const auto& [grey, count] : texels) {
    found.grey.push_back(grey);
    found.names.push_back(fmt::format("actuator {}", found.grey.size()));
    found.position_m.emplace_back();
    if (count <= kFewTexels) ++thin;
  }
  if (found.grey.size() > kManyActuators)
    warnings.push_back(
        fmt::format("{}: {} grey levels make {} actuators; they may be soft edges of an editor. Draw without "
                    "anti-aliasing, or list the greys in a sidecar JSON.",
                    name, found.grey.size(), found.grey.size()));
  if (thin != 0)
    warnings.push_back(
        fmt::format("{}: {} grey levels cover {} texels or fewer; they may be soft edges of an editor. Draw without "
                    "anti-aliasing, or list the greys in a sidecar JSON.",
                    name, thin, kFewTexels));
  if (found.grey.empty()) warnings.push_back(fmt::format("{}: is black everywhere, so no actuator can fire.", name));
  return found;
}

double fraction(double value) {
  return value - std::floor(value);
}

}  // namespace

std::uint16_t ActuatorMap::at(const glm::dvec2& texture_coordinate) const {
  if (!std::isfinite(texture_coordinate.x) || !std::isfinite(texture_coordinate.y)) return 0;
  // The fraction of a tiny negative coordinate rounds to 1, so this takes the last texel.
  const auto column = std::min(static_cast<std::uint32_t>(fraction(texture_coordinate.x) * width), width - 1);
  const auto row = std::min(static_cast<std::uint32_t>(fraction(texture_coordinate.y) * height), height - 1);
  return actuator[std::size_t{row} * width + column];
}

ActuatorMap parse_actuator_map(std::span<const std::byte> png, std::string_view sidecar_json, std::string_view name) {
  const GreyImage image = read_grey_png(png, name);
  ActuatorMap map;
  map.width = image.width;
  map.height = image.height;
  Sidecar listed =
      sidecar_json.empty() ? actuators_of(image, name, map.warnings) : parse_sidecar(sidecar_json, name, map.warnings);
  if (image.is_by_triangle && listed.triangle_count == 0)
    throw Error(name, "has a texel for each triangle of an avatar, but no sidecar says how many triangles",
                "put the .json file that 'vestige map make' wrote with the map beside the map");
  std::vector<std::uint16_t> actuator_of_grey(0x10000, 0);
  for (std::size_t i = 0; i < listed.grey.size(); ++i)
    actuator_of_grey[listed.grey[i]] = static_cast<std::uint16_t>(i + 1);
  map.actuator.clear();
  map.actuator.reserve(image.grey.size());
  for (std::size_t i = 0; i < image.grey.size(); ++i) {
    const std::uint16_t grey = image.grey[i];
    if (grey != 0 && actuator_of_grey[grey] == 0)
      throw Error(name,
                  fmt::format("texel ({}, {}) has grey {}, which the sidecar does not list", i % image.width,
                              i / image.width, grey),
                  "add it to the sidecar's 'actuators', or paint it black");
    map.actuator.push_back(actuator_of_grey[grey]);
  }
  if (listed.triangle_count > map.actuator.size())
    throw Error(name, fmt::format("has only {} texels for {} triangles", map.actuator.size(), listed.triangle_count),
                "make the map again with 'vestige map make --per-triangle'");
  map.triangle_count = listed.triangle_count;
  map.skin_digest = listed.skin_digest;
  if (map.triangle_count != 0 && map.skin_digest.empty())
    map.warnings.push_back(
        fmt::format("{}: its sidecar has no 'skin', which identifies the avatar of the map. Every avatar with {} "
                    "triangles is accepted.",
                    name, map.triangle_count));
  if (map.triangle_count != 0 && std::any_of(map.actuator.begin() + static_cast<std::ptrdiff_t>(map.triangle_count),
                                             map.actuator.end(), [](std::uint16_t actuator) { return actuator != 0; }))
    throw Error(name,
                fmt::format("has texels that are not black after the texels of its {} triangles", map.triangle_count),
                "make the map again with 'vestige map make --per-triangle'");
  map.actuator_count = listed.grey.size();
  map.names = std::move(listed.names);
  map.position_m = std::move(listed.position_m);
  map.facing = listed.facing;
  map.firing = std::move(listed.firing);
  return map;
}

std::string skin_digest(const Avatar& avatar) {
  Sha256 sha;
  sha.update(std::as_bytes(std::span(avatar.triangles)));
  sha.update(std::as_bytes(std::span(avatar.position_bind)));
  return sha.hex();
}

ActuatorMap parse_actuator_map(const ActuatorMapFiles& files, const Avatar& avatar, std::string_view name) {
  ActuatorMap map = parse_actuator_map(files.png, files.json, name);
  if (map.triangle_count != 0 && map.triangle_count != avatar.triangles.size())
    throw Error(name,
                fmt::format("is for an avatar with {} triangles, but this avatar has {}", map.triangle_count,
                            avatar.triangles.size()),
                "make a map for this avatar with 'vestige map make --per-triangle'");
  if (map.triangle_count != 0 && !map.skin_digest.empty() && map.skin_digest != skin_digest(avatar))
    throw Error(name, "was made for another avatar, or for another export of this avatar",
                "make a map for this avatar with 'vestige map make --per-triangle'");
  map.warnings.insert(map.warnings.begin(), files.warnings.begin(), files.warnings.end());
  return map;
}

ActuatorMapFiles actuator_map_files(const RecordedPerson& person) {
  const auto png = person.actuator_map_png;
  return {{png.begin(), png.end()}, std::string(text_of(person.actuator_map_json))};
}

std::filesystem::path sidecar_path(std::filesystem::path map) {
  return map.replace_extension(".json");
}

std::string map_or_default(const std::string& map, const std::string& avatar) {
  if (!map.empty()) return map;
  return avatar == kBuiltin ? std::string(kBuiltin) : "none";
}

ActuatorMapFiles read_actuator_map_files(const std::string& map) {
  if (map == "none") return {};
  if (map == kBuiltin) return {builtin_actuator_map_png(), builtin_actuator_map_json()};
  const auto sidecar = sidecar_path(map);
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;  // twice that of all texels
  constexpr std::uint64_t kMostSidecarBytes = std::uint64_t{1} << 26;
  ActuatorMapFiles files = {read_file(map, kMostBytes), ""};
  if (files.png.empty()) throw Error(map, "is empty", "export the actuator map as a greyscale PNG");
  std::error_code ignored;  // a dangling link exists but cannot be read
  if (!std::filesystem::exists(std::filesystem::symlink_status(sidecar, ignored))) return files;
  files.json = read_text_file(sidecar, kMostSidecarBytes);
  if (files.json.empty())
    throw Error(sidecar.string(), "is empty",
                "list the actuators in it, or remove it: then each grey level is an actuator");
  return files;
}

std::string sha256_of(const ActuatorMapFiles& files) {
  Sha256 sha;
  sha.update(files.png);
  sha.update(std::as_bytes(std::span(files.json)));
  return sha.hex();
}

}  // namespace vestige
