#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kSweep[] = {
    {"trace", "", "the trace that was measured"},
    {"surface", "", "all, or mapped: whether skin without an actuator hides what lies behind it"},
    {"runs", "", "places of the trace that were measured, evenly spaced"},
    {"run_frames", "", "frames measured at each place"},
    {"min_time_s", "s", "least time of each point"},
    {"seed", "", "seed of the drawn colliders and of the order of turns"},
    {"sample/places", "", "places that were measured"},
    {"sample/sha256", "", "of their frames; equal: the same was measured"},
    {"sample/sampled/empty_share", "", "share of their frames without a contact, with all colliders: 0 to 1"},
    {"sample/sampled/contacts_per_frame", "", "mean over their frames, with all colliders"},
    {"sample/trace/empty_share", "", "the same share over all frames of the trace but the first"},
    {"sample/trace/contacts_per_frame", "", "the same mean over all frames of the trace but the first"},
    {"complete", "", "false: interrupted, so points may lack passes"},
};

constexpr Field kSeries[] = {
    {"detector", "", "the detector that was measured"},
    {"approximate", "", "true: simpler shapes stood for the skin"},
    {"context", "", "its OpenGL context; empty: none"},
    {"skip", "", "on: what cannot touch was skipped"},
    {"triangles_kept", "", "triangles of the simpler mesh; null: the whole skin"},
    {"method", "", "static, carried or ccd: how the body's own motion counts"},
    {"planes", "", "planes (render targets) that it delivered"},
    {"renderer", "", "on: the scene was drawn meanwhile"},
    {"renderer_gl", "", "OpenGL that drew the scene; null: none did"},
    {"avatars", "", "number of people at once, each with a detector of their own"},
    {"colliders_around", "", "all: each copy of the trace's people has as many colliders; first: only the first copy"},
};

constexpr Field kPoint[] = {
    {"colliders", "", "number of colliders"},
    {"frames", "", "frames that were timed, after the cold pass"},
    {"stored_frames", "", "of them, those in frame_times.csv.zst"},
    {"pass_frames", "", "frames of one pass over all places"},
    {"frames_skipped", "", "frames of one pass that bounds alone showed to be without contact, once for each person"},
    {"hz", "Hz",
     "frames / total time, one frame after another: the frequency to quote; 1e6 / hz is the mean latency in us"},
    {"hz_low", "Hz", "low end of its 95 % interval (bootstrap over passes); null: too few passes, or too scattered"},
    {"hz_high", "Hz", "high end of that interval"},
    {"cold_hz", "Hz", "frequency of the first pass, when caches hold nothing of it; null: not measured"},
    {"hz_median", "Hz", "1e6 / us_median"},
    {"us_median", "us", "median duration of a frame"},
    {"us_p95", "us", "95 % of the frames took at most this"},
    {"us_p99", "us", "99 % of the frames took at most this"},
    {"us_max", "us", "the longest frame"},
    {"noise", "", "how much repetitions of one place differ: half the interquartile range, as a share of their time"},
    {"repetitions", "", "measured stretches: places x passes"},
    {"empty_share", "", "share of the frames without a contact: 0 to 1"},
    {"contacts", "", "contacts of one pass"},
    {"pairs_tested", "", "pairs of segment and triangle tested in one pass"},
    {"pairs_meeting", "", "of them, pairs that meet, which only geometry, compute and cpu count"},
    {"triangles_tested", "", "triangles of one pass that were tested at least once in their frame"},
    {"meshlets_skinned", "", "meshlets skinned in one pass; 0: the whole mesh was"},
    {"part_pairs", "",
     "pairs of a collider in reach and a part of the skin, in one pass; 0: the detector looks at all"},
    {"pairs_spared", "", "of them, pairs not looked at, as an earlier frame had proven them apart"},
    {"texture_hash", "", "SHA-256 of one pass' contacts; equal: equal to the bit"},
    {"disagreements", "",
     "results of one pass whose hit or actuator differs from its own with all colliders; exact ones never differ"},
    {"times_paper", "", "how many times as fast as the fastest paper of the run; only where paper was measured"},
    {"times_embree", "", "how many times as fast as the fastest Embree of the run; only where Embree was measured"},
    {"throughput_hz", "Hz",
     "frames / total time of frames that the detector was given in_flight at a time; only with --in-flight"},
    {"throughput_hz_low", "Hz", "low end of its 95 % interval, as of hz"},
    {"throughput_hz_high", "Hz", "high end of that interval"},
    {"in_flight", "", "number of frames that the detector was given at a time for throughput_hz"},
    {"rendered_hz", "Hz", "how often the scene was drawn meanwhile; only with a renderer"},
    {"memory_bytes", "bytes",
     "memory that a detector holds after its first frames, without a GPU's own; only of growth"},
    {"stages/*", "us",
     "time of a frame spent there, mean: pose, candidates, skinning, upload, draw, wait, read_back, "
     "test, decision; only with --stages"},
    {"draw_by", "",
     "timer: the driver's own timer told drawing from waiting; clock: there is no wait, and read_back has the rest"},
};

