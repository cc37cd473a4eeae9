#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kAccuracy[] = {
    {"animation", "", "the avatar's animation; empty: it stands still"},
    {"duration_s", "s", "length of one scene"},
    {"surface", "", "all, or mapped: whether skin without an actuator hides what lies behind it"},
    {"keep", "", "share of the triangles that decimated keeps"},
    {"tolerance_ms", "ms", "largest distance of two impacts that belong together, for within_tolerance"},
    {"precision_pp", "pp",
     "seeds were added until intervals reach at most so many percentage points up and down; "
     "null: not asked for"},
    {"seed", "", "first seed"},
    {"complete", "", "false: interrupted"},
    {"scenes/colliders", "", "the scenario or file"},
    {"scenes/count", "", "number of colliders"},
    {"scenes/seeds", "", "seeds of the scenes that were measured"},
    {"scenes/duration_s", "s", "length of all seeds together"},
    {"scenes/truth/detector", "", "detector of the truth"},
    {"scenes/truth/method", "", "ccd: continuous collision detection"},
    {"scenes/truth/rate_hz", "Hz", "rate of the truth"},
    {"scenes/truth/contacts", "", "contacts at that rate"},
    {"scenes/truth/events", "",
     "true events: maximal runs of contact of one collider with one actuator, or with skin without any; of a sphere "
     "whole touches, whatever the actuators"},
    {"scenes/truth/frames_checked_by_exact", "", "frames of the truth that exact confirmed"},
    {"scenes/truth/inside_s", "s",
     "time, summed over the colliders, in which spheres are wholly inside the body and so touch nothing; only if "
     "colliders "
     "have a radius and the skin is closed"},
    {"scenes/truth/halved/rate_hz", "Hz", "half the rate of the truth"},
    {"scenes/truth/halved/contacts", "", "contacts at that rate"},
    {"scenes/truth/halved/events", "", "events at that rate"},
};

constexpr Field kErrorSeries[] = {
    {"detector", "", "the detector that was measured"},
    {"approximate", "", "true: simpler shapes stood for the skin"},
    {"method", "", "static, carried or ccd: how the body's own motion counts"},
    {"triangles_kept", "", "triangles of the simpler mesh; only with decimated"},
};

constexpr Field kErrorPoint[] = {
    {"rate_hz", "Hz", "frames per second of the scene"},
    {"frames", "", "frames of all seeds"},
    {"contacts", "", "contacts in them"},
    {"touches/frames_within", "",
     "frames of a sphere that touches, more than one frame from the touch's beginning and end; only if colliders have "
     "a "
     "radius"},
    {"touches/reported", "", "of these, frames in which the detector reports a contact"},
    {"touches/wrong_actuator", "", "of these, frames with an actuator that no true contact of that time has"},
    {"touches/frames_outside", "", "frames of a sphere that touches nothing, more than one frame from every touch"},
    {"touches/false", "", "of these, frames in which the detector reports a contact"},
    {"skinning_error_m", "m", "largest distance of a vertex from skinning in double precision"},
};

// By the rule of one frame; below within_tolerance, by the tolerance.
constexpr Field kErrorEvents[] = {
    {"true_events", "", "found + mistaken + missed"},
    {"found", "", "true events that an event of the detector meets, with the right actuator"},
    {"mistaken", "", "true events that only an event of another actuator meets"},
    {"missed", "", "true events that no event of the detector meets, or only one that is right about another"},
    {"missed_beside_another", "", "of missed: those met by an event that is right about another true event"},
    {"test_events", "", "events of the detector: right + wrong_actuator + false_events"},
    {"right", "", "events of the detector that match a true event"},
    {"wrong_actuator", "", "events of the detector that meet only true events of other actuators"},
    {"false_events", "", "events of the detector that meet no true event"},
    {"wrong_share/value", "",
     "(missed + wrong_actuator + false_events) / true_events; may be over 1; null: no true events"},
    {"wrong_share/low", "", "low end of its 95 % interval (bootstrap over colliders); null: too few colliders"},
    {"wrong_share/high", "", "high end of that interval"},
    {"missed_share/value", "", "missed / true_events"},
    {"missed_share/low", "", "low end of its 95 % interval"},
    {"missed_share/high", "", "high end of that interval"},
    {"false_share/value", "", "false_events / true_events; may be over 1"},
    {"false_share/low", "", "low end of its 95 % interval"},
    {"false_share/high", "", "high end of that interval"},
    {"wrong_actuator_share/value", "", "wrong_actuator / true_events"},
    {"wrong_actuator_share/low", "", "low end of its 95 % interval"},
    {"wrong_actuator_share/high", "", "high end of that interval"},
};

constexpr Field kInstants[] = {
    {"impact_error_ms", "ms", "null: no event is right"},
    {"impact_error_ms/*", "ms", "from the true instant of a contact to the detector's, over right events"},
    {"onset_error_ms", "ms", "null: no event is right"},
    {"onset_error_ms/*", "ms", "from the true instant to the end of the event's first frame: latency"},
};

