// Traces of several people, and of colliders that belong to somebody.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/message_of.hpp"
#include "tests/support/process.hpp"
#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/repair/recover.hpp"
#include "traces/repair/trace_check.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using trace_format::AttachmentKind;
using trace_format::Stream;

constexpr std::size_t kOtherNodes = 4;

/// Frame `index` of two people, of whom the second has a limb.
TraceFrame frame_of_two(std::uint64_t index) {
  TraceFrame frame = test::frame(index, test::kNodes, test::kColliders);
  frame.poses.push_back(test::frame(index + 50, kOtherNodes, 0).poses.front());
  frame.colliders.push_back({.id = 1000, .position_m = {0.1, 0.2, 0.3}, .radius_m = 0.04F, .owner = 2});
  return frame;
}

void write_two(const std::filesystem::path& path, std::uint64_t frames, Compression compression = Compression::kZstd) {
  TraceWriterOptions options = test::steady_options(2000);
  options.compression = compression;
  const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
  const std::vector<std::byte> other = test::skeleton_glb(kOtherNodes);
  const Avatar avatar = test::skeleton(test::kNodes);
  Avatar turned = test::skeleton(kOtherNodes);
  set_facing(turned.facing, Facing::kMinusZ, AvatarFacing::By::kAsked);
  TraceWriter writer(
      path, {{"argv", "test"}},
      {{avatar, {.avatar_glb = glb}, "ann"}, {turned, {.avatar_glb = other, .actuator_map_json = "{}"}, "bob"}},
      options);
  for (std::uint64_t i = 0; i < frames; ++i) writer.write(frame_of_two(i));
  writer.finish();
}

/// A trace of two people written record by record, so that it may say what no recorder of ours would.
class ForgedPeople {
 public:
  explicit ForgedPeople(int version = trace_format::kPeopleVersion)
      : writer_(test::into(bytes_), {.profile = "vestige", .library = "forged"}, {}) {
    writer_.write(mcap::Metadata{.name = "session", .metadata = {{"format_version", std::to_string(version)}}});
    for (const char* name : {"avatar.glb", "avatar.2.glb"})
      writer_.write(mcap::Attachment{.name = name, .media_type = "", .data = glb_});
    for (const Stream stream : {Stream::kPose, Stream::kColliders, Stream::kEvents})
      writer_.write(trace_format::schema_of(stream, version));
    for (const std::size_t person : {0U, 1U}) {
      mcap::Channel channel = trace_format::channel_of(Stream::kPose, version, person);
      channel.metadata["nodes"] = R"(["a","b","c"])";
      writer_.write(channel);
    }
    writer_.write(trace_format::channel_of(Stream::kColliders, version));
  }

  void pose(std::size_t person, std::uint32_t sequence, std::uint64_t time_ns) {
    const Pose pose = test::frame(sequence, test::kNodes, 0).poses.front();
    message(trace_format::pose_channel_id(person), sequence, time_ns,
            encoder_.pose(static_cast<std::int64_t>(time_ns), pose));
  }
  void colliders(std::uint32_t sequence, std::uint64_t time_ns, const std::vector<ColliderSample>& colliders) {
    message(2, sequence, time_ns, encoder_.colliders(static_cast<std::int64_t>(time_ns), colliders));
  }
  void frame(std::uint32_t sequence, const std::vector<ColliderSample>& all = {}) {
    for (const std::size_t person : {0U, 1U}) pose(person, sequence, sequence);
    colliders(sequence, sequence, all);
  }
  const std::vector<std::byte>& finished() {
    writer_.finish();
    return bytes_;
  }

 private:
  void message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns, mcap::Bytes data) {
    writer_.write(mcap::Message{
        .channel_id = channel, .sequence = sequence, .log_time = time_ns, .publish_time = time_ns, .data = data});
  }

  std::vector<std::byte> glb_ = test::skeleton_glb(test::kNodes);
  std::vector<std::byte> bytes_;
  mcap::Writer writer_;
  MessageEncoder encoder_;
};

/// What a reader and `doctor` find in a file.
struct Findings {
  std::vector<TraceFrame> frames;
  std::string error;
  std::vector<std::string> warnings;
  std::vector<std::string> problems;
};

Findings findings_of(const std::vector<std::byte>& bytes, std::size_t people = 2) {
  Findings findings;
  test::MemoryFile file;
  file.assign(bytes);
  TraceReader reader(file.path(), People::kSeveral);
  findings.error = test::message_of([&] {
    static_cast<void>(reader.frame_count());
    findings.frames = test::read_frames(reader);
  });
  findings.warnings = reader.warnings();
  const mcap::MemorySource source(bytes);
  const TraceCheck check = check_trace(source, test::go_on);
  EXPECT_EQ(check.people, people);
  EXPECT_EQ(reader.people().size(), people);
  for (const mcap::Problem& problem : check.problems.kept()) findings.problems.push_back(problem.what);
  return findings;
}

