#include "traces/motion/bvh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 29;
constexpr std::size_t kMostJoints = 10000;
constexpr std::size_t kDeepest = 256;
constexpr double kLongest_s = 1e9;
constexpr double kShortestFrame_s = 1e-9;  // a trace's times are in nanoseconds
constexpr float kFarthest = 1e9F;
constexpr std::string_view kSpace = " \t\r\v\f";

constexpr std::string_view kChannelNames[] = {"Xposition", "Yposition", "Zposition",
                                              "Xrotation", "Yrotation", "Zrotation"};

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

/// Reads a text word by word and counts lines.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }

  /// Returns the next word, across line ends, or an empty text at the end of the file.
  std::string_view next() {
    std::string_view word;
    while ((word = next_in_line()).empty() && !text_.empty()) {
      text_.remove_prefix(1);
      ++line_;
    }
    return word;
  }

  /// Returns the next word of this line, or an empty text at its end.
  std::string_view next_in_line() {
    text_.remove_prefix(std::min(text_.find_first_not_of(kSpace), text_.size()));
    const std::string_view word = text_.substr(0, text_.find_first_of(" \t\r\v\f\n"));
    text_.remove_prefix(word.size());
    return word;
  }

  /// Returns the rest of this line up to a brace, without space around it.
  std::string_view rest_of_line() {
    std::string_view rest = text_.substr(0, text_.find_first_of("\n{"));
    text_.remove_prefix(rest.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
    return rest.substr(0, rest.find_last_not_of(kSpace) + 1);
  }

  void expect(std::string_view wanted) {
    const std::string_view word = next();
    if (!same_word(word, wanted)) fail(fmt::format("expected {} instead of {}", wanted, quoted(word)));
  }

  /// Reads a label and its colon, perhaps with space before the colon or none after it.
  void expect_label(std::string_view label) {
    std::string_view word = next();
    const std::size_t length = std::min(word.find(':'), word.size());
    if (!same_word(word.substr(0, length), label)) fail(fmt::format("expected {}: instead of {}", label, quoted(word)));
    word.remove_prefix(length);
    if (word.empty()) word = next();
    if (!word.starts_with(':')) fail(fmt::format("expected a colon after {} instead of {}", label, quoted(word)));
    text_ = {word.data() + 1, word.size() - 1 + text_.size()};
  }

  template <typename Number>
  Number number(std::string_view word, std::string_view what) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    Number value = 0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure == std::errc::invalid_argument || end != word.data() + word.size())
      fail(fmt::format("{} is {}, which is not a number", what, quoted(word)));
    bool fits = failure == std::errc();
    if constexpr (std::is_floating_point_v<Number>) {
      // A number too small for its type counts as 0. from_chars does not distinguish it from one that is too large.
      if (!fits && std::abs(std::strtod(std::string(word).c_str(), nullptr)) < 1) return 0;
      fits = fits && std::abs(value) <= Number{kFarthest};
    }
    if (!fits) fail(fmt::format("{} is {}, out of range", what, shown_word(word)));
    return value;
  }

  static std::string quoted(std::string_view word) {
    return word.empty() ? "the end" : fmt::format("'{}'", shown_word(word));
  }

  [[noreturn]] void fail(std::string_view cause, std::string_view remedy = "export the motion as BVH again") const {
    throw Error(fmt::format("{}, line {}", name_, line_), cause, remedy);
  }

  const std::string& name() const { return name_; }

  std::size_t bytes_left() const { return text_.size(); }

  bool is_only_space_left() const { return text_.find_first_not_of(" \t\r\v\f\n") == std::string_view::npos; }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t line_ = 1;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : words_(text, name) {}

  BvhMotion parse() {
    if (const std::string_view first = words_.next(); !same_word(first, "HIERARCHY"))
      words_.fail(fmt::format("starts with {}, not with HIERARCHY, so it is not a BVH file", Words::quoted(first)),
                  "name a .bvh file");
    parse_hierarchy();
    parse_motion();
    return std::move(motion_);
  }

 private:
  void parse_hierarchy() {
    std::vector<int> open;  ///< joints whose brace is open, the innermost last
    for (;;) {
      const std::string_view word = words_.next();
      const int current = open.empty() ? -1 : open.back();
      if (same_word(word, open.empty() ? "ROOT" : "JOINT")) {
        if (open.size() >= kDeepest) words_.fail(fmt::format("joints are nested deeper than {}", kDeepest));
        open.push_back(begin_joint(current));
      } else if (!open.empty() && same_word(word, "End")) {
        parse_end_site(static_cast<std::size_t>(current));
      } else if (!open.empty() && same_word(word, "OFFSET")) {
        motion_.joints[static_cast<std::size_t>(current)].offset = parse_offset();
      } else if (!open.empty() && same_word(word, "CHANNELS")) {
        parse_channels(motion_.joints[static_cast<std::size_t>(current)]);
      } else if (!open.empty() && word == "}") {
        open.pop_back();
      } else if (open.empty() && same_word(word, "MOTION")) {
        break;
      } else if (word.empty()) {
        words_.fail(open.empty() ? "the file ends before MOTION" : "the file ends before a brace is closed",
                    "the file was cut short: copy or export it again");
      } else {
        words_.fail(fmt::format("'{}' is not allowed here", shown_word(word)));
      }
    }
    if (motion_.joints.empty()) words_.fail("there is no joint before MOTION");
    if (motion_.channel_count == 0) words_.fail("no joint has a channel: nothing moves");
  }

  int begin_joint(int parent) {
    if (motion_.joints.size() >= kMostJoints) words_.fail(fmt::format("there are more than {} joints", kMostJoints));
    const std::string_view name = words_.rest_of_line();
    if (name.empty()) words_.fail("a joint has no name");
    words_.expect("{");
    BvhJoint& joint = motion_.joints.emplace_back();
    joint.name = name;
    joint.parent = parent;
    joint.first_channel = motion_.channel_count;
    motion_.ends.emplace_back(0);
    return static_cast<int>(motion_.joints.size()) - 1;
  }

  void parse_end_site(std::size_t joint) {
    words_.rest_of_line();  // "Site", perhaps a name
    words_.expect("{");
    words_.expect("OFFSET");
    motion_.ends[joint] = parse_offset();
    words_.expect("}");
  }

  glm::dvec3 parse_offset() {
    glm::dvec3 offset;
    for (int axis = 0; axis < 3; ++axis) offset[axis] = words_.number<double>(words_.next(), "an OFFSET");
    return offset;
  }

  void parse_channels(BvhJoint& joint) {
    if (!joint.channels.empty()) words_.fail(fmt::format("joint '{}' has CHANNELS twice", shown_word(joint.name)));
    if (joint.first_channel != motion_.channel_count)
      words_.fail(fmt::format("the CHANNELS of '{}' come after its children", shown_word(joint.name)));
    const auto count = words_.number<unsigned>(words_.next(), "the number of CHANNELS");
    if (count > std::size(kChannelNames)) words_.fail(fmt::format("a joint has {} channels, more than 6", count));
    for (unsigned i = 0; i < count; ++i) {
      const std::string_view word = words_.next_in_line();
      if (word.empty()) words_.fail(fmt::format("{} channels were announced, but there are only {}", count, i));
      const auto* const name =
          std::ranges::find_if(kChannelNames, [&](std::string_view known) { return same_word(known, word); });
      if (name == std::end(kChannelNames))
        words_.fail(fmt::format("there is no channel '{}'", shown_word(word)),
                    "use only the channels Xposition … Zrotation");
      const auto channel = static_cast<BvhChannel>(name - std::begin(kChannelNames));
      if (std::ranges::find(joint.channels, channel) != joint.channels.end())
        words_.fail(fmt::format("joint '{}' has {} twice", shown_word(joint.name), *name));
      joint.channels.push_back(channel);
    }
    if (const std::string_view more = words_.next_in_line(); !more.empty())
      words_.fail(fmt::format("{} channels were announced, but '{}' follows", count, shown_word(more)));
    motion_.channel_count += count;
  }

  void parse_motion() {
    words_.expect_label("Frames");
    const auto frames = words_.number<std::uint64_t>(words_.next(), "the number of frames");
    if (frames == 0) words_.fail("there are 0 frames");
    // A number takes at least a digit and a space, so the file's size bounds the allocation.
    const std::uint64_t most = (words_.bytes_left() + 1) / 2 / motion_.channel_count;
    if (frames > most)
      words_.fail(fmt::format("{} frames of {} numbers do not fit into the {} bytes that follow", frames,
                              motion_.channel_count, words_.bytes_left()),
                  "copy or export the file again: it was cut short, or its number of frames is wrong");
    words_.expect("Frame");
    words_.expect_label("Time");
    motion_.frame_time_s = words_.number<double>(words_.next(), "the frame time");
    if (!(motion_.frame_time_s > 0)) words_.fail("the frame time is not positive");
    if (motion_.frame_time_s < kShortestFrame_s)
      words_.fail(fmt::format("the frame time is {} s, less than 1e-9 s", motion_.frame_time_s),
                  "write it in seconds: 0.00833333 for 120 frames a second");
    parse_frames(static_cast<std::size_t>(frames));
    if (static_cast<double>(motion_.frame_count) * motion_.frame_time_s > kLongest_s)
      words_.fail("the motion lasts longer than 1e9 s", "check the frame time");
  }

  /// Like other programs (Blender's importer), takes all frames that are there, even if more than were announced.
  void parse_frames(std::size_t announced) {
    motion_.values.reserve(announced * motion_.channel_count);
    std::string_view left_out;
    while (motion_.frame_count < announced || !words_.is_only_space_left()) {
      const std::size_t numbers = parse_frame(announced);
      if (numbers == motion_.channel_count) {
        ++motion_.frame_count;
        continue;
      }
      motion_.values.resize(motion_.frame_count * motion_.channel_count);
      left_out = "; a last one, which is cut short, is left out";
    }
    if (motion_.frame_count > announced || !left_out.empty())
      motion_.warnings.push_back(
          fmt::format("{}: {} frames were announced, but there are {}, and all of these are read{}", words_.name(),
                      announced, motion_.frame_count, left_out));
  }

  /// Returns how many numbers the frame has: all, or fewer if it is the last one of more than were announced.
  std::size_t parse_frame(std::size_t announced) {
    const std::size_t frame = motion_.frame_count;
    std::string_view word = words_.next();
    if (word.empty())
      words_.fail(fmt::format("{} frames were announced, but there are only {}", announced, frame),
                  "copy or export the file again: it was cut short, or its number of frames is wrong");
    for (std::size_t channel = 0; channel < motion_.channel_count; ++channel) {
      if (channel > 0) word = words_.next_in_line();
      if (word.empty() && frame >= announced && words_.is_only_space_left()) return channel;
      if (word.empty())
        words_.fail(fmt::format("frame {} has {} numbers, but the joints have {} channels", frame, channel,
                                motion_.channel_count));
      motion_.values.push_back(words_.number<float>(word, "a channel"));
    }
    if (!words_.next_in_line().empty())
      words_.fail(
          fmt::format("frame {} has more than the {} numbers of the joints' channels", frame, motion_.channel_count));
    return motion_.channel_count;
  }

  Words words_;
  BvhMotion motion_;
};

