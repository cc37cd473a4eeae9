#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kContacts[] = {
    {"frame", "", "number of the frame in the trace"},
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"collider", "", "id of the collider in the trace"},
    {"triangle", "", "triangle of the avatar, from 0 on: glTF's triangles in node, primitive, index order"},
    {"t", "", "when within the frame's step: 0 at its start (the frame before), 1 at its end"},
    {"u", "", "weight of the triangle's second vertex, 0 to 1"},
    {"v", "", "weight of the triangle's third vertex, 0 to 1"},
    {"texture_u", "", "texture coordinate, as the avatar has it: not wrapped into 0 to 1"},
    {"texture_v", "", "texture coordinate, as the avatar has it: not wrapped into 0 to 1"},
    {"actuator", "", "actuator of the skin there, numbered from 1 on as in the map's JSON; 0: no actuator covers it"},
    {"side", "", "+1: the collider enters through the triangle's front; -1: it leaves; 0: it moves in its plane"},
    {"x", "m", "place of the contact in the world"},
    {"y", "m", "place of the contact in the world; up"},
    {"z", "m", "place of the contact in the world"},
    {"depth", "m", "how deep the sphere is in the body at the frame's end, 0 to 2 r; only if colliders have a radius"},
    {"avatar", "", "person who was touched, from 1 on; only in a trace of several people"},
};

constexpr Field kTexture[] = {
    {"actuator", "", "actuator of the contact, from 1 on; 0: no actuator covers the skin there; +inf: no contact"},
    {"t", "", "when within the frame's step, 0 to 1; +inf: no contact"},
    {"triangle", "", "triangle of the avatar, from 0 on; 4294967295 (0xFFFFFFFF): no contact"},
    {"u", "", "weight of the triangle's second vertex, 0 to 1; +inf: no contact"},
    {"v", "", "weight of the triangle's third vertex, 0 to 1; +inf: no contact"},
    {"texture_u", "", "texture coordinate, not wrapped; +inf: no contact"},
    {"texture_v", "", "texture coordinate, not wrapped; +inf: no contact"},
    {"x", "m", "place of the contact in the world; +inf: no contact"},
    {"y", "m", "place of the contact in the world; up; +inf: no contact"},
    {"z", "m", "place of the contact in the world; +inf: no contact"},
    {"speed", "m/s", "speed of the collider along the triangle's normal, 0 or more; +inf: no contact"},
    {"side", "", "+1 entering, -1 leaving, 0 in the triangle's plane; +inf: no contact"},
    {"pressure", "", "pressure for a pneumatic cell, from the speed: 0 to 1; +inf: no contact"},
    {"depth", "m", "how deep a sphere is in the body at the frame's end; 0 for a point; +inf: no contact"},
};

constexpr Field kTimeline[] = {
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"actuator_*", "", "duty of that actuator from this frame on: 0 (off) to 255 (full)"},
};

// ISO/IEC 23090-31.
constexpr Field kHjif[] = {
    {"version", "", "edition of the format"},
    {"profile", "", "which part of the format is used"},
    {"level", "", "how demanding the file is, by the format"},
    {"date", "", "when the file was written, UTC"},
    {"description", "", "what wrote it, and how long it is"},
    {"timescale", "1/s", "units of time in one second: 1000, so times are milliseconds"},
    {"avatars/*", "", "required by the format; says nothing of our bodies"},
    {"perceptions/channels/id", "", "actuator, from 0 on"},
    {"perceptions/channels/description", "", "name of the actuator"},
    {"perceptions/channels/bands/effects/keyframes/relative_position", "ms", "time, from the start"},
    {"perceptions/channels/bands/effects/keyframes/amplitude_modulation", "",
     "duty at that time, 0 to 1; linear in between"},
    {"perceptions/*", "", "constant in our files"},
    {"syncs", "", "empty in our files"},
};

