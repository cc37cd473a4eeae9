#pragma once

#include <lo/lo.h>

#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string_view>
#include <vector>

/// Messages that VR programs send, made with liblo.
namespace vestige::test {

struct FreeOscMessage {
  void operator()(void* message) const { lo_message_free(message); }
};
using OscBuilder = std::unique_ptr<void, FreeOscMessage>;

inline std::vector<std::byte> bytes_of(const char* address, const OscBuilder& message) {
  std::vector<std::byte> bytes(lo_message_length(message.get(), address));
  lo_message_serialise(message.get(), address, bytes.data(), nullptr);
  return bytes;
}

inline std::vector<std::byte> placement(const char* address, const char* name, const glm::dvec3& p,
                                        const glm::dquat& q) {
  OscBuilder message(lo_message_new());
  lo_message_add_string(message.get(), name);
  for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w})
    lo_message_add_float(message.get(), static_cast<float>(value));
  return bytes_of(address, message);
}

inline std::vector<std::byte> bone(const char* name, const glm::dquat& q, const glm::dvec3& p = glm::dvec3(0)) {
  return placement("/VMC/Ext/Bone/Pos", name, p, q);
}

inline std::vector<std::byte> collider(std::int32_t id, float x, float y, float z) {
  OscBuilder message(lo_message_new());
  lo_message_add_int32(message.get(), id);
  for (const float value : {x, y, z}) lo_message_add_float(message.get(), value);
  return bytes_of("/vestige/collider", message);
}

inline std::vector<std::byte> collider(std::int32_t id, float x, float y, float z, float radius_m) {
  OscBuilder message(lo_message_new());
  lo_message_add_int32(message.get(), id);
  for (const float value : {x, y, z, radius_m}) lo_message_add_float(message.get(), value);
  return bytes_of("/vestige/collider", message);
}

inline std::vector<std::byte> with_id(const char* address, std::int32_t id) {
  OscBuilder message(lo_message_new());
  lo_message_add_int32(message.get(), id);
  return bytes_of(address, message);
}

inline std::vector<std::byte> marker(const char* text) {
  OscBuilder message(lo_message_new());
  lo_message_add_string(message.get(), text);
  return bytes_of("/vestige/marker", message);
}

inline std::vector<std::byte> bundle(const std::vector<std::vector<std::byte>>& elements) {
  std::vector<std::byte> bytes;
  const std::string_view head("#bundle\0\0\0\0\0\0\0\0\1", 16);
  for (const char letter : head) bytes.push_back(static_cast<std::byte>(letter));
  for (const auto& element : elements) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<std::byte>(element.size() >> shift));
    bytes.insert(bytes.end(), element.begin(), element.end());
  }
  return bytes;
}

}  // namespace vestige::test
