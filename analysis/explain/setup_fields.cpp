#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kAvatarFile[] = {
    {"avatar", "", "the avatar's file"},
    {"welded_vertices", "", "vertices at different places, or of different joints"},
    {"animations/name", "", "name of an animation"},
    {"animations/duration_s", "s", "its length"},
    {"animations/morph_m", "m", "how far its morph targets move the skin at most, which is left out; 0: it has none"},
    {"influences", "", "most joints that move one vertex"},
    {"bounds/min", "m", "lowest x, y, z of the skin at rest"},
    {"bounds/max", "m", "highest x, y, z of the skin at rest"},
    {"uv_overlap_texels", "", "texels that several triangles cover, so that a map cannot tell them apart"},
    {"uv_covered_texels", "", "texels that a triangle covers"},
    {"uv_texture_side", "", "side of the texture that was counted on, in texels"},
    {"lies_deg", "°", "how far the head is from above the hips at rest; null: the avatar stands"},
    {"warnings", "", "what is odd about the file, a sentence each"},
};

constexpr Field kRegions[] = {
    {"regions/name", "", "name of the actuator; of several, what their names begin with"},
    {"regions/part", "", "parts of the body whose skin it is: 'vestige map parts' lists them"},
    {"regions/joints", "", "joints whose skin it is; * stands for any letters"},
    {"regions/below", "", "joints whose skin it is, and of what hangs on them"},
    {"regions/height", "", "from and to, as shares of the height of that skin: 0 is its lowest point, 1 its highest"},
    {"regions/height_m", "m", "from and to, above y = 0 at rest"},
    {"regions/angle", "°", "from and to, around the vertical through its middle: 0 front, 90 left"},
    {"regions/side", "", "front, back, left, right"},
    {"regions/grid/rows", "", "rows of actuators, from the top"},
    {"regions/grid/columns", "", "columns of actuators"},
    {"regions/grid/names", "", "their names, row by row"},
    {"regions/actuators/name", "", "name of an actuator of the region"},
    {"regions/actuators/position_m", "m", "where it sits on the body at rest: x, y, z"},
    {"regions/actuators/height", "", "where it sits: share of the height"},
    {"regions/actuators/angle", "°", "where it sits: around the vertical"},
    {"regions/radius_m", "m", "how far along the surface an actuator's skin goes at most; absent: no limit"},
    {"fires/*", "", "actuators that the region of that name drives, with gains; absent: its own"},
};

constexpr Field kMapSidecar[] = {
    {"actuators/grey", "", "grey of the actuator's region in the PNG; actuators count from 1 in this order"},
    {"facing", "", "axis along which the avatar looked at rest when the map was made"},
    {"triangles", "", "triangles of the avatar; only in a map with one texel for each"},
    {"skin", "", "digest of the skin that a map with one texel for each triangle belongs to"},
    {"actuators/name", "", "name of the actuator"},
    {"actuators/position_m", "m", "where it sits on the body at rest: x, y, z; laws between actuators need it"},
    {"fires/*", "", "actuators that the region of that name drives, with gains; absent: its own"},
};

constexpr Field kMapMake[] = {
    {"avatar", "", "the avatar's file"},
    {"parts_by", "", "joints, or proportions: what told the parts of the body"},
    {"facing", "", "axis along which the avatar looks at rest"},
    {"facing_by", "", "what told it"},
    {"per_triangle", "", "true: the map has one texel for each triangle"},
    {"side", "", "side of the map, in texels"},
    {"actuators/grey", "", "grey of the actuator's region in the PNG"},
    {"actuators/name", "", "name of the actuator"},
    {"actuators/position_m", "m", "where it sits on the body at rest: x, y, z"},
    {"actuators/area_m2", "m²", "skin of its region"},
    {"left_out", "", "regions without any skin on this body"},
    {"texels_in_conflict", "", "texels on which the skin of several regions lies; one of them has it"},
    {"triangles_left_out", "", "triangles of regions whose texels went to others"},
};

