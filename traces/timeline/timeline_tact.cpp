#include "traces/timeline/timeline_tact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "traces/timeline/bhaptics_vest.hpp"

namespace vestige {

namespace {

constexpr std::int64_t kBin_ms = 20;
constexpr std::int64_t kBin_us = kBin_ms * 1000;
constexpr std::int64_t kMostBins = 24 * 3600 * std::int64_t{1000} / kBin_ms;

}  // namespace

TimelineTact::TimelineTact(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count)
    : file_(path, overwrite), actuator_count_(actuator_count) {
  const std::size_t most = kBhapticsSideActuators * std::size(kBhapticsSides);
  if (actuator_count > most)
    throw UsageError(path.string(),
                     fmt::format("there are {} actuators, but a vest in a .tact file has {}", actuator_count, most),
                     "write a .hjif or a .csv");
  const nlohmann::json name = path.stem().string();
  file_.write(fmt::format(R"({{"intervalMillis":{},"size":{},"name":{},"feedback":{{)", kBin_ms, kBhapticsSideActuators,
                          name.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

void TimelineTact::write(const ActuatorFrame& frame) {
  if (!start_s_) {
    start_s_ = frame.time_s;
    largest_.resize(actuator_count_);
    last_.resize(actuator_count_);
  }
  const double time_us = std::round((frame.time_s - *start_s_) * 1e6);
  if (time_us > static_cast<double>(kMostBins * kBin_us))
    throw Error(file_.path().string(),
                fmt::format("the frame at {} s is more than a day after the first", frame.time_s),
                "write a .hjif or a .csv, which hold gaps");
  const auto whole_us = static_cast<std::int64_t>(time_us);
  if (const std::int64_t bin = whole_us / kBin_us; bin > bin_) {
    write_bin(largest_);
    while (++bin_ < bin) write_bin(last_);
    if (whole_us % kBin_us != 0) {
      largest_ = last_;
    } else {
      std::ranges::fill(largest_, std::uint8_t{0});
    }
  }
  std::ranges::transform(largest_, frame.duty, largest_.begin(), [](auto a, auto b) { return std::max(a, b); });
  last_ = frame.duty;
}

void TimelineTact::write_bin(const std::vector<std::uint8_t>& duty) {
  std::string text = fmt::format("{}\n\"{}\":[", bin_ == 0 ? "" : ",", bin_ * kBin_ms);
  for (std::size_t first = 0; first < actuator_count_; first += kBhapticsSideActuators) {
    fmt::format_to(std::back_inserter(text), R"({}{{"position":"{}","mode":"DOT_MODE","values":[)",
                   first == 0 ? "" : ",", kBhapticsSides[first / kBhapticsSideActuators]);
    for (std::size_t i = first; i < first + kBhapticsSideActuators; ++i) {
      const long percent = i < duty.size() ? bhaptics_intensity(duty[i]) : 0;
      fmt::format_to(std::back_inserter(text), "{}{}", i == first ? "" : ",", percent);
    }
    text += R"(],"texture":0})";
  }
  file_.write(text + ']');
}

void TimelineTact::commit() {
  if (start_s_) write_bin(largest_);
  file_.write(fmt::format("\n}},\"durationMillis\":{}}}\n", start_s_ ? (bin_ + 1) * kBin_ms : 0));
  file_.commit();
}

}  // namespace vestige