constexpr Field kTact[] = {
    {"intervalMillis", "ms", "time from one entry of feedback to the next"},
    {"size", "", "motors of one side of the vest"},
    {"name", "", "name of this file, without .tact"},
    {"feedback/*/position", "", "side of the vest: VestFront or VestBack; feedback's names are times (ms)"},
    {"feedback/*/mode", "", "DOT_MODE: a value for each motor"},
    {"feedback/*/values", "%", "level of each motor of that side, 0 to 100"},
    {"feedback/*/texture", "", "constant in our files"},
    {"durationMillis", "ms", "length of the timeline"},
};

constexpr Field kStreamLog[] = {
    {"time_s", "s", "when the state was due, in the time of the trace"},
    {"state", "", "sent, or superseded: a newer state replaced it before the line was free"},
    {"written_us", "us", "from the due time until the last byte was written; empty: never sent"},
    {"actuator_*", "", "duty of that actuator, 0 to 255"},
};

// What replay and stream say of the detector that ran.
constexpr Field kRun[] = {
    {"trace", "", "the trace that was read"},
    {"detector", "", "the detector that ran"},
    {"approximate", "", "true: simpler shapes stood for the skin"},
    {"triangles_kept", "", "triangles of the simpler mesh; only with decimated"},
    {"frames", "", "frames that the detector ran on"},
    {"contacts", "", "contacts in all frames, on skin with and without an actuator"},
};

constexpr Field kView[] = {
    {"trace", "", "the trace that was read"},
    {"output", "", "the page"},
    {"frames", "", "frames of the page"},
    {"sides/title", "", "the map or the detector of a side; empty if there is one side"},
    {"sides/detector", "", "the detector that ran"},
    {"sides/contacts", "", "contacts in all frames, on skin with and without an actuator"},
    {"bytes", "bytes", "size of the page"},
    {"error_mm/skin", "mm", "how far skin is drawn from its place, at most"},
    {"error_mm/colliders", "mm", "how far a collider is drawn from its place, at most"},
    {"complete", "", "false: the trace is damaged"},
};

constexpr Field kViz[] = {
    {"trace", "", "the trace that was read"},
    {"output", "", "the trace that was written"},
    {"detector", "", "what found the contacts"},
    {"frames", "", "frames of the trace"},
    {"contacts", "", "contacts that were found"},
    {"bytes_before", "bytes", "size of the trace that was read"},
    {"bytes", "bytes", "size of the trace that was written"},
    {"complete", "", "false: the trace is damaged"},
};

// How `view` and `viz` find contacts.
constexpr Field kChoices[] = {
    {"method", "", "static, carried or ccd: how the body's own motion counts (CONTRACT)"},
    {"surface", "", "all: skin without an actuator hides what lies behind it; mapped: it does not"},
};

constexpr Field kLaw[] = {
    {"name", "", "intensity law"},
    {"hold_ms", "ms", "how long an actuator runs on after a contact"},
    {"full_speed_m_per_s", "m/s", "speed along the normal that drives an actuator fully; only with speed"},
    {"full_depth_mm", "mm", "depth that drives an actuator fully; only with depth and patch"},
    {"sigma_mm", "mm", "width of a contact along the skin; only with gaussian"},
    {"actuator", "", "the file of the actuator's model"},
};

