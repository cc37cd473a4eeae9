#pragma once

#include "analysis/explain/field.hpp"

namespace vestige {

// What stands in files, by topic. Each function returns the fields of one kind of file. The first field is one that
// every such file has.

/// What every result in JSON says of its origin (`provenance`).
std::span<const Field> origin_fields();
/// Of these, `schema_version` alone: what files with numbers only say.
std::span<const Field> version_field();
/// What results say of the OpenGL that they used (`to_json(GlInfo)`).
std::span<const Field> gl_fields();
/// What results say of their avatar (`to_json(Avatar)`).
std::span<const Field> avatar_fields();

// Detection, and what leaves for the vest.
FieldGroups contact_fields();
FieldGroups texture_fields();
FieldGroups timeline_fields();
FieldGroups hjif_fields();
FieldGroups tact_fields();
FieldGroups stream_log_fields();
FieldGroups replay_fields();
FieldGroups stream_fields();
FieldGroups live_fields();
FieldGroups view_fields();
FieldGroups viz_fields();
FieldGroups vest_check_fields();

// Frequency.
FieldGroups sweep_fields();
FieldGroups frame_time_fields();
FieldGroups growth_fields();
FieldGroups compare_fields();

// Run time against error.
FieldGroups accuracy_fields();
FieldGroups accuracy_run_fields();
FieldGroups accuracy_whole_fields();
FieldGroups stress_fields();
FieldGroups stress_run_fields();
FieldGroups stress_whole_fields();
FieldGroups query_fields();

// Batches.
FieldGroups score_table_fields();
FieldGroups score_fields();
FieldGroups ranking_table_fields();
FieldGroups scenario_ranking_table_fields();
FieldGroups ranking_fields();
FieldGroups batch_run_fields();
FieldGroups batch_item_fields();
FieldGroups batch_times_fields();
FieldGroups batch_contact_fields();

// Traces and what is done with them.
FieldGroups pose_table_fields();
FieldGroups collider_table_fields();
FieldGroups frame_line_fields();
FieldGroups trace_hdf5_fields();
FieldGroups session_fields();
FieldGroups record_fields();
FieldGroups import_fields();
FieldGroups inspect_fields();
FieldGroups doctor_fields();
FieldGroups recover_fields();
FieldGroups rewriting_fields();
FieldGroups merge_fields();
FieldGroups viewer_layout_fields();
FieldGroups cat_fields();
FieldGroups export_fields();

// Avatars, maps and machines.
FieldGroups avatar_file_fields();
FieldGroups region_fields();
FieldGroups map_sidecar_fields();
FieldGroups map_make_fields();
FieldGroups map_check_fields();
FieldGroups map_parts_fields();
FieldGroups device_fields();
FieldGroups claim_fields();
FieldGroups explain_fields();

}  // namespace vestige