constexpr Field kMapCheck[] = {
    {"map", "", "the map's file"},
    {"avatar", "", "the avatar's file"},
    {"good", "", "false: the map has a fault (exit code 4)"},
    {"skin_m2", "m²", "the whole skin"},
    {"actuators/name", "", "name of an actuator"},
    {"actuators/texels", "", "texels of its region"},
    {"actuators/area_m2", "m²", "skin of its region"},
    {"actuators/pieces", "", "connected pieces of it, without specks"},
    {"actuators/shared_m2", "m²", "of it, skin whose texels also lie on skin far away"},
    {"actuators/mirrored_m2", "m²", "of that, skin on the mirrored place of the other half of the body"},
    {"findings/severity", "", "problem: results become wrong; note: it may be meant so"},
    {"findings/kind", "",
     "never_fires, shared_texels, mirrored_texels, split, soft_edges, position, "
     "texture_coordinates, wrong_side, facing"},
    {"findings/actuator", "", "actuator that it is about, from 1 on; 0: several, or the whole map"},
    {"findings/cause", "", "what is wrong"},
    {"findings/remedy", "", "what to do"},
};

constexpr Field kMapParts[] = {
    {"avatar", "", "the avatar's file"},
    {"parts_by", "", "joints, or proportions: what told the parts of the body"},
    {"parts_m2/*", "m²", "skin of that part of the body"},
    {"joints_m2/*", "m²", "skin that mostly follows that joint"},
};

constexpr Field kDevices[] = {
    {"contexts/context", "", "how the context is made: egl-device-N, egl-surfaceless, osmesa"},
    {"contexts/unusable", "", "why there is no such context"},
    {"contexts/limits/*", "", "that limit of the driver: 'vestige devices -v' says what each is"},
    {"contexts/geometry_refused", "", "why the detector geometry is refused; null: it is not"},
    {"contexts/paper_lacks", "", "what the detector paper lacks; null: nothing"},
    {"contexts/egl_device/number", "", "number for --device"},
    {"contexts/egl_device/software", "", "true: the device is the CPU"},
    {"contexts/egl_device/vendor", "", "who made the driver; empty: not said"},
    {"contexts/egl_device/drm_node", "", "its node; empty: not said"},
    {"contexts/egl_device/render_node", "", "its render node; empty: not said"},
    {"contexts/egl_device/extensions", "", "EGL extensions of the device"},
    {"contexts/egl_device/cuda_device", "", "its number in CUDA; null: none"},
};

constexpr Field kClaims[] = {
    {"claims/question", "", "what the claim answers"},
    {"claims/claim", "", "what the results show"},
    {"claims/command", "", "command that measured it"},
    {"claims/time", "", "when, UTC"},
    {"claims/machine", "", "machine and OpenGL renderer"},
    {"claims/commit", "", "commit of the program"},
    {"claims/file", "", "file that says so"},
};

constexpr Field kExplained[] = {
    {"kind", "", "kind of file"},
    {"file", "", "the file that was read; absent: every kind of file is listed"},
    {"what", "", "what is in it"},
    {"written_by", "", "command that writes it"},
    {"names/name", "", "a name in it; * stands for any text"},
    {"names/unit", "", "its unit; empty: none"},
    {"names/meaning", "", "its meaning"},
    {"unexplained", "", "names that this kind of file does not have (exit code 3)"},
};

}  // namespace

FieldGroups avatar_file_fields() {
  return {{"", kAvatarFile}, {"", avatar_fields()}, {"", origin_fields()}};
}

FieldGroups region_fields() {
  return {{"", kRegions}};
}

FieldGroups map_sidecar_fields() {
  return {{"", kMapSidecar}};
}

FieldGroups map_make_fields() {
  return {{"", kMapMake}, {"", origin_fields()}};
}

FieldGroups map_check_fields() {
  return {{"", kMapCheck}, {"", origin_fields()}};
}

FieldGroups map_parts_fields() {
  return {{"", kMapParts}, {"", origin_fields()}};
}

FieldGroups device_fields() {
  return {{"", kDevices}, {"auto", gl_fields()}, {"contexts", gl_fields()}, {"", origin_fields()}};
}

FieldGroups claim_fields() {
  return {{"", kClaims}, {"", origin_fields()}};
}

FieldGroups explain_fields() {
  return {{"files", kExplained}, {"", origin_fields()}};
}

}  // namespace vestige
