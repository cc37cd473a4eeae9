#include "traces/gltf/json/gltf_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/base/error.hpp"

namespace vestige::gltf {

void Report::fail(std::string_view path, std::string_view cause, std::string_view remedy) const {
  constexpr std::string_view kUsualRemedy = "export the file again, and check it with the Khronos glTF validator";
  throw Error(path.empty() ? name_ : fmt::format("{}: {}", name_, path), cause, remedy.empty() ? kUsualRemedy : remedy);
}

void Report::warn(std::string_view path, std::string_view what) {
  const auto known = std::find_if(oddities_.begin(), oddities_.end(), [&](const Oddity& o) { return o.what == what; });
  if (known != oddities_.end())
    ++known->count;
  else
    oddities_.push_back({std::string(path), std::string(what)});
}

std::vector<std::string> Report::warnings() const {
  std::vector<std::string> sentences;
  for (const Oddity& oddity : oddities_) {
    std::string where = oddity.first_path.empty() ? name_ : fmt::format("{}: {}", name_, oddity.first_path);
    if (oddity.count > 1) where += fmt::format(" (and {} more)", oddity.count - 1);
    sentences.push_back(fmt::format("{}: {}", where, oddity.what));
  }
  return sentences;
}

}  // namespace vestige::gltf
