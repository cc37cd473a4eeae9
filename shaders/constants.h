// Shared by C++ and GLSL: the bindings of the shaders' buffers, attributes and planes.

#define VESTIGE_BINDING_PALETTE 0   // mat4 columns, one SkinMatrix for each palette entry
#define VESTIGE_BINDING_SEGMENTS 1  // one GpuSegment for each collider that has a segment

#define VESTIGE_BINDING_CAPTURED 2    // the pairs that the shaders could not reject
#define VESTIGE_BINDING_CANDIDATES 3  // touched meshlets, and the segments that may meet each (candidates.glsl)
#define VESTIGE_BINDING_QUESTIONS 4   // of the probe of the shaders' arithmetic

// Of cull.comp, and of candidates.comp after it. No driver need have more than the bindings 0 to 7.
#define VESTIGE_BINDING_FOUND 0           // the slots, in memory that the CPU reads
#define VESTIGE_BINDING_CULLED_CORNERS 2  // of the touched meshlets
#define VESTIGE_BINDING_COUNTS 4          // of slots and of what was done
#define VESTIGE_BINDING_MESHLETS 5        // the boxes and the corners of each
#define VESTIGE_BINDING_REST_BOXES 6
#define VESTIGE_BINDING_VERTICES 7

#define VESTIGE_ATTRIBUTE_POSITION 0            // vec3, bind pose
#define VESTIGE_ATTRIBUTE_TEXTURE_COORDINATE 1  // vec2
#define VESTIGE_ATTRIBUTE_PALETTE_0 2           // uvec4, influences 0 to 3
#define VESTIGE_ATTRIBUTE_PALETTE_1 3           // uvec4, influences 4 to 7
#define VESTIGE_ATTRIBUTE_WEIGHT_0 4            // vec4
#define VESTIGE_ATTRIBUTE_WEIGHT_1 5            // vec4

#define VESTIGE_TEXTURE_ACTUATOR_MAP 0
#define VESTIGE_TEXTURE_CORNERS 1

#define VESTIGE_UNIFORM_SEGMENT_COUNT 0    // int
#define VESTIGE_UNIFORM_TEXTURE_COLUMNS 1  // int, of the collision texture
#define VESTIGE_UNIFORM_TEXTURE_ROWS 2     // int
#define VESTIGE_UNIFORM_FRAMES_PER_S 3     // float, 1 / the frame's duration; 0 in the first frame
#define VESTIGE_UNIFORM_FIRST_SEGMENT 4    // int, number of the first segment of the bound block
#define VESTIGE_UNIFORM_PALETTE_SIZE 5     // uint, entries; those of the previous frame follow them
#define VESTIGE_UNIFORM_LEAST_RADIUS 6     // float, metres: the error of a skinned vertex by flushed denormals
#define VESTIGE_UNIFORM_WORLD_TO_CLIP 7    // mat4, for the drawn scene
#define VESTIGE_UNIFORM_FIRST_TRIANGLE 8   // int, number of the first triangle of the draw
#define VESTIGE_UNIFORM_FIRST_SLOT 9       // uint, number of the bound block's first slot
#define VESTIGE_UNIFORM_SLOT_COUNT 10      // uint, of the bound block
#define VESTIGE_UNIFORM_CORNER_ERROR 11    // float, metres: how far a corner may be from the CPU's
#define VESTIGE_UNIFORM_BOX_MARGIN 12      // float, metres: how far skin may be beyond a meshlet's box

// How a collider's motion and the moving skin meet (detector/method.hpp).
#define VESTIGE_METHOD_STATIC 0
#define VESTIGE_METHOD_CARRIED 1
#define VESTIGE_METHOD_CCD 2

// The planes of the collision texture. Only the requested planes are compiled in, attached and read back. Each plane is
// its own colour attachment, in this order.
#define VESTIGE_PLANE_ACTUATOR 0            // R32F, the paper's plane: actuator number, +inf without contact
#define VESTIGE_PLANE_TIME 1                // R32F
#define VESTIGE_PLANE_TRIANGLE 2            // R32UI
#define VESTIGE_PLANE_BARYCENTRIC 3         // RG32F
#define VESTIGE_PLANE_TEXTURE_COORDINATE 4  // RG32F
#define VESTIGE_PLANE_POSITION 5            // RGBA32F, the last component unused
#define VESTIGE_PLANE_SPEED 6               // R32F
#define VESTIGE_PLANE_SIDE 7                // R32F