TEST(TraceOfPeople, ReadsWhatWasWritten) {
  const test::TemporaryFolder folder;
  write_two(folder / "two.mcap", 100);
  TraceReader reader(folder / "two.mcap", People::kSeveral);
  EXPECT_EQ(reader.session().at("format_version"), "3");
  ASSERT_EQ(reader.people().size(), 2U);
  EXPECT_EQ(reader.people()[0].name, "ann");
  EXPECT_EQ(reader.people()[1].name, "bob");
  EXPECT_EQ(reader.people()[0].facing, "+z");
  EXPECT_EQ(reader.people()[1].facing, "-z");
  EXPECT_EQ(reader.people()[1].node_names.size(), kOtherNodes);
  EXPECT_TRUE(reader.people()[0].actuator_map_json.empty());
  EXPECT_EQ(reader.people()[1].actuator_map_json.size(), 2U);
  EXPECT_EQ(reader.frame_count(), 100U);
  const std::vector<TraceFrame> frames = test::read_frames(reader);
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_TRUE(test::same_bits(frames[i], frame_of_two(i))) << i;
  EXPECT_TRUE(reader.complete());

  const McapSummary summary = summarise_mcap(folder / "two.mcap");
  EXPECT_EQ(summary.people, 2U);
  EXPECT_THAT(summary.warnings, IsEmpty());
}

TEST(TraceOfPeople, IsRefusedByWhoeverKnowsOnePersonOnly) {
  const test::TemporaryFolder folder;
  write_two(folder / "two.mcap", 3);
  EXPECT_THAT(test::message_of([&] { TraceReader reader(folder / "two.mcap"); }), HasSubstr("holds 2 people"));
  // One person, but their own limbs must not touch them.
  const Avatar avatar = test::skeleton(test::kNodes);
  const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
  {
    TraceWriter writer(folder / "one.mcap", {}, {{avatar, {.avatar_glb = glb}}}, {.owners = Owners::kPeople});
    TraceFrame frame = test::frame(0, test::kNodes, 1);
    frame.colliders[0].owner = 1;
    writer.write(frame);
    writer.finish();
  }
  EXPECT_THAT(test::message_of([&] { TraceReader reader(folder / "one.mcap"); }), HasSubstr("belong to its person"));
  TraceReader reader(folder / "one.mcap", People::kSeveral);
  EXPECT_EQ(test::read_frames(reader).at(0).colliders.at(0).owner, 1);
}

TEST(TraceOfPeople, IsWrittenOnlyIfItCanBeRead) {
  const test::TemporaryFolder folder;
  const Avatar avatar = test::skeleton(test::kNodes);
  const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
  const TracePerson person = {avatar, {.avatar_glb = glb}};
  const auto refusal = [&](const std::vector<TracePerson>& people, const TraceFrame& frame) {
    return test::message_of([&] {
      TraceWriter writer(folder / "a.mcap", {}, people, {.overwrite = Overwrite::kAllow});
      writer.write(frame);
    });
  };
  const TraceFrame frame = test::frame(0, test::kNodes, 1);
  TraceFrame owned = frame;
  owned.colliders[0].owner = 1;
  EXPECT_THAT(refusal({person}, owned), HasSubstr("has an owner in a trace without owners"));
  EXPECT_THAT(refusal({person, person}, frame), HasSubstr("it has 1 poses for 2 people"));
  TraceFrame two = frame;
  two.poses.push_back(frame.poses.front());
  two.colliders[0].owner = 3;
  EXPECT_THAT(refusal({person, person}, two), HasSubstr("belongs to person 3, and there are only 2"));
  EXPECT_THAT(refusal({}, frame), HasSubstr("cannot hold 0 people"));
}

TEST(TraceOfPeople, AFrameLacksAtMostThePersonWhosePoseIsMissing) {
  ForgedPeople trace;
  trace.frame(0);
  trace.pose(0, 1, 1);
  trace.colliders(1, 1, {});
  trace.frame(2);
  const Findings found = findings_of(trace.finished());
  ASSERT_EQ(found.frames.size(), 3U);
  EXPECT_EQ(found.frames[1].poses[0].nodes.size(), test::kNodes);
  EXPECT_TRUE(found.frames[1].poses[1].nodes.empty());
  EXPECT_EQ(found.frames[2].poses[1].nodes.size(), test::kNodes);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("frame 1 has no pose of person 2")));
  EXPECT_THAT(found.problems, ::testing::ElementsAre(HasSubstr("frame 1 has no pose of person 2")));
}

TEST(TraceOfPeople, PosesOfOneFrameHaveOneTime) {
  ForgedPeople trace;
  trace.frame(0);
  trace.pose(0, 1, 5);
  trace.pose(1, 1, 6);
  const Findings found = findings_of(trace.finished());
  EXPECT_THAT(found.error, HasSubstr("its poses are of different times, 5 ns and 6 ns"));
  EXPECT_THAT(found.problems, Contains(HasSubstr("its poses are of different times, 5 ns and 6 ns")));
}

