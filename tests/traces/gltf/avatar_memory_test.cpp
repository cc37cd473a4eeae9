#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <new>

#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/gltf/avatar_gltf.hpp"

// How much memory loading takes: this program counts what is on the heap, so it holds nothing but these tests.

namespace {

std::atomic<std::size_t> now_bytes = 0;
std::atomic<std::size_t> peak_bytes = 0;

void* counted(std::size_t size) {
  void* const block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  now_bytes += ::malloc_usable_size(block);
  peak_bytes = std::max(peak_bytes.load(), now_bytes.load());
  return block;
}

void release(void* block) noexcept {
  if (block != nullptr) now_bytes -= ::malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* block) noexcept {
  release(block);
}
void operator delete[](void* block) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  release(block);
}

namespace vestige {
namespace {

/// The most that reading and parsing `path` has on the heap at once, the file itself and the avatar included, divided
/// by `file_bytes`.
double growth(const std::filesystem::path& path, std::uintmax_t file_bytes) {
  const std::size_t before = now_bytes;
  peak_bytes = before;
  const std::vector<std::byte> glb = read_avatar_glb(path);
  const Avatar avatar = parse_avatar_glb(glb, "test");
  const double ratio = static_cast<double>(peak_bytes - before) / static_cast<double>(file_bytes);
  std::cout << path.filename().string() << ": " << file_bytes << " bytes, " << ratio << " times as much at most\n";
  return ratio;
}

TEST(AvatarMemory, StaysBelowFiveTimesTheFileForRealAvatars) {
  const std::filesystem::path folder = test::data("avatars");
  VESTIGE_REQUIRE_DATA(folder);
  std::size_t measured = 0;
  for (const char* part : {"avatars", "skin"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / part)) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() != ".glb" && path.extension() != ".gltf") continue;
      std::filesystem::path data = path;
      data.replace_extension(".bin");
      std::uintmax_t bytes = entry.file_size();
      if (path.extension() == ".gltf" && std::filesystem::exists(data)) bytes += std::filesystem::file_size(data);
      constexpr std::uintmax_t kTooSmallToSay = 30000;
      if (bytes < kTooSmallToSay) continue;
      EXPECT_LT(growth(path, bytes), 5) << path;
      ++measured;
    }
  EXPECT_GE(measured, 7U);
}

/// Two hundred animations of forty rotations with two keys each: nearly all of the file is JSON.
test::GltfBuilder many_animations() {
  test::GltfBuilder builder = test::skinned_triangle();
  constexpr int kJoints = 40;
  for (int joint = 0; joint < kJoints; ++joint) builder.document["nodes"].push_back({{"name", "joint"}});
  for (int animation = 0; animation < 200; ++animation) {
    nlohmann::json channels = nlohmann::json::array();
    nlohmann::json samplers = nlohmann::json::array();
    for (int joint = 0; joint < kJoints; ++joint) {
      const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
      const std::size_t output = builder.add("VEC4", std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0});
      channels.push_back({{"sampler", joint}, {"target", {{"node", 3 + joint}, {"path", "rotation"}}}});
      samplers.push_back({{"input", input}, {"output", output}});
    }
    builder.document["animations"].push_back({{"channels", channels}, {"samplers", samplers}});
  }
  return builder;
}

void write(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(AvatarMemory, StaysBelowFiveTimesTheFileWhereNearlyAllOfItIsJson) {
  const test::TemporaryFolder folder;
  test::GltfBuilder builder = many_animations();
  write(folder / "a.glb", builder.glb());
  EXPECT_LT(growth(folder / "a.glb", std::filesystem::file_size(folder / "a.glb")), 5);
  write(folder / "a.bin", builder.bin);
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "a.bin"}}};
  std::ofstream(folder / "a.gltf") << builder.document.dump();
  EXPECT_LT(growth(folder / "a.gltf", std::filesystem::file_size(folder / "a.gltf") + builder.bin.size()), 5);
}

TEST(AvatarMemory, StaysBelowFiveTimesTheFileWhereNearlyAllOfItIsADataUri) {
  const test::TemporaryFolder folder;
  test::GltfBuilder builder = test::one_triangle();
  builder.add("VEC3", std::vector<float>(300000));
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()},
                                  {"uri", "data:;base64," + std::string((builder.bin.size() + 2) / 3 * 4, 'A')}}};
  std::ofstream(folder / "a.gltf") << builder.document.dump();
  EXPECT_LT(growth(folder / "a.gltf", std::filesystem::file_size(folder / "a.gltf")), 5);
}

TEST(AvatarMemory, StaysSmallForImagesAndExtrasThatAreNotRead) {
  const test::TemporaryFolder folder;
  test::GltfBuilder builder = test::one_triangle();
  builder.document["images"] = {{{"uri", "data:image/png;base64," + std::string(1000000, 'A')}}};
  builder.document["buffers"] = {
      {{"byteLength", 36}, {"uri", "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
  for (int i = 0; i < 100000; ++i) builder.document["nodes"][0]["extras"]["list"].push_back({{"a", i}});
  std::ofstream(folder / "a.gltf") << builder.document.dump();
  EXPECT_LT(growth(folder / "a.gltf", std::filesystem::file_size(folder / "a.gltf")), 2);
}

}  // namespace
}  // namespace vestige
