#include "cli/choices/limits_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "cli/help/validators.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

struct Unit {
  std::string_view name;
  double factor;
};

constexpr std::array kSizes = {Unit{"B", 1},           Unit{"kB", 1e3},           Unit{"MB", 1e6},
                               Unit{"GB", 1e9},        Unit{"TB", 1e12},          Unit{"KiB", 1024},
                               Unit{"MiB", 1048576.0}, Unit{"GiB", 1073741824.0}, Unit{"TiB", 1099511627776.0}};
constexpr std::array kTimes = {Unit{"", 1}, Unit{"ms", 1e-3}, Unit{"s", 1}, Unit{"min", 60}, Unit{"h", 3600}};

/// Shorter parts would be a file for each frame.
constexpr double kShortestPart_s = 0.01;

/// Less than this no ring is bounded by: it is one block.
constexpr std::uint64_t kSmallestRingBytes = std::uint64_t{2} << 20;

/// A positive number and one of the units; nothing where it is no such thing.
template <typename Units>
std::optional<double> parse_with_unit(std::string_view text, const Units& units) {
  double number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || !std::isfinite(number) || number <= 0) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.name == text; });
  if (unit == units.end()) return {};
  return number * unit->factor;
}

std::optional<std::uint64_t> parse_bytes(const std::string& text) {
  constexpr double kMost = 1e18;
  const bool has_unit = !text.empty() && text.back() == 'B';
  const auto bytes = parse_with_unit(has_unit ? text : text + "B", kSizes);
  if (!bytes || *bytes < 1 || *bytes > kMost) return {};
  return static_cast<std::uint64_t>(*bytes);
}

}  // namespace

std::uint64_t parse_size(const std::string& text, const std::string& flag) {
  if (const auto bytes = parse_bytes(text)) return *bytes;
  throw UsageError(flag, fmt::format("'{}' is not a size", text),
                   "give bytes, or a number with a unit: 500MB, 64MiB, 2GiB");
}

void add_limits_options(CLI::App& verb, LimitsChoice& choice) {
  verb.add_option(
          "--ring", choice.ring_s,
          "Keep only the last seconds, in memory. They are written at the end, and at each SIGUSR1 as NAME-0001.mcap "
          "and so on")
      ->type_name("SECONDS")
      ->check(help::kPositive);
  verb.add_option(
          "--max-size", choice.max_size,
          "The largest size of a file: before it is exceeded, the recording ends, or continues in the next part "
          "(--split). With --ring, the largest amount of memory")
      ->type_name("SIZE");
  verb.add_option("--split", choice.split,
                  "Write parts NAME-0001.mcap and so on, each a complete trace: 60s, 10min or 500MiB, at least 0.01 s. "
                  "'vestige merge' joins the parts. --force removes all parts of an earlier recording")
      ->type_name("SECONDS|SIZE");
  verb.add_flag("--sync", choice.sync, "Write each chunk to disk at once, so that a power cut loses at most 100 ms");
}

RecordingLimits limits_of(const LimitsChoice& choice, const std::string& output) {
  RecordingLimits limits;
  limits.ring_s = choice.ring_s;
  if (!choice.max_size.empty()) limits.max_bytes = parse_size(choice.max_size, "--max-size");
  if (!choice.split.empty()) {
    limits.split_s = parse_with_unit(choice.split, kTimes);
    if (!limits.split_s) limits.split_bytes = parse_bytes(choice.split);
    if (!limits.splits())
      throw UsageError("--split", fmt::format("'{}' is neither a time nor a size", choice.split),
                       "give seconds, or a number with a unit: 60s, 10min, 500MB, 64MiB");
    if (limits.split_s && *limits.split_s < kShortestPart_s)
      throw UsageError("--split", fmt::format("'{}' is less than {} s", choice.split, kShortestPart_s),
                       "make the parts longer");
  }
  if (limits.ring_s && limits.splits())
    throw UsageError("--split", "a ring is written in one piece, so it has no parts", "leave out --ring or --split");
  if (limits.ring_s && choice.sync)
    throw UsageError("--sync", "a ring stays in memory until the recording ends", "leave out --ring or --sync");
  if (limits.split_bytes && limits.max_bytes)
    throw UsageError("--max-size", "--split already limits the size of a part", "leave out --max-size or --split");
  if (limits.splits() && output == "-")
    throw UsageError("--split", "standard output is one file", "name a file: -o OUT.mcap");
  if (limits.ring_s && limits.max_bytes && *limits.max_bytes < kSmallestRingBytes)
    throw UsageError("--max-size", "a ring needs at least 2 MiB of memory", "allow 2MiB or more");
  return limits;
}

}  // namespace vestige::cli
