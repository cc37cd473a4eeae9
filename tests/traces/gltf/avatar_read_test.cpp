// Files of text and binary glTF, and the buffers beside them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::GltfBuilder;
using test::one_triangle;
using test::parse;
using test::primitive;
using test::skinned_triangle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(ReadAvatar, LeavesABinaryFileAsItIsWhateverItIsCalled) {
  const test::TemporaryFolder folder;
  const std::vector<std::byte> glb = one_triangle().glb();
  std::ofstream(folder / "a.vrm", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  EXPECT_EQ(read_avatar_glb(folder / "a.vrm"), glb);
}

/// The builder's file as text, with its data in `uri`.
std::string as_text(GltfBuilder builder, const std::string& uri) {
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", uri}}};
  builder.document["images"] = {{{"uri", "missing.png"}}};
  builder.document["textures"] = {{{"source", 0}}};
  return builder.document.dump(2);
}

TEST(ReadAvatar, PacksATextFileWithItsBuffersAndWithoutItsImages) {
  const test::TemporaryFolder folder;
  const GltfBuilder builder = skinned_triangle();
  std::ofstream(folder / "my data.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
  std::ofstream(folder / "a.gltf") << as_text(builder, "my%20data.bin");
  const std::vector<std::byte> glb = read_avatar_glb(folder / "a.gltf");
  EXPECT_EQ(glb, read_avatar_glb(folder / "a.gltf")) << "packing is deterministic";
  const std::string text(reinterpret_cast<const char*>(glb.data()), glb.size());
  EXPECT_THAT(text, ::testing::Not(HasSubstr("images")));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("uri")));
  EXPECT_EQ(parse_avatar_glb(glb, "a").position_bind, parse(builder).position_bind);
}

TEST(ReadAvatar, PacksDataUrisAndJoinsSeveralBuffers) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = one_triangle();
  // Three floats: 0, 0, 0; then the rest of the triangle from a second buffer through a sparse accessor.
  builder.document["buffers"] = {
      {{"byteLength", 1}, {"uri", "data:image/png;base64,AA=="}},
      {{"byteLength", 3}, {"uri", "data:application/octet-stream;base64,AAEC"}},
      {{"byteLength", 36},
       {"uri", "data:application/gltf-buffer;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
  builder.document["bufferViews"] = {
      {{"buffer", 0}, {"byteLength", 1}}, {{"buffer", 1}, {"byteLength", 3}}, {{"buffer", 2}, {"byteLength", 36}}};
  builder.document["accessors"] = {{{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                                   {{"bufferView", 1}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}}};
  primitive(builder)["indices"] = 1;
  std::ofstream(folder / "a.gltf") << builder.document.dump();
  const Avatar avatar = parse_avatar_glb(read_avatar_glb(folder / "a.gltf"), "a.gltf");
  EXPECT_THAT(avatar.position_bind, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(avatar.triangles, ElementsAre(glm::uvec3(0, 1, 2)));
}

TEST(ReadAvatar, TakesATextFileWhoseImageLeavesItsBufferAsItTakesABinaryOne) {
  GltfBuilder builder = one_triangle();
  builder.document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 30}, {"byteLength", 99}});
  builder.document["images"] = {{{"bufferView", 1}, {"mimeType", "image/png"}}};
  EXPECT_THAT(parse(builder).triangles, SizeIs(1));
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.gltf") << as_text(
      builder, "data:application/gltf-buffer;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA");
  EXPECT_EQ(parse_avatar_glb(read_avatar_glb(folder / "a.gltf"), "a").position_bind, parse(builder).position_bind);
}

}  // namespace
}  // namespace vestige
