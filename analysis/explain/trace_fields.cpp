#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kPoses[] = {
    {"frame", "", "number of the frame"},
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"origin_x", "m", "where the avatar's own origin stands in the world"},
    {"origin_y", "m", "where the avatar's own origin stands in the world; up"},
    {"origin_z", "m", "where the avatar's own origin stands in the world"},
    {"*.tx", "m", "translation of that node, relative to its parent"},
    {"*.ty", "m", "translation of that node, relative to its parent"},
    {"*.tz", "m", "translation of that node, relative to its parent"},
    {"*.rx", "", "rotation of that node, relative to its parent: a quaternion's x"},
    {"*.ry", "", "the quaternion's y"},
    {"*.rz", "", "the quaternion's z"},
    {"*.rw", "", "the quaternion's w"},
    {"*.sx", "", "scale of that node, relative to its parent"},
    {"*.sy", "", "scale of that node, relative to its parent"},
    {"*.sz", "", "scale of that node, relative to its parent"},
};

constexpr Field kColliders[] = {
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"frame", "", "number of the frame; a collider without a row in a frame is absent in it"},
    {"id", "", "id of the collider"},
    {"x", "m", "its place in the world"},
    {"y", "m", "its place in the world; up"},
    {"z", "m", "its place in the world"},
    {"radius_m", "m", "its radius, below 2^-30: a point; only in traces with radii"},
    {"owner", "", "person whose limb it is, from 1 on; 0: nobody's; only in traces of several people or with limbs"},
    {"teleported", "", "1: it jumped here, so that no segment leads to it; 0: it moved"},
};

constexpr Field kFrameLine[] = {
    {"frame", "", "number of the frame"},
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"pose/origin", "m", "where the avatar's own origin stands in the world: x, y, z; +Y is up"},
    {"pose/nodes", "",
     "for each node of the avatar: translation (m), rotation (x, y, z, w), scale, relative to its "
     "parent"},
    {"colliders/id", "", "id of a collider; one that is not listed is absent"},
    {"colliders/position", "m", "its place in the world: x, y, z"},
    {"colliders/radius", "m", "its radius; without it, it is a point"},
    {"colliders/owner", "", "person whose limb it is, from 1 on; without it, it is nobody's"},
    {"pose.*/origin", "m", "as pose, of a later person: pose.2 is the second's; without it, the pose is missing"},
    {"pose.*/nodes", "", "likewise"},
    {"teleported", "", "ids of colliders that jumped here, so that no segment leads to them"},
};

constexpr Field kTraceHdf5[] = {
    {"time_ns", "ns", "time of each frame, from the trace's start; int64"},
    {"frame", "", "number of each frame; uint64"},
    {"pose/origin", "m", "frames x 3, float64: where the avatar's own origin stands in the world; +Y is up"},
    {"pose/translation", "m", "frames x nodes x 3, float32: relative to the parent"},
    {"pose/rotation", "", "frames x nodes x 4, float32: x, y, z, w, relative to the parent"},
    {"pose/scale", "", "frames x nodes x 3, float32: relative to the parent"},
    {"pose/node_names", "", "names of the nodes, in the avatar's order"},
    {"colliders/id", "", "ids of the colliders, ascending: the columns of the other tables; uint32"},
    {"colliders/position", "m", "frames x colliders x 3, float64: place in the world; NaN: absent"},
    {"colliders/present", "", "frames x colliders, uint8: 0 absent, 1 present"},
    {"colliders/teleported", "", "frames x colliders, uint8: 1: it jumped here"},
    {"colliders/radius", "m",
     "frames x colliders, float32: below 2^-30: a point; NaN: absent; only in traces with radii"},
    {"colliders/owner", "",
     "person whose limb each collider is, from 1 on; 0: nobody's; uint16; only in traces of several people or with "
     "limbs"},
    {"avatar.glb", "", "the avatar's file, byte by byte"},
    {"actuator_map.png", "", "the actuator map's file, byte by byte"},
    {"actuator_map.json", "", "the actuator map's names, byte by byte"},
    {"pose.*/*", "", "as in pose, of a later person: pose.2 is the second's"},
    {"avatar.*.glb", "", "avatar of a later person"},
    {"actuator_map.*", "", "actuator map of a later person, and its names"},
    {"session", "", "group whose attributes are the trace's metadata: where the recording came from"},
};

constexpr Field kSessionFile[] = {
    {"facing", "", "axis along which the avatar looks at rest: +z, -z, +x, -x"},
    {"facing.*", "", "that of a later person: facing.2 is the second's"},
    {"name", "", "name of the person"},
    {"name.*", "", "name of a later person: name.2 is the second's"},
    {"radius", "m", "the --radius that every collider was given; mesh: by the meshes of a glTF's nodes"},
};