TEST(TraceOfPeople, AnOwnerIsThereAndStays) {
  ForgedPeople absent;
  absent.frame(0, {{.id = 4, .owner = 3}});
  const Findings found = findings_of(absent.finished());
  EXPECT_THAT(found.frames.at(0).colliders, IsEmpty());
  EXPECT_THAT(found.warnings, Contains(HasSubstr("collider 4 belongs to person 3, and there are only 2")));
  EXPECT_THAT(found.problems, Contains(HasSubstr("collider 4 belongs to person 3, and there are only 2")));

  ForgedPeople changing;
  changing.frame(0, {{.id = 4}});
  changing.frame(1, {{.id = 4, .owner = 2}});
  const Findings changed = findings_of(changing.finished());
  EXPECT_THAT(changed.error, HasSubstr("collider 4 belongs to person 2, but before it belonged to nobody"));
  EXPECT_THAT(changed.problems, Contains(HasSubstr("collider 4 changes its owner to person 2")));
}

TEST(TraceOfPeople, AnEarlierVersionKnowsOnePersonWhateverElseIsInTheFile) {
  ForgedPeople trace(trace_format::kPointsVersion);
  for (const std::uint32_t sequence : {0U, 1U, 2U}) {
    trace.pose(0, sequence, sequence);
    trace.pose(1, 0, 99);  // another program's channel, with its own numbers and times
    trace.colliders(sequence, sequence, {{.id = 4}});
  }
  const std::vector<std::byte> bytes = trace.finished();
  const Findings found = findings_of(bytes, 1);
  EXPECT_EQ(found.error, "no error");
  EXPECT_EQ(found.frames.size(), 3U);
  EXPECT_THAT(found.problems, IsEmpty());
  std::vector<std::byte> recovered;
  const mcap::MemorySource source(bytes);
  EXPECT_FALSE(recover_mcap(source, test::into(recovered), test::go_on).lost_something());
}

TEST(TraceOfPeople, RecoverLeavesOutWhatReadersRefuse) {
  ForgedPeople trace;
  trace.frame(0, {{.id = 4}});
  trace.frame(1, {{.id = 4, .owner = 2}});
  trace.frame(2, {{.id = 4}});
  const mcap::MemorySource source(trace.finished());
  std::vector<std::byte> recovered;
  EXPECT_TRUE(recover_mcap(source, test::into(recovered), test::go_on).lost_something());
  const Findings found = findings_of(recovered);
  EXPECT_EQ(found.error, "no error");
  EXPECT_EQ(found.frames.size(), 2U);
}

TEST(TraceOfPeople, NamesOfAttachmentsAndTopics) {
  using trace_format::attachment_id;
  EXPECT_EQ(trace_format::attachment_name(AttachmentKind::kMapText, 1), "actuator_map.2.json");
  EXPECT_EQ(trace_format::numbered("/pose", 7), "/pose/8");
  EXPECT_EQ(attachment_id("avatar.12.glb")->person, 11U);
  EXPECT_EQ(attachment_id("actuator_map.png")->person, 0U);
  for (const char* foreign :
       {"avatar.1.glb", "avatar.02.glb", "avatar.0.glb", "avatar.-2.glb", "avatar.2x.glb", "avatar.101.glb",
        "avatar..glb", "avatar.2.glb.damaged", "avatar2.glb", "avatar.99999999999999999999.glb", ""})
    EXPECT_FALSE(attachment_id(foreign)) << foreign;
}

TEST(TraceOfPeople, WhateverByteIsChangedTheRestIsRecovered) {
  const test::TemporaryFolder folder;
  write_two(folder / "two.mcap", 12, Compression::kNone);
  const std::vector<std::byte> whole = read_file(folder / "two.mcap");
  const std::vector<TraceFrame> frames = [] {
    std::vector<TraceFrame> expected;
    for (std::uint64_t i = 0; i < 12; ++i) expected.push_back(frame_of_two(i));
    return expected;
  }();
  test::MemoryFile file;
  constexpr std::size_t kStep = 23;
  for (std::size_t at = mcap::kMagicBytes; at < whole.size(); at += kStep) {
    std::vector<std::byte> broken = whole;
    broken[at] ^= at % 2 == 0 ? std::byte{0x41} : std::byte{0x01};
    std::vector<std::byte> mended;
    const mcap::MemorySource source(broken);
    ASSERT_EQ(test::message_of([&] { recover_mcap(source, test::into(mended), test::go_on); }), "no error") << at;
    file.assign(mended);
    try {
      TraceReader reader(file.path(), People::kSeveral);
      ASSERT_EQ(reader.people().size(), 2U) << at;
      std::size_t changed = 0;
      for (const TraceFrame& frame : test::read_frames(reader))
        if (frame.index >= frames.size() || !test::same_bits(frame, frames[frame.index])) ++changed;
      EXPECT_LE(changed, 1U) << "byte " << at << ": only the frame of that byte";
    } catch (const Error& error) {
      // Without an avatar nothing can be replayed; `recover --avatar` mends that.
      EXPECT_THAT(error.what(), HasSubstr("has no undamaged attachment avatar")) << at;
    }
  }
}

}  // namespace
}  // namespace vestige