/// Returns the place of a joint that has the place `local` in its parent.
BvhPlace below(const std::vector<BvhPlace>& places, int parent, const BvhPlace& local) {
  if (parent < 0) return local;
  const BvhPlace& above = places[static_cast<std::size_t>(parent)];
  return {above.position + above.rotation * local.position, above.rotation * local.rotation};
}

}  // namespace

void bvh_places(const BvhMotion& motion, std::size_t frame, std::vector<BvhPlace>& out) {
  out.resize(motion.joints.size());
  for (std::size_t j = 0; j < motion.joints.size(); ++j) {
    const BvhJoint& joint = motion.joints[j];
    BvhPlace local = {joint.offset, glm::dquat(1, 0, 0, 0)};
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
      const double value = double{motion.value(frame, joint.first_channel + c)};
      const int channel = static_cast<int>(joint.channels[c]);
      if (channel < 3) {
        local.position[channel] = value;
      } else {
        glm::dvec3 axis(0);
        axis[channel - 3] = 1;
        local.rotation = local.rotation * glm::angleAxis(glm::radians(value), axis);
      }
    }
    out[j] = below(out, joint.parent, local);
  }
}

std::vector<BvhPlace> bvh_rest(const BvhMotion& motion) {
  std::vector<BvhPlace> places;
  for (const BvhJoint& joint : motion.joints)
    places.push_back(below(places, joint.parent, {joint.offset, glm::dquat(1, 0, 0, 0)}));
  return places;
}

std::string shown_word(std::string_view word) {
  constexpr std::size_t kMost = 40;
  if (word.size() <= kMost) return std::string(word);
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(word[end]) & 0xC0U) == 0x80) --end;  // inside a UTF-8 character
  return std::string(word.substr(0, end)) + "...";
}

BvhMotion parse_bvh(std::string_view text, const std::string& name) {
  return Parser(text, name).parse();
}

BvhMotion read_bvh(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, kMostBytes);
  return parse_bvh(text, path == "-" ? "standard input" : path.string());
}

}  // namespace vestige