constexpr Field kRecord[] = {
    {"trace", "", "the trace that was written"},
    {"files", "", "all files of the recording, where it is split"},
    {"removed", "", "an earlier recording's files that were removed"},
    {"frames", "", "frames written"},
    {"recording_s", "s", "how long the recording took"},
    {"bytes", "bytes", "size of what was written"},
    {"avatars/name", "", "with several people: the name of each, in order"},
    {"lost/late", "", "live frames that were ready more than 20 ms late, or that found no room"},
    {"lost/malformed", "", "live messages that could not be read"},
    {"lost/overflowed", "", "datagrams that the operating system threw away"},
};

constexpr Field kImport[] = {
    {"trace", "", "the trace that was written"},
    {"frames", "", "frames written"},
    {"bytes", "bytes", "size of what was written"},
    {"avatars/name", "", "with several people: the name of each, in order"},
    {"motion/frames", "", "frames of the motion capture"},
    {"motion/frame_time_s", "s", "time from frame to frame"},
    {"motion/matched/joint", "", "joint of the motion capture"},
    {"motion/matched/node", "", "the avatar's node that follows it"},
    {"motion/matched/by", "", "name, or role: what they have in common"},
    {"motion/unmatched_joints", "", "joints of the motion capture that nothing follows"},
    {"motion/unmatched_nodes", "", "joints of the avatar that keep their rest"},
    {"motion/height", "", "height of the captured person, in the file's own unit"},
    {"motion/likely_unit", "", "the unit that this height suggests"},
    {"motion/metres_per_unit", "m", "one unit of the file, as it was taken"},
    {"motion/up", "", "the file's axis that is up"},
    {"motion/up_by", "", "what told it: flag, floor, rest, assumed"},
    {"motion/deviations/what", "", "where the avatar's pose differs most from the motion"},
    {"motion/deviations/degrees", "°", "by how much"},
    {"motion/deviations/frame", "", "in which frame"},
};

constexpr Field kInspect[] = {
    {"profile", "", "MCAP profile of the file; vestige: a trace"},
    {"library", "", "what wrote it"},
    {"bytes", "bytes", "size of the file"},
    {"messages", "", "messages in it"},
    {"channels/topic", "", "topic of a channel"},
    {"channels/encoding", "", "encoding of its messages"},
    {"channels/schema", "", "name of their schema; empty: none"},
    {"channels/messages", "", "messages of the channel"},
    {"channels/rate_hz", "Hz", "(messages - 1) / duration; 0: undefined"},
    {"chunks", "", "chunks of the file"},
    {"compression", "", "of the chunks: zstd, lz4, none, each once"},
    {"compressed_bytes", "bytes", "all chunks, compressed"},
    {"uncompressed_bytes", "bytes", "all chunks, expanded"},
    {"attachments/name", "", "name of an attachment"},
    {"attachments/bytes", "bytes", "its size"},
    {"attachments/sha256", "", "its SHA-256"},
    {"attachments/recorded", "", "whether that is the SHA-256 that was recorded; null: none was"},
    {"duration_s", "s", "from the first message to the last"},
    {"dropped", "", "messages that were lost while recording"},
    {"dropped_by_topic/*", "", "of them, those of one topic; beyond 1000 topics, (other topics)"},
    {"complete", "", "false: the file is damaged or cut"},
    {"recovered", "", "what 'vestige recover' noted in the file; empty: nothing"},
    {"people/name", "", "name of each person of a trace, in order; empty: nobody needed one"},
    {"people/avatar", "", "the attachment that is their avatar"},
    {"people/topic", "", "the topic of their poses"},
    {"people/facing", "", "axis along which their avatar looks at rest, as recorded; empty: not recorded"},
    {"warnings", "", "faults, a sentence each"},
    {"session/*", "", "the trace's metadata: where the recording came from"},
};

constexpr Field kDoctor[] = {
    {"file", "", "the file that was checked"},
    {"trace", "", "true: a trace; false: another MCAP file"},
    {"readable", "", "true: something in it can be read"},
    {"error", "", "why it could not be checked"},
    {"has_footer", "", "false: the file is cut"},
    {"messages", "", "messages that can be read"},
    {"chunks", "", "chunks"},
    {"damaged_chunks", "", "of them, damaged ones"},
    {"attachments", "", "attachments"},
    {"frames", "", "frames that readers deliver, up to the first one that they refuse"},
    {"dropped", "", "messages that were lost while recording"},
    {"attachment_checks/name", "", "name of an undamaged attachment"},
    {"attachment_checks/sha256", "", "its SHA-256"},
    {"attachment_checks/recorded", "", "whether that is the SHA-256 that was recorded; null: none was"},
    {"problem_count", "", "problems found"},
    {"problems/offset", "bytes", "where in the file one is; only the first thousand are listed"},
    {"problems/bytes", "bytes", "how long it is"},
    {"problems/offset_in_chunk", "bytes", "where in the expanded chunk; absent: not in a chunk"},
    {"problems/problem", "", "what is wrong"},
    {"problems/consequence", "", "what that means for readers"},
};

