#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace vestige {

/// The nodes of an avatar that are the bones of a human body. Keys are the names of Unity's HumanBodyBones ("Hips",
/// "LeftUpperArm"), which VRM and the VMC protocol share.
struct Humanoid {
  /// The extension of the file: none, VRM 0.x or VRM 1.0. Names of joints tell the bones that its table does not have.
  enum class Source { kNames, kVrm0, kVrm1 };

  std::map<std::string, std::size_t, std::less<>> node_of;
  Source source = Source::kNames;
  /// Invalid parts of the extension, which are left out, each with its field, and a body beside this one; the first 10
  /// of `problem_count`.
  std::vector<std::string> problems;
  std::size_t problem_count = 0;
};

}  // namespace vestige
