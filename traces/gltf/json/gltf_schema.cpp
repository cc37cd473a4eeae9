#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "traces/gltf/json/gltf_json.hpp"

namespace vestige::gltf {

namespace {

using nlohmann::json;

enum class Type {
  kAny,
  kBoolean,
  kString,
  kLabel,  ///< a text for people only
  kStrings,
  kNumbers,  ///< each fits into a float
  kBounds,   ///< numbers on which nothing relies; null if unreadable
  kUnsigned,
  kIndex,
  kIndices,
  kIndexMap,   ///< an object whose values are indices, such as a primitive's attributes
  kIndexMaps,  ///< a list of such objects
  kObject,
  kObjects,
};
enum class Need { kOptional, kRequired };
enum class Empty { kWarned, kRefused };

struct Property;
using Object = std::span<const Property>;

struct Property {
  std::string_view name;
  Type type = Type::kAny;
  Need need = Need::kOptional;
  Empty empty = Empty::kWarned;                  ///< lists only
  std::size_t length = 0;                        ///< kNumbers: exactly so many, 0: any
  std::uint64_t at_least = 0;                    ///< kUnsigned
  std::uint64_t at_most = 0xFFFFFFFF;            ///< kUnsigned; a GLB has no more bytes than that
  std::string_view into = {};                    ///< indices: the document's list that they refer to
  std::span<const std::string_view> words = {};  ///< kString: the only ones allowed, none: any
  Object object = {};                            ///< kObject, kObjects
};

// The parts of a document (glTF 2.0 §5), children first.

constexpr std::uint64_t kInt32Max = 0x7FFFFFFF;  // tinygltf keeps a sparse accessor's numbers in an int

constexpr std::array kAsset = {
    Property{.name = "version", .type = Type::kString, .need = Need::kRequired},
    Property{.name = "minVersion", .type = Type::kString},
    Property{.name = "generator", .type = Type::kLabel},
    Property{.name = "copyright", .type = Type::kLabel},
};
constexpr std::array kSparseIndices = {
    Property{.name = "bufferView", .type = Type::kIndex, .need = Need::kRequired, .into = "bufferViews"},
    Property{.name = "byteOffset", .type = Type::kUnsigned, .at_most = kInt32Max},
    Property{
        .name = "componentType", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 5121, .at_most = 5125},
};
constexpr std::array kSparseValues = {
    Property{.name = "bufferView", .type = Type::kIndex, .need = Need::kRequired, .into = "bufferViews"},
    Property{.name = "byteOffset", .type = Type::kUnsigned, .at_most = kInt32Max},
};
constexpr std::array kSparse = {
    Property{.name = "count", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 1, .at_most = kInt32Max},
    Property{.name = "indices", .type = Type::kObject, .need = Need::kRequired, .object = kSparseIndices},
    Property{.name = "values", .type = Type::kObject, .need = Need::kRequired, .object = kSparseValues},
};
constexpr std::array<std::string_view, 7> kAccessorTypes = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr std::array kAccessor = {
    Property{.name = "bufferView", .type = Type::kIndex, .into = "bufferViews"},
    Property{.name = "byteOffset", .type = Type::kUnsigned},
    Property{
        .name = "componentType", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 5120, .at_most = 5126},
    Property{.name = "normalized", .type = Type::kBoolean},
    Property{.name = "count", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 1},
    Property{.name = "type", .type = Type::kString, .need = Need::kRequired, .words = kAccessorTypes},
    Property{.name = "max", .type = Type::kBounds},
    Property{.name = "min", .type = Type::kBounds},
    Property{.name = "sparse", .type = Type::kObject, .object = kSparse},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kBuffer = {
    Property{.name = "uri", .type = Type::kString},
    Property{.name = "extensions"},
    Property{.name = "byteLength", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 1},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kBufferView = {
    Property{.name = "buffer", .type = Type::kIndex, .need = Need::kRequired, .into = "buffers"},
    Property{.name = "byteOffset", .type = Type::kUnsigned},
    Property{.name = "byteLength", .type = Type::kUnsigned, .need = Need::kRequired, .at_least = 1},
    Property{.name = "byteStride", .type = Type::kUnsigned, .at_least = 1, .at_most = 252},
    Property{.name = "target"},
    Property{.name = "extensions"},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kChannelTarget = {
    Property{.name = "node", .type = Type::kIndex, .into = "nodes"},
    Property{.name = "path", .type = Type::kString, .need = Need::kRequired},
};
constexpr std::array kChannel = {
    Property{.name = "sampler", .type = Type::kUnsigned, .need = Need::kRequired, .at_most = kInt32Max},
    Property{.name = "target", .type = Type::kObject, .need = Need::kRequired, .object = kChannelTarget},
};
constexpr std::array<std::string_view, 3> kInterpolations = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr std::array kSampler = {
    Property{.name = "input", .type = Type::kIndex, .need = Need::kRequired, .into = "accessors"},
    Property{.name = "interpolation", .type = Type::kString, .words = kInterpolations},
    Property{.name = "output", .type = Type::kIndex, .need = Need::kRequired, .into = "accessors"},
};
constexpr std::array kAnimation = {
    Property{.name = "channels", .type = Type::kObjects, .need = Need::kRequired, .object = kChannel},
    Property{.name = "samplers", .type = Type::kObjects, .need = Need::kRequired, .object = kSampler},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kPrimitive = {
    Property{.name = "attributes",
             .type = Type::kIndexMap,
             .need = Need::kRequired,
             .empty = Empty::kRefused,
             .into = "accessors"},
    Property{.name = "indices", .type = Type::kIndex, .into = "accessors"},
    Property{.name = "mode", .type = Type::kUnsigned, .at_most = 6},
    Property{.name = "targets", .type = Type::kIndexMaps, .into = "accessors"},
    Property{.name = "extensions"},
};
constexpr std::array kMesh = {
    Property{.name = "primitives",
             .type = Type::kObjects,
             .need = Need::kRequired,
             .empty = Empty::kRefused,
             .object = kPrimitive},
    Property{.name = "weights", .type = Type::kNumbers},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kNode = {
    Property{.name = "children", .type = Type::kIndices, .into = "nodes"},
    Property{.name = "skin", .type = Type::kIndex, .into = "skins"},
    Property{.name = "mesh", .type = Type::kIndex, .into = "meshes"},
    Property{.name = "matrix", .type = Type::kNumbers, .length = 16},
    Property{.name = "translation", .type = Type::kNumbers, .length = 3},
    Property{.name = "rotation", .type = Type::kNumbers, .length = 4},
    Property{.name = "scale", .type = Type::kNumbers, .length = 3},
    Property{.name = "weights", .type = Type::kNumbers},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kScene = {
    Property{.name = "nodes", .type = Type::kIndices, .into = "nodes"},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kSkin = {
    Property{.name = "inverseBindMatrices", .type = Type::kIndex, .into = "accessors"},
    Property{.name = "skeleton", .type = Type::kIndex, .into = "nodes"},
    Property{
        .name = "joints", .type = Type::kIndices, .need = Need::kRequired, .empty = Empty::kRefused, .into = "nodes"},
    Property{.name = "name", .type = Type::kLabel},
};
constexpr std::array kDocument = {
    Property{.name = "asset", .type = Type::kObject, .need = Need::kRequired, .object = kAsset},
    Property{.name = "extensionsUsed", .type = Type::kStrings},
    Property{.name = "extensionsRequired", .type = Type::kStrings},
    Property{.name = "buffers", .type = Type::kObjects, .object = kBuffer},
    Property{.name = "bufferViews", .type = Type::kObjects, .object = kBufferView},
    Property{.name = "accessors", .type = Type::kObjects, .object = kAccessor},
    Property{.name = "meshes", .type = Type::kObjects, .object = kMesh},
    Property{.name = "skins", .type = Type::kObjects, .object = kSkin},
    Property{.name = "nodes", .type = Type::kObjects, .object = kNode},
    Property{.name = "scene", .type = Type::kIndex, .into = "scenes"},
    Property{.name = "scenes", .type = Type::kObjects, .object = kScene},
    Property{.name = "animations", .type = Type::kObjects, .object = kAnimation},
};

class Checker {
 public:
  Checker(const Outline& outline, Report& report) : outline_(outline), report_(report) {}

  void check_element(json& value, const Property& list, std::size_t index) {
    path_ = {std::string(list.name), index};
    check_object(value, list.object);
  }

  void check_top(json& head) {
    for (const auto& [name, elements] : outline_.lists) {
      path_ = {name};
      const Property* property = find(kDocument, name);
      if (property == nullptr)
        report_.warn(name, kUnknown);
      else if (property->type != Type::kObjects)
        fail("does not have the type that glTF requires");
      else if (elements.empty())
        report_.warn(name, "is empty");
    }
    path_.clear();
    check_object(head, kDocument);
  }

  void check_object(json& value, Object object) {
    if (!value.is_object()) fail("is not an object");
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
      const Property* property = find(object, entry.key());
      path_.emplace_back(entry.key());
      if (property == nullptr)
        report_.warn(path(), kUnknown);
      else
        check(entry.value(), *property);
      path_.pop_back();
    }
    for (const Property& property : object)
      if (property.need == Need::kRequired && !value.contains(property.name))
        fail(fmt::format("'{}' is missing", property.name));
  }

 private:
  static constexpr std::string_view kUnknown = "is not a property that glTF defines";

  static const Property* find(Object object, std::string_view name) {
    const auto found =
        std::find_if(object.begin(), object.end(), [&](const Property& property) { return property.name == name; });
    return found == object.end() ? nullptr : &*found;
  }

  void check(json& value, const Property& property) {
    switch (property.type) {
      case Type::kAny:
        return;
      case Type::kBoolean:
        if (!value.is_boolean()) fail("is neither true nor false");
        return;
      case Type::kString:
        return check_string(value, property);
      case Type::kLabel:
        if (value.is_string()) return;
        report_.warn(path(), "is not a text");
        value = "";
        return;
      case Type::kStrings:
        return check_each(value, property, [&](json& element) { check_string(element, property); });
      case Type::kBounds:
        if (value.is_null()) return;
        return check_each(value, property, [&](const json& element) {
          if (!element.is_number()) fail("is not a number");
        });
      case Type::kNumbers:
        return check_numbers(value, property);
      case Type::kUnsigned:
        return check_unsigned(value, property.at_least, property.at_most);
      case Type::kIndex:
        return check_index(value, property);
      case Type::kIndices:
        return check_each(value, property, [&](json& element) { check_index(element, property); });
      case Type::kIndexMap:
        return check_index_map(value, property);
      case Type::kIndexMaps:
        return check_each(value, property, [&](json& element) { check_index_map(element, property); });
      case Type::kObject:
        return check_object(value, property.object);
      case Type::kObjects:
        return check_each(value, property, [&](json& element) { check_object(element, property.object); });
    }
  }

  template <typename Check>
  void check_each(json& value, const Property& property, Check check_element) {
    if (!value.is_array()) fail("is not a list");
    check_not_empty(value, property);
    for (std::size_t i = 0; i < value.size(); ++i) {
      path_.emplace_back(i);
      check_element(value[i]);
      path_.pop_back();
    }
  }

  void check_not_empty(const json& value, const Property& property) {
    if (!value.empty()) return;
    if (property.empty == Empty::kRefused) fail("is empty");
    report_.warn(path(), "is empty");
  }

  void check_string(const json& value, const Property& property) {
    if (!value.is_string()) fail("is not a text");
    const auto& words = property.words;
    if (!words.empty() && std::find(words.begin(), words.end(), value.get_ref<const std::string&>()) == words.end())
      fail(fmt::format("'{}' is not one of {}", value.get_ref<const std::string&>(), fmt::join(words, ", ")));
  }

  void check_numbers(json& value, const Property& property) {
    if (property.length != 0 && value.is_array() && value.size() != property.length)
      fail(fmt::format("has {} numbers instead of {}", value.size(), property.length));
    check_each(value, property, [&](const json& element) {
      if (!element.is_number()) fail("is not a number");
      if (std::abs(element.get<double>()) > static_cast<double>(std::numeric_limits<float>::max()))
        fail("does not fit into a float");
    });
  }

  void check_unsigned(json& value, std::uint64_t at_least, std::uint64_t at_most) {
    if (!value.is_number()) fail("is not a number");
    // JSON does not distinguish 3.0 from 3, but tinygltf does.
    constexpr double kExact = 9007199254740992.0;
    if (value.is_number_float()) {
      const auto number = value.get<double>();
      if (number >= 0 && number < kExact && std::trunc(number) == number) {
        value = static_cast<std::uint64_t>(number);
        report_.warn(path(), "is a whole number written as a decimal");
      }
    }
    if (value == 0) value = std::uint64_t{0};  // the text may be -0
    if (!value.is_number_unsigned()) fail(fmt::format("{} is not a whole number from 0 up", value.dump()));
    const auto number = value.get<std::uint64_t>();
    if (number < at_least || number > at_most) fail(fmt::format("{} is not in {} … {}", number, at_least, at_most));
  }

  void check_index(json& value, const Property& property) {
    check_unsigned(value, 0, std::numeric_limits<std::uint64_t>::max());
    const auto list = outline_.lists.find(property.into);
    const std::size_t size = list == outline_.lists.end() ? 0 : list->second.size();
    if (value.get<std::uint64_t>() >= size)
      fail(fmt::format("{} does not exist: the number of {} is {}", value.get<std::uint64_t>(), property.into, size));
  }

  void check_index_map(json& value, const Property& property) {
    if (!value.is_object()) fail("is not an object");
    check_not_empty(value, property);
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
      path_.emplace_back(entry.key());
      check_index(entry.value(), property);
      path_.pop_back();
    }
  }

  std::string path() const {
    std::string text;
    for (const auto& step : path_) {
      if (const auto* index = std::get_if<std::size_t>(&step))
        text += fmt::format("[{}]", *index);
      else
        text.append(text.empty() ? "" : ".").append(std::get<std::string>(step));
    }
    return text;
  }

  [[noreturn]] void fail(std::string_view cause) const { report_.fail(path(), cause); }

  const Outline& outline_;
  Report& report_;
  std::vector<std::variant<std::size_t, std::string>> path_;
};

}  // namespace

void check_head(json& head, const Outline& outline, Report& report) {
  Checker(outline, report).check_top(head);
  const auto& version = head["asset"]["version"].get_ref<const std::string&>();
  const std::string least = head["asset"].value("minVersion", "2.0");
  const bool is_number = version.size() > 2 && version.find_first_not_of("0123456789", 2) == std::string::npos;
  if (!version.starts_with("2.") || !is_number || least != "2.0")
    report.fail("asset.version", fmt::format("is glTF {} (at least {}), but only 2.0 can be read", version, least),
                "export the file as glTF 2.0");
}

void check_element(json& element, std::string_view list, std::size_t index, const Outline& outline, Report& report) {
  const auto property =
      std::find_if(kDocument.begin(), kDocument.end(), [&](const Property& known) { return known.name == list; });
  Checker(outline, report).check_element(element, *property, index);
}

}  // namespace vestige::gltf