constexpr Field kReplay[] = {
    {"complete", "", "false: the trace is damaged, or the run was interrupted"},
    {"ignores_radii", "", "true: the detector tested the paths of spheres' centres"},
    {"picked", "", "what --detector auto chose"},
    {"why", "", "why it chose that"},
    {"threads", "", "number of threads that detected"},
    {"method", "", "static, carried or ccd: how the body's own motion counts (CONTRACT)"},
    {"skip", "", "on: what cannot touch was skipped"},
    {"surface", "", "all: skin without an actuator hides what lies behind it; mapped: it does not"},
    {"hold_ms", "ms", "how long an actuator runs on after a contact"},
    {"map", "", "--map, as given"},
    {"map_at", "", "--map-at, as given"},
    {"triangles_left_out", "", "triangles that can fire nothing and were left out; only with --surface mapped"},
    {"frames_skipped", "", "frames that bounds alone showed to be without contact, once for each person"},
    {"colliders", "", "colliders of the trace"},
    {"unsure", "", "pairs that the filter passed to exact arithmetic"},
    {"texture_hash", "",
     "SHA-256 of all contacts' triangle, t and actuator; equal: equal to the bit; of several people SHA-256 of theirs"},
    {"contacts_hash", "",
     "SHA-256 of all contacts' frame, collider, triangle, t and actuator; equal to that of the live session which the "
     "trace records: it was felt so"},
    {"pairs_tested", "", "pairs of segment and triangle that were tested"},
    {"pairs_captured", "", "of them, pairs that shaders could not reject"},
    {"pairs_meeting", "", "of them, pairs that meet"},
    {"origin_changes", "", "how often the origin of computing followed the body, which had gone more than 2 m"},
    {"non_finite_frames", "",
     "poses with NaN or infinity, and in damaged traces of several people missing ones; they fire nothing"},
    {"non_finite_segments", "", "segments with such an end, once for each person; they fire nothing"},
    {"first_non_finite_frame", "", "the first frame with one of these; absent: none"},
    {"reading_s", "s", "reading the trace"},
    {"detection_s", "s",
     "detecting, with upload and read-back; of several threads all that they did, with reading and writing"},
    {"hz", "Hz", "frames / detection_s"},
    {"actuators/name", "", "name of an actuator of the map, in its order; of several people, that of the first"},
    {"actuators/contacts", "", "contacts on its region"},
    {"avatars/name", "", "the people of the trace, in its order; empty: one whom the trace does not name"},
    {"avatars/contacts", "", "contacts on this person"},
    {"avatars/texture_hash", "", "texture_hash of this person"},
    {"avatars/contacts_hash", "", "contacts_hash of this person"},
    {"avatars/non_finite_frames", "", "frames whose pose of this person is missing or has NaN or infinity"},
    {"avatars/actuators/name", "", "name of an actuator of this person's map, in its order"},
    {"avatars/actuators/contacts", "", "contacts on its region"},
    {"avatars/*", "", "as beside avatars or in avatar, of this person"},
    {"skinning/frames", "", "frames in which vertices were compared with skinning in double precision"},
    {"skinning/vertices", "", "vertices that were compared"},
    {"skinning/identical_to_cpu", "", "of them, those with the same bits as the CPU's; null: the CPU skinned them"},
    {"skinning/largest_error_m", "m", "largest distance from double precision"},
    {"skinning/largest_error_cpu_m", "m", "the same of the CPU's skinning in single precision"},
    {"skinning/height_m", "m", "longest side of the posed avatar's box"},
    {"skinning/largest_error_of_height", "", "largest_error_m / height_m"},
    {"verify/against", "", "what --verify compared with"},
    {"verify/expected", "", "contacts of the other run"},
    {"verify/differing", "", "missing + extra + other_triangle + other_actuator; 0: they agree"},
    {"verify/missing", "", "contacts of the other run that this one lacks"},
    {"verify/extra", "", "contacts that only this run has"},
    {"verify/other_triangle", "", "contacts of both, on different triangles"},
    {"verify/other_actuator", "", "contacts on the same triangle, with different actuators"},
    {"verify/other_t", "", "contacts on the same triangle whose t differs in its bits"},
    {"verify/largest_t_difference", "", "largest difference of t on the same triangle"},
};

constexpr Field kStream[] = {
    {"complete", "", "false: interrupted before the end, without --loop, or the link was lost"},
    {"loops", "", "how often the trace was played to its end"},
    {"duration_s", "s", "length of the playback"},
    {"missed_deadlines", "", "frames that were ready only after they were due"},
    {"most_late_s", "s", "largest delay of a frame"},
    {"avatars/name", "", "the people of the trace, in its order; empty: one whom the trace does not name"},
    {"avatars/link", "", "null: this person had no --port"},
    {"avatars/*", "",
     "as beside avatars, of this person; there, all people are counted together, and law and link are the first one's"},
    {"unsent", "", "frames that were not sent, since there was no route to the host; only over VMC"},
    {"poses_left_out", "", "poses that no message can say: not finite, or beyond 1e9 m; only over VMC"},
    {"colliders_left_out", "", "colliders that no message can say in some frame; only over VMC"},
    {"deviation_m", "m", "most that the skin as sent lies from the trace's, an upper bound; only over VMC"},
};

