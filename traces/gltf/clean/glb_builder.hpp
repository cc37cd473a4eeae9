#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

namespace vestige::gltf {

/// What a bufferView is for (glTF 2.0 §5.11.5). Data other than vertices and indices have no target.
enum class Target { kNone, kVertices = 34962, kIndices = 34963 };

/// A binary glTF under construction. All data lie in `bin`, which becomes buffer 0.
class GlbBuilder {
 public:
  using Json = nlohmann::ordered_json;

  /// Appends an element to a list of the document. Returns its index.
  int add(const char* list, Json element) {
    json[list].push_back(std::move(element));
    return static_cast<int>(json[list].size()) - 1;
  }

  /// Appends `bytes` as a bufferView. Returns its index.
  int add_view(std::span<const std::byte> bytes, Target target) {
    Json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (target != Target::kNone) view["target"] = static_cast<int>(target);
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    bin.resize((bin.size() + 3) / 4 * 4);
    return add("bufferViews", std::move(view));
  }

  /// Appends `numbers` as an accessor of `type`, which has `components` numbers. Returns its index.
  template <typename Number>
  int add_accessor(const std::vector<Number>& numbers, const char* type, std::size_t components, Target target) {
    const int view = add_view(std::as_bytes(std::span(numbers)), target);
    return add("accessors", {{"bufferView", view},
                             {"componentType", component_type(Number())},
                             {"count", numbers.size() / components},
                             {"type", type}});
  }

  /// Does the same, and adds the exact min and max, which positions and times must have.
  int add_bounded_accessor(const std::vector<float>& numbers, const char* type, std::size_t components, Target target) {
    const int accessor = add_accessor(numbers, type, components, target);
    std::vector<float> least(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(components));
    std::vector<float> most = least;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      least[i % components] = std::min(least[i % components], numbers[i]);
      most[i % components] = std::max(most[i % components], numbers[i]);
    }
    json["accessors"].back()["min"] = least;
    json["accessors"].back()["max"] = most;
    return accessor;
  }

  Json json;
  std::vector<std::byte> bin;  ///< its size is a multiple of 4

 private:
  static int component_type(float) { return 5126; }
  static int component_type(std::uint32_t) { return 5125; }
  static int component_type(std::uint16_t) { return 5123; }
};

}  // namespace vestige::gltf
