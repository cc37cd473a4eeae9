#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Reads frames from lines of JSON as they arrive (traces/FORMAT.md, "Frames as text"). Accepts any bytes: a line that
/// is not a frame, or contradicts the one before, is counted and left out, and reading continues with the next line.
class LiveNdjson {
 public:
  using TakeFrame = std::function<void(TraceFrame)>;

  explicit LiveNdjson(const Avatar& avatar);

  /// Takes bytes in pieces of any size. `now_ns`, counted from the start, is the time of lines that give none.
  void push(std::string_view bytes, std::int64_t now_ns, const TakeFrame& take);
  /// Call this after the last bytes. A last line without an end counts.
  void finish(std::int64_t now_ns, const TakeFrame& take);

  std::uint64_t malformed() const { return malformed_; }  ///< lines left out
  /// The reasons for the first few lines left out, one sentence each. Also names unknown fields, which are ignored.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void take_line(std::string_view line, std::int64_t now_ns, const TakeFrame& take);
  void leave_out(std::string_view cause);
  /// Reports fields of an object that are not among `known`, once each.
  template <typename AnyJson>
  void note_unknown(const AnyJson& object, std::initializer_list<std::string_view> known);

  const std::map<std::string, std::size_t, std::less<>> node_of_;
  const Pose rest_;
  Pose pose_;         ///< pose of the last frame
  std::string line_;  ///< beginning of an unfinished line
  bool too_long_ = false;
  std::uint64_t lines_ = 0;
  std::uint64_t next_index_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint64_t malformed_ = 0;
  std::vector<std::string> problems_;
  std::set<std::string> unknown_;  ///< fields already reported
};

}  // namespace vestige