constexpr Field kRecover[] = {
    {"file", "", "the damaged file"},
    {"output", "", "the file that was written"},
    {"lost_something", "", "true: the new file lacks something (exit code 3)"},
    {"messages", "", "messages that were written"},
    {"messages_lost", "", "messages that are missing; null: the file does not say how many there were"},
    {"messages_left_out", "", "messages that contradict the rest, or whose channel is unknown"},
    {"messages_unverified", "", "of messages: those out of damaged chunks, which no CRC verifies"},
    {"chunks_whole", "", "intact chunks"},
    {"chunks_partly_lost", "", "chunks of which some messages could be read"},
    {"chunks_lost", "", "chunks of which nothing could be read"},
    {"attachments", "", "attachments that were written"},
    {"damaged_attachments", "", "names of damaged ones, written as NAME.damaged"},
    {"replaced/name", "", "an attachment that came from another file"},
    {"replaced/from", "", "that file"},
    {"replaced/recorded", "", "true: it is the recorded one, by its SHA-256"},
    {"replaced/left_out", "", "true: the other file has none, so it was left out"},
    {"metadata", "", "metadata records that were written"},
    {"bytes_lost", "bytes", "bytes that could not be used, or that follow the end of the file"},
    {"another_file_at", "bytes", "where a second MCAP file begins, which is left out; null: there is none"},
    {"unexplained_change", "", "true: a byte that no other CRC covers has changed"},
    {"repaired", "", "what was mended, a sentence each; the first 100"},
};

constexpr Field kRewriting[] = {
    {"file", "", "the file that was read"},
    {"output", "", "the file that was written"},
    {"messages", "", "messages that were written"},
    {"left_out", "", "messages that were left out"},
    {"start_s", "s", "log time of the first message that was kept; of a trace, from the start of the recording"},
    {"end_s", "s", "log time of the last one"},
    {"bytes_before", "bytes", "size of the file that was read"},
    {"bytes", "bytes", "size of the file that was written"},
    {"complete", "", "false: the file that was read is damaged"},
};

constexpr Field kMerge[] = {
    {"files", "", "the parts that were read"},
    {"output", "", "the file that was written"},
    {"messages", "", "messages that were written"},
    {"frames", "", "frames that were written"},
    {"duplicates", "", "messages that several parts have, written once"},
    {"missing_frames", "", "numbers between the first and the last frame that no part has"},
    {"complete", "", "false: a part is damaged"},
};

constexpr Field kViewerLayout[] = {
    {"layout/direction", "", "row: the body stands left of the other panels"},
    {"layout/*", "", "where the panels stand"},
    {"configById/*", "", "settings of a panel, as Foxglove and Lichtblick name them"},
    {"playbackConfig/*", "", "how it is played"},
    {"globalVariables", "", "none"},
    {"userNodes", "", "none"},
};

constexpr Field kCat[] = {
    {"file", "", "the file that was read"},
    {"messages", "", "messages that were printed"},
    {"complete", "", "false: the file is damaged"},
};

constexpr Field kExport[] = {
    {"trace", "", "the trace that was read"},
    {"format", "", "csv, ndjson, hdf5, gltf"},
    {"outputs", "", "the files that were written"},
    {"frames", "", "frames that were written"},
    {"frames_in_trace", "", "frames of the trace"},
    {"colliders", "", "colliders of the trace"},
    {"contacts", "", "contacts that were written; only with --contacts"},
    {"losses", "", "what the format cannot hold, a sentence each"},
    {"complete", "", "false: the trace is damaged"},
};

}  // namespace

FieldGroups pose_table_fields() {
  return {{"", kPoses}};
}

FieldGroups collider_table_fields() {
  return {{"", kColliders}};
}

FieldGroups frame_line_fields() {
  return {{"", kFrameLine}};
}

FieldGroups trace_hdf5_fields() {
  FieldGroups groups = {{"", kTraceHdf5}};
  for (const FieldGroup& contacts : contact_fields()) groups.push_back({"contacts", contacts.fields});
  return groups;
}

FieldGroups session_fields() {
  return {{"", kSessionFile}};
}

FieldGroups record_fields() {
  return {{"", kRecord}, {"avatar", avatar_fields()}, {"avatars", avatar_fields()}, {"", origin_fields()}};
}

FieldGroups import_fields() {
  return {{"", kImport}, {"avatar", avatar_fields()}, {"avatars", avatar_fields()}, {"", origin_fields()}};
}

FieldGroups inspect_fields() {
  return {{"", kInspect}, {"", origin_fields()}};
}

FieldGroups doctor_fields() {
  return {{"files", kDoctor}, {"", origin_fields()}};
}

FieldGroups recover_fields() {
  return {{"", kRecover}, {"", origin_fields()}};
}

FieldGroups rewriting_fields() {
  return {{"", kRewriting}, {"", origin_fields()}};
}

FieldGroups merge_fields() {
  return {{"", kMerge}, {"", origin_fields()}};
}

FieldGroups viewer_layout_fields() {
  return {{"", kViewerLayout}};
}

FieldGroups cat_fields() {
  return {{"", kCat}, {"", origin_fields()}};
}

FieldGroups export_fields() {
  return {{"", kExport}, {"", origin_fields()}};
}

}  // namespace vestige