/// What `stream` and `live` say of what was sent.
constexpr Field kSent[] = {
    {"sent", "", "frames passed to the system: changes, refreshes, and those that switch off"},
    {"changes", "", "states that differ from the one before"},
    {"superseded", "", "changes that a newer one replaced before the line was free"},
    {"acknowledged", "", "frames that the board answered"},
    {"off_sent", "", "true: the frame that switches everything off was sent at the end"},
    {"off_acknowledged", "", "true: the board acknowledged it"},
    {"zeros_acknowledged", "", "true: the board acknowledged levels of 0 before it"},
    {"most_unanswered", "", "most frames under way at once; 0: the port gives no answers"},
    {"fail_safes", "", "answers that say that the board had switched itself off"},
    {"output_failures", "", "answers that say that the chips which drive the motors did not answer the board"},
    {"overruns", "", "answers that say that the board had lost bytes"},
    {"receive_errors", "", "damaged frames, as the board counts them"},
    {"links_lost", "", "how often the link was lost"},
    {"maps_reloaded", "", "how often a changed map was read again"},
    {"floor_us", "us", "least time that the sender leaves between two frames; of several vests, the first one's"},
    {"latency_us/written/*", "us",
     "from a change, over VMC from a frame's due time, until its last byte was written: median, 95 %, 99 %, most; "
     "null: "
     "no changes"},
    {"latency_us/acknowledged/*", "us", "from a change until its answer: median, 95 %, 99 %, most; null: no answers"},
};

constexpr Field kLive[] = {
    {"frames_superseded", "", "whole frames that a newer one replaced before they were detected; 0 with --rate"},
    {"complete", "", "false: some input was left out, or the link was lost"},
    {"from", "", "--from, as given"},
    {"pose", "", "--pose, as given"},
    {"method", "", "static, carried or ccd: how the body's own motion counts (CONTRACT)"},
    {"colliders", "", "ids of colliders that came"},
    {"contacts_hash", "",
     "SHA-256 of all contacts' frame, collider, triangle, t and actuator; a replay of the recording has the same if "
     "detector, --method, map and --surface give the same contacts; of several vests SHA-256 of theirs"},
    {"duration_s", "s", "from the first frame to the end"},
    {"missed_deadlines", "", "frames left out since the next one was due already; only with --rate"},
    {"silences", "", "how often no whole frame came for --ttl, so that all actuators were switched off"},
    {"lost/malformed", "", "datagrams or lines that could not be read, or have numbers that are not finite"},
    {"lost/overflowed", "", "datagrams that the system discarded, as they came too fast"},
    {"lost/strangers", "", "datagrams of a second sender to a port"},
    {"lost/ids_clash", "", "true: colliders of one id came to several ports, and only one port's count"},
    {"latency/arrival_to_decoded/*", "ms", "from the system's time stamp of what completed a frame until it was read"},
    {"latency/arrival_to_detected/*", "ms", "until its contacts were found"},
    {"latency/arrival_to_written/*", "ms",
     "of changes, until the last byte was written; the line's own time (link/line_time_us) comes after that"},
    {"latency/arrival_to_acknowledged/*", "ms", "of changes, until the board's answer; null: no answers"},
    {"latency/pose_delay/*", "ms",
     "how late poses were shown, by --pose interpolate; a motion of the body waits for this besides"},
    {"latency/frame_interval/*", "ms",
     "between two frames, without a silence between them. Of each: p50_ms, p95_ms, p99_ms, max_ms, null if count is 0; "
     "and a histogram: counts[i] took up to up_to_ms[i] and longer than the class before, which is 1 % less"},
    {"real_time", "", "null: without --realtime"},
    {"real_time/priority", "", "priority by SCHED_FIFO; null: refused"},
    {"real_time/memory_locked", "", "true: no page leaves memory"},
    {"real_time/core", "", "core that the session is bound to; null: refused"},
    {"real_time/refused", "", "what the system refused, and what to grant"},
    {"recording", "", "null: without --record"},
    {"recording/files", "", "the files that were written"},
    {"recording/frames", "", "frames in them"},
    {"recording/bytes", "bytes", "their size"},
    {"recording/left_out", "", "frames that were felt and not recorded, since the disk did not keep up"},
    {"recording/complete", "", "true: all that was felt is recorded, within the limits of --ring"},
    {"avatars/name", "", "the people, in their order; empty: there is one"},
    {"avatars/link", "", "null: this person had no --port"},
    {"avatars/contacts_hash", "", "contacts_hash of this person"},
    {"avatars/*", "",
     "as beside avatars, of this person; there, all people are counted together, and law and link are the first one's"},
};

