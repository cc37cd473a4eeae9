// Our traces, read by the reference reader: npm's @mcap/core, fetched into tests/npm/node_modules when it is not there
// yet.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/npm.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/repair/recover.hpp"

namespace vestige {
namespace {

nlohmann::json seen_by_reference_reader(const std::filesystem::path& trace) {
  return nlohmann::json::parse(test::run_node("read_trace.mjs", trace));
}

TEST(ReferenceReader, SeesAllThatIsInATrace) {
  VESTIGE_REQUIRE_DATA(test::npm_package("@mcap/core"));
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(test::kNodes);
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    TraceWriterOptions options = test::steady_options(5000);
    options.compression = compression;
    options.overwrite = Overwrite::kAllow;
    {
      TraceWriter writer(folder / "a.mcap", {{"argv", "vestige record"}},
                         {{test::skeleton(test::kNodes), {.avatar_glb = glb, .actuator_map_json = "{}"}}}, options);
      for (std::uint64_t i = 0; i < 100; ++i) writer.write(test::frame(i, test::kNodes, test::kColliders));
      writer.note_marker("here");
      writer.finish();
    }
    const nlohmann::json seen = seen_by_reference_reader(folder / "a.mcap");
    EXPECT_EQ(seen["done"], true);
    EXPECT_EQ(seen["profile"], "vestige");
    EXPECT_EQ(seen["streamed"], seen["indexed"]);
    EXPECT_EQ(seen["indexed"]["/pose"], 100);
    EXPECT_EQ(seen["indexed"]["/colliders"], 100);
    EXPECT_EQ(seen["indexed"]["/events"], 1);
    EXPECT_EQ(seen["messageCount"], 201);
    EXPECT_EQ(seen["lastSequence"], 99);
    EXPECT_EQ(seen["channels"]["/pose"]["encoding"], "flatbuffer");
    EXPECT_EQ(nlohmann::json::parse(seen["channels"]["/pose"]["metadata"]["nodes"].get<std::string>()).size(), 3U);
    EXPECT_EQ(seen["schemas"]["vestige.trace.PoseFrame"]["encoding"], "flatbuffer");
    EXPECT_GT(seen["schemas"]["vestige.trace.ColliderFrame"]["bytes"], 100);
    EXPECT_EQ(seen["attachments"]["avatar.glb"], glb.size());
    EXPECT_EQ(seen["attachments"]["actuator_map.json"], 2);
    EXPECT_EQ(seen["metadata"]["session"]["argv"], "vestige record");
  }
}

TEST(ReferenceReader, OpensWhatIsRecoveredFromACutTrace) {
  VESTIGE_REQUIRE_DATA(test::npm_package("@mcap/core"));
  const test::TemporaryFolder folder;
  const test::SmallTrace trace = test::small_trace(folder, Compression::kZstd);
  const mcap::MemorySource source(std::span(trace.bytes).first(static_cast<std::size_t>(trace.chunks[2].end() + 5)));
  OutputFile file(folder / "mended.mcap", Overwrite::kRefuse);
  recover_mcap(
      source, [&](mcap::Bytes bytes) { file.write(bytes); }, [](double) { return true; });
  file.commit();
  const nlohmann::json seen = seen_by_reference_reader(folder / "mended.mcap");
  EXPECT_EQ(seen["done"], true);
  EXPECT_EQ(seen["profile"], "vestige");
  EXPECT_EQ(seen["streamed"], seen["indexed"]);
  EXPECT_EQ(seen["indexed"]["/pose"], 3 * test::kFramesInAChunk);
  EXPECT_EQ(seen["attachments"].size(), 2U);
}

}  // namespace
}  // namespace vestige