constexpr Field kFrameTimes[] = {
    {"detector", "", "the detector that was measured"},
    {"context", "", "its OpenGL context; empty: none"},
    {"skip", "", "on: what cannot touch was skipped"},
    {"planes", "", "planes (render targets) that it delivered"},
    {"renderer", "", "on: the scene was drawn meanwhile"},
    {"avatars", "", "number of people at once"},
    {"colliders_around", "", "all: each copy of the trace's people has colliders; first: only the first copy"},
    {"colliders", "", "number of colliders"},
    {"repetition", "", "measured stretch, from 0 on: repetition r measured place r modulo runs"},
    {"frame", "", "frame within the stretch, from 0 on"},
    {"us", "us", "duration of the frame"},
};

constexpr Field kGrowth[] = {
    {"trace", "", "the trace that was measured"},
    {"crowded_trace", "", "the trace for numbers of colliders that it lacks; null: none was needed"},
    {"complete", "", "false: interrupted"},
    {"colliders", "", "number of colliders on every size of avatar"},
    {"frame_limit_s", "s", "a series whose mean frame took longer was left out of larger sizes"},
    {"by_triangles/triangles", "", "triangles of this size of avatar"},
    {"by_triangles/vertices", "", "vertices of this size of avatar"},
    {"by_triangles/frames", "", "distinct frames, which are measured repeatedly"},
    {"ablation/series", "", "the series that was measured with and without skipping"},
    {"ablation/triangles_of_avatar", "", "triangles of the avatar"},
    {"ablation/colliders", "", "number of colliders"},
    {"ablation/frames", "", "frames of one pass; the counts below are of the same pass"},
    {"ablation/frames_skipped", "", "frames that bounds alone showed to be without contact"},
    {"ablation/meshlets_skinned", "", "meshlets skinned"},
    {"ablation/triangles", "", "triangles that brute force tests"},
    {"ablation/triangles_tested", "", "triangles tested with skipping"},
    {"ablation/pairs", "", "pairs that brute force tests"},
    {"ablation/pairs_tested", "", "pairs tested with skipping"},
    {"ablation/pairs_meeting", "",
     "of them, pairs that meet, which only geometry, compute and cpu count: no test could have saved them"},
    {"ablation/us_off", "us", "mean of a frame without skipping"},
    {"ablation/us_on", "us", "mean of a frame with skipping"},
    {"ablation/us_saved_by_frames", "us", "of the difference: saved by frames that were skipped entirely"},
    {"ablation/us_saved_by_meshlets", "us", "the rest: saved by parts left out of the other frames"},
};

constexpr Field kCrossover[] = {
    {"at", "", "number of colliders, or of triangles, at which two lines cross"},
    {"cheaper_below", "", "the series that costs less below it"},
    {"cheaper_above", "", "the series that costs less above it"},
};

constexpr Field kLeftOut[] = {
    {"series", "", "the series that was left out of the larger sizes"},
    {"above", "", "number of colliders, or of triangles: the last size at which it was measured"},
    {"frame_s", "s", "mean of a frame there"},
};

constexpr Field kCompare[] = {
    {"a/folder", "", "the first run"},
    {"a/commit", "", "commit of the program that wrote it"},
    {"a/time", "", "when it was written, UTC"},
    {"b/folder", "", "the second run"},
    {"b/commit", "", "commit of the program that wrote it"},
    {"b/time", "", "when it was written, UTC"},
    {"threshold_percent", "%", "least change of the duration that counts"},
    {"changes", "", "what differs between the runs beside their speed, a sentence each"},
    {"counts/*", "", "points with this verdict"},
    {"points/name", "", "the point, with the place of its sweep"},
    {"points/verdict", "",
     "B beside A. faster, slower: a change that counts, and the interval does not hold 1; same: the whole interval "
     "is within the threshold; unclear: neither"},
    {"points/ratio", "", "how many times as fast B is as A"},
    {"points/low", "", "low end of its 95 % interval; null: too few passes, or too scattered"},
    {"points/high", "", "high end of that interval"},
    {"points/hz_a", "Hz", "typical frequency of A"},
    {"points/hz_b", "Hz", "typical frequency of B"},
    {"points/passes_a", "", "passes of A"},
    {"points/passes_b", "", "passes of B"},
    {"points/same_answers", "", "false: A and B found other contacts"},
    {"only_a", "", "points that B lacks"},
    {"only_b", "", "points that A lacks"},
};

}  // namespace

FieldGroups sweep_fields() {
  return {{"", kSweep},
          {"series", kSeries},
          {"series/points", kPoint},
          {"series/gl", gl_fields()},
          {"series/renderer_gl", gl_fields()},
          {"avatar", avatar_fields()},
          {"gl", gl_fields()},
          {"", origin_fields()}};
}

FieldGroups frame_time_fields() {
  return {{"", kFrameTimes}};
}

FieldGroups growth_fields() {
  return {{"", kGrowth},
          {"by_colliders/series", kSeries},
          {"by_colliders/series/points", kPoint},
          {"by_colliders/series/gl", gl_fields()},
          {"by_triangles/series", kSeries},
          {"by_triangles/series/points", kPoint},
          {"by_triangles/series/gl", gl_fields()},
          {"left_out/colliders", kLeftOut},
          {"left_out/triangles", kLeftOut},
          {"crossovers/colliders", kCrossover},
          {"crossovers/triangles", kCrossover},
          {"avatar", avatar_fields()},
          {"", origin_fields()}};
}

FieldGroups compare_fields() {
  return {{"", kCompare}, {"", origin_fields()}};
}

}  // namespace vestige
