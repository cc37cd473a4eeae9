#include "analysis/run/playback.hpp"

namespace vestige {

PlaybackResult play(TraceReader& trace, std::span<const DetectedPerson> people, const PlaybackOptions& options,
                    const PlaybackCalls& calls) {
  FeltFrames frames(people, trace.collider_ids(), calls);
  const FrameCalls paced = {
      .begin_run = [&] { frames.begin_run(); },
      .go_on = calls.go_on,
      .gap = [&](double time_s, FrameCalls::Clock::time_point now) { frames.gap(time_s, now); },
      .fell_behind = calls.fell_behind,
      .take = [&](const TraceFrame& frame, double time_s,
                  FrameCalls::Clock::time_point due) { frames.take(frame, time_s, due); },
  };
  PlaybackResult result = {play_frames(trace, options, paced)};
  result.people = frames.finish();
  return result;
}

}  // namespace vestige
