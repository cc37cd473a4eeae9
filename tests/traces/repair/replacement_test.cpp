// Which attachments of a damaged trace `recover` replaces, and by what.

#include "traces/repair/replacement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/repair/recover.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {
namespace {

using test::kFrames;
using test::kNodes;
using ::testing::HasSubstr;

Substitutes avatar(std::vector<std::byte> glb) {
  Substitutes substitutes;
  substitutes.avatars = {{.from = "new.glb", .files = {{"avatar.glb", std::move(glb)}}}};
  return substitutes;
}

/// The same nodes, but other bytes.
std::vector<std::byte> other_glb() {
  std::vector<std::byte> glb = test::skeleton_glb(kNodes);
  const std::string_view version = R"("2.0")";
  const auto bytes = std::as_bytes(std::span(version));
  *(std::search(glb.begin(), glb.end(), bytes.begin(), bytes.end()) + 3) = std::byte{'1'};
  return glb;
}

class Replacing : public ::testing::Test {
 protected:
  void SetUp() override { flip(test::skeleton_glb(kNodes), 30); }

  void flip(std::span<const std::byte> what, std::ptrdiff_t at) {
    const auto place = std::search(bytes_.begin(), bytes_.end(), what.begin(), what.end());
    ASSERT_NE(place, bytes_.end());
    *(place + at) ^= std::byte{1};
  }
  void flip_all(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    for (auto from = bytes_.begin();;) {
      from = std::search(from, bytes_.end(), bytes.begin(), bytes.end());
      if (from == bytes_.end()) return;
      *from ^= std::byte{1};
    }
  }

  /// Recovers; returns the reason where that is refused.
  std::string recover(const Substitutes& substitutes) {
    const mcap::MemorySource source(bytes_);
    out_.clear();
    try {
      recovery_ = recover_mcap(source, test::into(out_), test::go_on, substitutes);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }

  const test::TemporaryFolder folder_;
  std::vector<std::byte> bytes_ = test::small_trace(folder_, Compression::kZstd).bytes;
  std::vector<std::byte> out_;
  Recovery recovery_;
};

TEST_F(Replacing, TheRecordedAvatarMakesTheTraceWhole) {
  EXPECT_EQ(recover(avatar(test::skeleton_glb(kNodes))), "");
  EXPECT_FALSE(recovery_.lost_something());
  const test::MemoryFile file;
  file.assign(out_);
  TraceReader reader(file.path());
  EXPECT_EQ(test::read_frames(reader).size(), kFrames);
  EXPECT_TRUE(reader.complete()) << reader.warnings().front();
  EXPECT_EQ(reader.recovered(), "");
  EXPECT_TRUE(std::ranges::equal(reader.people().front().avatar_glb, test::skeleton_glb(kNodes)));
}

TEST_F(Replacing, EverySummaryHasTheRecordedHashes) {
  const mcap::MemorySource source(bytes_);
  const mcap::SummaryResult result = mcap::read_summary(source);
  ASSERT_TRUE(result.summary);
  const auto pose = std::ranges::find(result.summary->channels, "/pose", &mcap::Channel::topic);
  ASSERT_NE(pose, result.summary->channels.end());
  EXPECT_EQ(pose->metadata.at("sha256:avatar.glb"), sha256_hex(test::skeleton_glb(kNodes)));
  EXPECT_EQ(pose->metadata.at("sha256:actuator_map.json"), sha256_hex(std::as_bytes(std::span("{}", 2))));
}

TEST_F(Replacing, AnAttachmentThatIsGoneIsPutIn) {
  const mcap::MemorySource source(bytes_);
  mcap::RecordWalker walker(source);
  mcap::RecordPlace place;
  while (walker.next(place) && place.opcode != mcap::Opcode::kAttachment) continue;
  bytes_[place.offset] = std::byte{0x85};  // a private record, which every reader passes over
  EXPECT_EQ(recover(avatar(test::skeleton_glb(kNodes))), "");
  EXPECT_EQ(recovery_.replaced.size(), 1U);
  const test::MemoryFile file;
  file.assign(out_);
  TraceReader reader(file.path());
  EXPECT_EQ(test::read_frames(reader).size(), kFrames);
  EXPECT_TRUE(reader.complete());
}

TEST_F(Replacing, AnAvatarWithOtherNodesIsRefusedEvenIfAnyIsAccepted) {
  Substitutes substitutes = avatar(test::skeleton_glb(kNodes + 1));
  substitutes.refusal.reset();
  EXPECT_THAT(recover(substitutes), HasSubstr("new.glb: has 4 nodes, but the poses of the trace have 3"));
}

TEST_F(Replacing, WithoutAnyRecordItTakesConsent) {
  flip_all("sha256:avatar.glb");
  Substitutes substitutes = avatar(test::skeleton_glb(kNodes));
  EXPECT_THAT(recover(substitutes), HasSubstr("nothing can check this one"));
  substitutes.refusal.reset();
  EXPECT_EQ(recover(substitutes), "");
  EXPECT_TRUE(recovery_.lost_something());
  const test::MemoryFile file;
  file.assign(out_);
  TraceReader reader(file.path());
  EXPECT_EQ(test::read_frames(reader).size(), kFrames);
  EXPECT_FALSE(reader.complete());
  EXPECT_THAT(reader.warnings(), ::testing::Contains(HasSubstr("`vestige recover --force` put in the attachment")));
}

TEST_F(Replacing, OneOfTwoRecordsIsEnough) {
  const std::string sha256 = sha256_hex(test::skeleton_glb(kNodes));
  flip(std::as_bytes(std::span(sha256)), 5);  // the first one, which is that of the session
  EXPECT_EQ(recover(avatar(test::skeleton_glb(kNodes))), "");
  EXPECT_THAT(recover(avatar(other_glb())), HasSubstr("is not the avatar.glb that memory was recorded with"));
}

TEST_F(Replacing, WhatIsReplacedTwiceIsSaidAsItIsInTheEnd) {
  Substitutes substitutes = avatar(other_glb());
  substitutes.refusal.reset();
  ASSERT_EQ(recover(substitutes), "");
  EXPECT_TRUE(recovery_.lost_something());
  EXPECT_EQ(recovery_.damaged_attachments, std::vector<std::string>{"avatar.glb"});
  bytes_ = out_;
  ASSERT_EQ(recover({}), "");
  const test::MemoryFile file;
  file.assign(out_);
  EXPECT_THAT(TraceReader(file.path()).warnings().at(0), HasSubstr("put another one in its place"));
  ASSERT_EQ(recover(avatar(test::skeleton_glb(kNodes))), "");
  file.assign(out_);
  EXPECT_TRUE(TraceReader(file.path()).complete());
}

TEST_F(Replacing, AFileThatIsNoTraceNeedsNoAvatar) {
  bytes_.clear();
  mcap::Writer writer(test::into(bytes_), {}, {});
  writer.write(mcap::Channel{.id = 1, .schema_id = 0, .topic = "/a", .message_encoding = "json", .metadata = {}});
  writer.write(mcap::Message{.channel_id = 1, .sequence = 0, .log_time = 0, .publish_time = 0, .data = {}});
  writer.finish();
  EXPECT_THAT(recover(avatar(test::skeleton_glb(kNodes))), HasSubstr("is not a trace of vestige"));
}

}  // namespace
}  // namespace vestige