constexpr Field kLink[] = {
    {"port", "", "--port, as given"},
    {"datagrams", "", "datagrams sent; only over OSC and VMC"},
    {"texts", "", "requests sent to bHaptics' Player"},
    {"duration_ms", "ms", "how long bHaptics' Player plays a frame if no newer one comes"},
    {"frame_bytes", "bytes", "length of one frame on the line"},
    {"baud", "bit/s", "speed of the line"},
    {"line_time_us", "us", "how long one frame takes on the line"},
    {"ttl_ms", "ms",
     "if nothing comes for so long, the board switches itself off; over OSC, a process beside this one does"},
    {"xbee_api", "", "the XBee frame type that wraps each frame; empty: none"},
    {"board/version", "", "protocol version that the board greeted with"},
    {"board/actuators", "", "actuators that the board has"},
    {"bytes", "bytes", "bytes passed to the system"},
};

constexpr Field kVestCheck[] = {
    {"actuators", "", "actuators that were tried, one after another"},
    {"sent", "", "frames passed to the system"},
    {"acknowledged", "", "frames that the board answered"},
    {"receive_errors", "", "damaged frames, as the board counts them"},
    {"output_failures", "", "answers that say that the chips which drive the motors did not answer the board"},
    {"links_lost", "", "how often the link was lost"},
    {"off_sent", "", "true: the frame that switches everything off was sent at the end"},
    {"off_acknowledged", "", "true: the board acknowledged it"},
    {"zeros_acknowledged", "", "true: the board acknowledged levels of 0 before it"},
    {"good", "", "false: the vest does not hear everything (exit code 4)"},
};

}  // namespace

FieldGroups contact_fields() {
  return {{"", kContacts}};
}

FieldGroups texture_fields() {
  return {{"", kTexture}};
}

FieldGroups timeline_fields() {
  return {{"", kTimeline}};
}

FieldGroups hjif_fields() {
  return {{"", kHjif}};
}

FieldGroups tact_fields() {
  return {{"", kTact}};
}

FieldGroups stream_log_fields() {
  return {{"", kStreamLog}};
}

FieldGroups replay_fields() {
  return {{"", kRun},          {"", kReplay},        {"law", kLaw}, {"avatar", avatar_fields()},
          {"gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups stream_fields() {
  return {{"", kRun},      {"", kStream},       {"", kSent},          {"law", kLaw},
          {"link", kLink}, {"gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups live_fields() {
  return {{"", kLive},     {"", kRun},          {"", kSent},          {"law", kLaw},
          {"link", kLink}, {"gl", gl_fields()}, {"", origin_fields()}};
}

FieldGroups view_fields() {
  return {{"", kView}, {"", kChoices}, {"law", kLaw}, {"", origin_fields()}};
}

FieldGroups viz_fields() {
  return {{"", kViz}, {"", kChoices}, {"law", kLaw}, {"", origin_fields()}};
}

FieldGroups vest_check_fields() {
  return {{"", kVestCheck}, {"link", kLink}, {"", origin_fields()}};
}

}  // namespace vestige