constexpr Field kErrorTimes[] = {
    {"scenes/colliders", "", "the scenario or file"},
    {"scenes/pareto/detector", "", "a point that nothing beats in both processor time and wrong events"},
    {"scenes/pareto/method", "", "its method"},
    {"scenes/pareto/rate_hz", "Hz", "its rate"},
    {"scenes/pareto/processor_ms_per_s", "ms/s", "processor time of all threads for one second of the scene"},
    {"scenes/pareto/wrong_share", "", "wrong events / true events, within the tolerance"},
    {"scenes/series/points/rate_hz", "Hz", "frames per second of the scene"},
    {"scenes/series/points/frames", "", "frames of one pass, all seeds"},
    {"scenes/series/points/passes", "", "how often each frame was timed"},
    {"scenes/series/points/hz", "Hz", "frames / total time"},
    {"scenes/series/points/us_median", "us", "median duration of a frame"},
    {"scenes/series/points/us_p99", "us", "99 % of the frames took at most this"},
    {"scenes/series/points/us_max", "us", "the longest frame"},
    {"scenes/series/points/processor_ms_per_s/value", "ms/s",
     "processor time of all threads for one second of the scene"},
    {"scenes/series/points/processor_ms_per_s/low", "ms/s",
     "low end of its 95 % interval; null: too few passes, or too scattered"},
    {"scenes/series/points/processor_ms_per_s/high", "ms/s", "high end of that interval"},
};

constexpr Field kStress[] = {
    {"seed", "", "seed of the cases"},
    {"complete", "", "false: interrupted"},
    {"families/name", "", "family of hostile cases: 'vestige stress -v' says what each is"},
    {"families/variant", "", "what tells parts of a family apart; empty: it has none"},
    {"families/magnitude", "", "how far it goes: metres from the origin, a scale, and so on, by family"},
    {"families/detector", "", "the detector that was attacked"},
    {"families/method", "", "static, carried or ccd: how the body's own motion counts"},
    {"families/cases", "", "cases"},
    {"families/contacts", "", "of them, true contacts; all, in families that must hit"},
    {"families/false_negatives", "", "contacts that it missed"},
    {"families/false_positives", "", "contacts that are none"},
    {"families/wrong_winner", "", "contacts on another triangle, or with other bits of t"},
    {"families/wrong_triangle", "", "of wrong_winner: those on another triangle"},
    {"families/wrong_actuator", "", "contacts on the right triangle, with another actuator"},
    {"families/unsure", "", "pairs that needed exact arithmetic"},
    {"families/felt_share", "",
     "cases in which a user would feel the error, as a share: missed, false, or on another "
     "triangle or actuator"},
    {"families/felt_share_low", "", "low end of its 95 % Wilson interval"},
    {"families/felt_share_high", "", "high end of that interval"},
};

constexpr Field kStressRun[] = {
    {"seconds", "s", "how long the run took"},
};

constexpr Field kQuery[] = {
    {"detector", "", "what answered"},
    {"method", "", "static or ccd"},
    {"arithmetic", "", "double, or fp32: coordinates were rounded"},
    {"files/name", "", "file of queries"},
    {"files/truth", "", "file: the file's own answers are the truth; exact: the slow check's are"},
};

constexpr Field kQueryScore[] = {
    {"queries", "", "queries"},
    {"positives", "", "of them, true contacts"},
    {"false_positives", "", "contacts that are none"},
    {"false_negatives", "", "contacts that were missed"},
    {"decided_exactly", "", "queries that needed exact arithmetic"},
    {"median_us", "us", "median time of a query, thread CPU time"},
    {"p99_us", "us", "99 % of the queries took at most this"},
    {"max_us", "us", "the longest, each the least of three tries"},
};

/// The scenes of accuracy.json.
FieldGroups scenes() {
  return {{"avatar", avatar_fields()},
          {"", kAccuracy},
          {"scenes/truth/halved", kErrorEvents},
          {"scenes/truth/halved", kInstants},
          {"scenes/series", kErrorSeries},
          {"scenes/series/points", kErrorPoint},
          {"scenes/series/points", kErrorEvents},
          {"scenes/series/points", kInstants},
          {"scenes/series/points/within_tolerance", kErrorEvents}};
}

}  // namespace

FieldGroups accuracy_fields() {
  FieldGroups groups = scenes();
  groups.push_back({"", version_field()});
  return groups;
}

FieldGroups accuracy_run_fields() {
  return {{"", kErrorTimes}, {"scenes/series", kErrorSeries}, {"scenes/series/gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups accuracy_whole_fields() {
  FieldGroups groups = accuracy_fields();
  const FieldGroups run = {{"run", kErrorTimes},
                           {"run/scenes/series", kErrorSeries},
                           {"run/scenes/series/gl", gl_fields()},
                           {"run", origin_fields()}};
  groups.insert(groups.end(), run.begin(), run.end());
  return groups;
}

FieldGroups stress_fields() {
  return {{"", kStress}, {"", version_field()}};
}

FieldGroups stress_run_fields() {
  return {{"", kStressRun}, {"gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups stress_whole_fields() {
  return {{"", kStress}, {"", kStressRun}, {"gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups query_fields() {
  return {{"", kQuery}, {"files", kQueryScore}, {"total", kQueryScore}, {"", origin_fields()}};
}

}  // namespace vestige
