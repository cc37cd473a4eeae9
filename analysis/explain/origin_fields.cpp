#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

constexpr Field kOrigin[] = {
    {"schema_version", "", "grows when a field of this kind of file changes its meaning"},
    {"argv", "", "the command line, a text for each argument"},
    {"version", "", "version of Vestige"},
    {"commit", "", "commit that the program was built from"},
    {"dirty", "", "true: files had been changed since that commit"},
    {"time", "", "when the file was written, UTC"},
    {"machine/processor", "", "name of the processor"},
    {"machine/cores", "", "logical processors"},
    {"machine/memory_bytes", "bytes", "memory of the machine"},
    {"machine/system", "", "operating system and kernel"},
};

constexpr Field kGl[] = {
    {"renderer", "", "the driver's name for what draws: a GPU, or software such as llvmpipe"},
    {"version", "", "OpenGL's version, and the driver's"},
    {"context", "", "how the context was made: egl-device-N, egl-surfaceless, osmesa"},
    {"vendor", "", "who made the driver"},
    {"software", "", "true: the renderer runs on the CPU"},
    {"arithmetic/stage", "", "shader stage that was measured: vertex, geometry, compute"},
    {"arithmetic/rounding", "", "how sums and products are rounded: nearest even, toward zero, up, down, other"},
    {"arithmetic/keeps_denormal_operands", "", "false: an operand below 2^-126 counts as 0"},
    {"arithmetic/keeps_denormal_results", "", "false: a result below 2^-126 becomes 0"},
    {"arithmetic/contracts", "", "true: a * b + c is rounded only once"},
    {"arithmetic/division_error_ulp", "ulp",
     "largest error of a division that was seen; 0.5 at most if it rounds right"},
};

constexpr Field kAvatar[] = {
    {"vertices", "", "vertices of the skin"},
    {"triangles", "", "triangles of the skin"},
    {"joints", "", "joints that move the skin"},
    {"facing", "", "axis along which the avatar looks at rest: +z, -z, +x, -x"},
    {"facing_by", "", "what told it: trace, asked (a flag), sides (names of joints), feet, vrm, map, assumed"},
};

}  // namespace

std::span<const Field> origin_fields() {
  return kOrigin;
}

std::span<const Field> version_field() {
  return std::span(kOrigin).first<1>();
}

std::span<const Field> gl_fields() {
  return kGl;
}

std::span<const Field> avatar_fields() {
  return kAvatar;
}

}  // namespace vestige
