# Headers that most sources include, and that cost most to read, are read once for all units. A source still includes
# what it uses: .ci/alone reads each one without these. gcc 12 crashes if a unit has another -O level than its precompiled
# headers, so cold rooms (cmake/rooms.cmake) have their own.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
foreach(name vestige_precompiled vestige_precompiled_cold)
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  target_link_libraries(${name} PRIVATE vestige_options fmt::fmt)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <set> <span> <string> <string_view>
    <vector> <fmt/format.h> <glm/geometric.hpp> <glm/gtc/quaternion.hpp> <glm/mat4x4.hpp> <glm/vec3.hpp>
    <nlohmann/json.hpp>)
endforeach()
target_compile_options(vestige_precompiled_cold PRIVATE ${vestige_cold_level})
