// Traces that leave as HDF5 and come back: to the bit, or not at all.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/cli/files/exchange_fixture.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/long.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/shared_library.hpp"
#include "traces/exchange/trace_hdf5.hpp"
#include "traces/hdf5/hdf5_library.hpp"
#include "traces/hdf5/hdf5_reader.hpp"
#include "traces/hdf5/hdf5_table.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

class Hdf5Exchange : public test::ExchangeTest {};

TEST_F(Hdf5Exchange, ThereAndBackIsTheSameTraceToTheBit) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  ASSERT_EQ(run("vestige import a.h5 -o back.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige cat a.mcap > a.txt; vestige cat back.mcap > back.txt; cmp a.txt back.txt").exit_code, 0);
  EXPECT_EQ(hash_of("back.mcap"), hash_of("a.mcap"));
  EXPECT_EQ(run("grep -c -a units a.h5").exit_code, 0);
}

TEST_F(Hdf5Exchange, AnExportTakesTheContactsAlong) {
  ASSERT_EQ(run("vestige replay a.mcap --contacts a.csv -q && vestige replay a.mcap --contacts c.h5 -q").exit_code, 0);
  const nlohmann::json json = json_of("vestige export a.mcap -o a.h5 --contacts a.csv --json -");
  ASSERT_EQ(run("vestige export a.mcap -o b.h5 --contacts c.h5").exit_code, 0);
  const std::string rows = run("tail -n +2 a.csv").standard_output;
  EXPECT_EQ(json["contacts"], std::ranges::count(rows, '\n'));
  EXPECT_GT(json["contacts"], 10);
  for (const char* name : {"a.h5", "b.h5"}) {
    const Hdf5Handle file = open_hdf5(folder_ / name, "");
    std::vector<std::uint64_t> frame;
    std::vector<float> t;
    std::vector<std::int64_t> side;
    std::vector<double> u;
    std::vector<double> texture_v;
    std::vector<double> z_m;
    Hdf5Table(file.id(), name, "contacts/u").read(0, json["contacts"], u);
    Hdf5Table(file.id(), name, "contacts/texture_v").read(0, json["contacts"], texture_v);
    Hdf5Table(file.id(), name, "contacts/frame").read(0, json["contacts"], frame);
    Hdf5Table(file.id(), name, "contacts/t").read(0, json["contacts"], t);
    Hdf5Table(file.id(), name, "contacts/side").read(0, json["contacts"], side);
    Hdf5Table(file.id(), name, "contacts/z").read(0, json["contacts"], z_m);
    std::string text;
    for (std::size_t i = 0; i < t.size(); ++i)
      text += fmt::format("{},{},{},{},{},{}\n", frame[i], t[i], u[i], texture_v[i], side[i], z_m[i]);
    EXPECT_EQ(text, run("tail -n +2 a.csv | cut -d, -f1,5,6,9,11,14").standard_output) << name;
  }
  ASSERT_EQ(run("vestige import a.h5 -o back.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("back.mcap"), hash_of("a.mcap"));
}

TEST_F(Hdf5Exchange, RefusesTheContactsOfAnotherTrace) {
  ASSERT_EQ(run("vestige replay a.mcap --contacts a.csv -q").exit_code, 0);
  const auto expect_refused = [&](const std::string& change, const std::vector<std::string>& words) {
    ASSERT_EQ(run("awk -F, -v OFS=, '" + change + " {print}' a.csv > b.csv").exit_code, 0);
    expect_failure("vestige export a.mcap -o a.h5 --contacts b.csv", 1, words, "a.h5");
  };
  expect_refused("NR == 2 {$3 = 999}", {"b.csv", "collider 999, which the trace does not have"});
  expect_refused("NR == 2 {$1 = 9999}", {"b.csv", "frame 9999, which the trace does not have"});
  expect_refused("NR == 3 {$2 += 0.001}", {"b.csv", "and the trace has it at"});
  expect_refused("NR == 2 {$4 = 999999}", {"b.csv, line 2", "triangle 999999"});
  expect_refused("NR == 2 {$10 = 99}", {"b.csv, line 2", "actuator 99"});
  expect_refused("NR == 2 {$11 = 5}", {"b.csv, line 2", "side must be -1, 0 or 1"});
  expect_refused("NR == 2 {$12 = \"nan\"}", {"b.csv, line 2", "x must be finite"});
  expect_failure("vestige export a.mcap -o a.ndjson --contacts a.csv", 2, {"--contacts", ".h5"}, "a.ndjson");
  expect_failure("vestige export a.mcap -o a.h5 --contacts a.csv --rate 10", 2, {"--contacts", "--rate"}, "a.h5");
}

TEST_F(Hdf5Exchange, OfABrokenFileIsRefused) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5 && head -c 30000 a.h5 > cut.h5").exit_code, 0);
  expect_failure("vestige import cut.h5 -o b.mcap", 1, {"cut.h5"}, "b.mcap");
  write("text.h5", "nothing");
  expect_failure("vestige import text.h5 -o b.mcap", 1, {"text.h5"}, "b.mcap");
}

/// Changes an .h5 in place, as another program may.
class Hdf5Editor {
 public:
  explicit Hdf5Editor(const std::filesystem::path& path)
      : file_(h5_.open_file(path.c_str(), kHdf5ReadWrite, 0), h5_.close_file) {
    library_.find("H5Acreate_by_name", create_attribute_);
    library_.find("H5Arename_by_name", rename_attribute_);
    library_.find("H5Ldelete", remove_);
    EXPECT_GE(file_.id(), 0);
  }

  void rename(const char* group, const char* from, const char* to) {
    EXPECT_GE(rename_attribute_(file_.id(), group, from, to, 0), 0);
  }
  /// A text in place of another of the same length.
  void set_text(const char* group, const char* key, const char* text) {
    const Hdf5Handle attribute(h5_.open_attribute(file_.id(), group, key, 0, 0), h5_.close_attribute);
    const Hdf5Handle type(h5_.attribute_type(attribute.id()), h5_.close_type);
    EXPECT_GE(h5_.write_attribute(attribute.id(), type.id(), text), 0);
  }
  void set_number(const char* group, const char* key, std::int64_t number) {
    const hsize_t count = 1;
    const Hdf5Handle space(h5_.create_simple_space(1, &count, nullptr), h5_.close_space);
    rename(group, key, "formerly");
    const Hdf5Handle attribute(create_attribute_(file_.id(), group, key, h5_.int64, space.id(), 0, 0, 0),
                               h5_.close_attribute);
    EXPECT_GE(h5_.write_attribute(attribute.id(), h5_.int64, &number), 0);
  }
  void remove(const char* name) { EXPECT_GE(remove_(file_.id(), name, 0), 0); }
  void add_list(const char* group, const char* key, std::size_t text_bytes, const void* data) {
    const hsize_t count = 1000;
    const Hdf5Handle space(h5_.create_simple_space(1, &count, nullptr), h5_.close_space);
    const Hdf5Handle type(h5_.copy_type(h5_.text), h5_.close_type);
    EXPECT_GE(h5_.set_size(type.id(), text_bytes), 0);
    const Hdf5Handle attribute(create_attribute_(file_.id(), group, key, type.id(), space.id(), 0, 0, 0),
                               h5_.close_attribute);
    EXPECT_GE(h5_.write_attribute(attribute.id(), type.id(), data), 0);
  }
  /// A list in place of a table.
  void replace(const char* name, hid_t type, hsize_t count, const void* data) {
    EXPECT_GE(remove_(file_.id(), name, 0), 0);
    const Hdf5Handle space(h5_.create_simple_space(1, &count, nullptr), h5_.close_space);
    const Hdf5Handle dataset(h5_.create_dataset(file_.id(), name, type, space.id(), 0, 0, 0), h5_.close_dataset);
    EXPECT_GE(h5_.write(dataset.id(), type, 0, 0, 0, data), 0);
  }

 private:
  static constexpr unsigned kHdf5ReadWrite = 1;  ///< H5F_ACC_RDWR
  const Hdf5Library& h5_ = hdf5();
  SharedLibrary library_{"libhdf5_serial.so.103"};
  decltype(&::H5Acreate_by_name) create_attribute_ = nullptr;
  decltype(&::H5Arename_by_name) rename_attribute_ = nullptr;
  decltype(&::H5Ldelete) remove_ = nullptr;
  Hdf5Handle file_;
};

TEST_F(Hdf5Exchange, OfAFileWhoseAvatarIsNotTheRecordedOneIsRefused) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  std::string file = read_text_file(folder_ / "a.h5");
  const std::size_t place = file.find("\"generator\":\"");
  ASSERT_NE(place, std::string::npos);
  file.replace(place + 13, 1, "X");
  write("changed.h5", file);
  expect_failure("vestige import changed.h5 -o b.mcap", 1,
                 {"changed.h5", "avatar.glb", "SHA-256", "remove the attribute"}, "b.mcap");
  // Another program's file need not say what it was.
  Hdf5Editor(folder_ / "changed.h5").rename("session", "sha256:avatar.glb", "formerly");
  EXPECT_EQ(run("vestige import changed.h5 -o b.mcap").exit_code, 0);
}

TEST_F(Hdf5Exchange, OfAFileWhoseSessionHasListsInPlaceOfTextsIsRefused) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  const char* key = "sha256:avatar.glb";
  const std::vector<const char*> texts(1000, "x");
  const std::string flat(64 * texts.size(), 'x');
  constexpr std::size_t kVariable = ~std::size_t{0};
  for (const std::size_t text_bytes : {std::size_t{64}, kVariable}) {
    ASSERT_EQ(run("cp a.h5 list.h5").exit_code, 0);
    {
      Hdf5Editor editor(folder_ / "list.h5");
      editor.rename("session", key, "formerly");
      editor.add_list("session", key, text_bytes,
                      text_bytes == kVariable ? static_cast<const void*>(texts.data()) : flat.data());
    }
    expect_failure("vestige import list.h5 -o b.mcap", 1, {"list.h5", key, "is not one text"}, "b.mcap");
  }
}

TEST_F(Hdf5Exchange, OfAnotherVersionOrOtherNodesOrNumbersIsRefused) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  const auto refused = [&](const std::function<void(Hdf5Editor&)>& change, const std::vector<std::string>& words) {
    ASSERT_EQ(run("cp a.h5 changed.h5").exit_code, 0);
    {
      Hdf5Editor editor(folder_ / "changed.h5");
      change(editor);
    }
    expect_failure("vestige import changed.h5 -o b.mcap", 1, words, "b.mcap");
  };
  const Hdf5Library& h5 = hdf5();
  refused([](Hdf5Editor& editor) { editor.set_text("/", "format_version", "4"); },
          {"changed.h5: its format version is 4, and this vestige reads versions up to 3"});
  refused([](Hdf5Editor& editor) { editor.set_text("session", "format_version", "4"); },
          {"changed.h5: its format version is 4, and this vestige reads versions up to 3"});
  refused([](Hdf5Editor& editor) { editor.set_number("/", "format_version", 1); },
          {"changed.h5: its attribute 'format_version' is not a text"});
  refused([](Hdf5Editor& editor) { editor.set_text("/", "format", "another thing"); },
          {"changed.h5: its format is 'another thing'"});
  refused([](Hdf5Editor& editor) { editor.rename("session", "argv", "name"); },
          {"changed.h5: the name of person 1 is longer than 100 bytes", "the attribute 'name' of the group session"});
  const std::size_t nodes = test::builtin_avatar().nodes.size();
  // Texts of one length, as export writes them, and of any, as Python does.
  const Hdf5Handle any_length(h5.copy_type(h5.text), h5.close_type);
  ASSERT_GE(h5.set_size(any_length.id(), ~std::size_t{0}), 0);
  const std::string letters(nodes, 'x');
  const std::vector<const char*> texts(nodes, "x");
  for (const auto& [type, data] : {std::pair<hid_t, const void*>(h5.text, letters.data()),
                                   std::pair<hid_t, const void*>(any_length.id(), texts.data())})
    refused([&](Hdf5Editor& editor) { editor.replace("pose/node_names", type, nodes, data); },
            {"pose/node_names does not name its avatar's nodes"});
  const std::vector<std::int64_t> ids(30, std::int64_t{1} << 33);
  refused([&](Hdf5Editor& editor) { editor.replace("colliders/id", h5.int64, ids.size(), ids.data()); },
          {"colliders/id", "do not fit into unsigned whole numbers of 32 bits", "astype"});
  const std::vector<double> times(300, 0.5);
  refused([&](Hdf5Editor& editor) { editor.replace("time_ns", h5.float64, times.size(), times.data()); },
          {"time_ns", "do not fit into whole numbers of 64 bits"});
}

TEST_F(Hdf5Exchange, ContactsAreThoseOfTheCsvToTheBit) {
  ASSERT_EQ(run("vestige replay a.mcap --contacts c.csv && vestige replay a.mcap --contacts c.h5").exit_code, 0);
  EXPECT_EQ(json_of("vestige replay a.mcap --verify c.h5 --json -")["verify"], [&] {
    auto same = json_of("vestige replay a.mcap --verify c.csv --json -")["verify"];
    same["against"] = "c.h5";
    return same;
  }());
  // Every column, in the CSV's own form of numbers.
  const Hdf5Handle file(hdf5().open_file((folder_ / "c.h5").c_str(), kHdf5ReadOnly, 0), hdf5().close_file);
  std::vector<std::string> lines;
  const auto add = [&]<typename Number>(const char* name, Number) {
    const Hdf5Table table(file.id(), "c.h5", name);
    std::vector<Number> numbers;
    table.read(0, table.dimensions()[0], numbers);
    const bool is_first = lines.empty();
    lines.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) lines[i] += fmt::format("{}{}", is_first ? "" : ",", numbers[i]);
  };
  add("frame", std::uint64_t{});
  add("time_s", double{});
  add("collider", std::uint32_t{});
  add("triangle", std::uint32_t{});
  add("t", float{});
  for (const char* name : {"u", "v", "texture_u", "texture_v"}) add(name, double{});
  add("actuator", std::uint16_t{});
  add("side", std::int64_t{});
  for (const char* name : {"x", "y", "z"}) add(name, double{});
  EXPECT_GT(lines.size(), 10U);
  const std::string csv = read_text_file(folder_ / "c.csv");
  EXPECT_EQ(fmt::format("{}\n", fmt::join(lines, "\n")), csv.substr(csv.find('\n') + 1));
}

TEST_F(Hdf5Exchange, BrokenContactsAreRefused) {
  ASSERT_EQ(run("vestige replay a.mcap --contacts c.h5 && head -c 9000 c.h5 > cut.h5").exit_code, 0);
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  expect_failure("vestige replay a.mcap --verify cut.h5", 1, {"cut.h5"});
  expect_failure("vestige replay a.mcap --verify a.h5", 1, {"a.h5", "'vestige trace', not 'vestige contacts'"});
  const Hdf5Library& h5 = hdf5();
  const auto refused = [&](const std::function<void(Hdf5Editor&)>& change, const std::vector<std::string>& words) {
    ASSERT_EQ(run("cp c.h5 changed.h5").exit_code, 0);
    {
      Hdf5Editor editor(folder_ / "changed.h5");
      change(editor);
    }
    expect_failure("vestige replay a.mcap --verify changed.h5", 1, words);
  };
  refused([](Hdf5Editor& editor) { editor.remove("actuator"); },
          {"changed.h5: its table actuator is missing", "vestige replay --contacts"});
  const float three[] = {0, 0.5F, 2};
  refused([&](Hdf5Editor& editor) { editor.replace("t", h5.float32, 3, three); },
          {"its table t has the shape (3)", "vestige replay --contacts"});
  const std::vector<float> late(
      Hdf5Table(Hdf5Handle(h5.open_file((folder_ / "c.h5").c_str(), kHdf5ReadOnly, 0), h5.close_file).id(), "c.h5", "t")
          .dimensions()[0],
      2);
  refused([&](Hdf5Editor& editor) { editor.replace("t", h5.float32, late.size(), late.data()); },
          {"its table t, row 0: t must be from 0 to 1"});
}

TEST_F(Hdf5Exchange, WithoutCollidersNeedsNoTablesOfThem) {
  ASSERT_EQ(run("vestige export a.mcap -o a.h5").exit_code, 0);
  Hdf5Editor(folder_ / "a.h5").remove("colliders");
  EXPECT_EQ(run("vestige import a.h5 -o b.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige replay b.mcap --json -")["colliders"], 0);
}

TEST_F(Hdf5Exchange, NoChangedByteOfAFileCrashesOrChangesAFrame) {
  ASSERT_EQ(
      run("vestige record --count 3 --duration 0.003 -o small.mcap && vestige export small.mcap -o small.h5").exit_code,
      0);
  const auto frames_of = [](const std::filesystem::path& path) {
    TraceHdf5 file(path);
    std::vector<TraceFrame> frames;
    for (TraceFrame frame; file.next(frame);) frames.push_back(frame);
    return frames;
  };
  const std::vector<TraceFrame> whole = frames_of(folder_ / "small.h5");
  ASSERT_EQ(whole.size(), 3U);
  const std::string bytes = read_text_file(folder_ / "small.h5");
  const std::size_t avatar = bytes.find("glTF");
  const std::size_t step = test::is_long() ? 31 : 311;
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    // Most of the file, which its SHA-256 verifies.
    if (at > avatar + 200 && at + 200 < avatar + builtin_avatar_glb().size()) continue;
    std::string changed = bytes;
    changed[at] = static_cast<char>(~changed[at]);
    write("changed.h5", changed);
    try {
      const std::vector<TraceFrame> frames = frames_of(folder_ / "changed.h5");
      ASSERT_EQ(frames.size(), whole.size()) << at;
      for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_TRUE(test::same_bits(frames[i], whole[i])) << at;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("changed.h5")) << at;
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
}

/// Every size at which something else of it cannot be written: attachments, tables, what HDF5 writes when it closes.
TEST_F(Hdf5Exchange, OntoAFullDiskIsAnErrorAndLeavesNothing) {
  ASSERT_EQ(run("vestige export a.mcap -o whole.h5").exit_code, 0);
  const auto whole = static_cast<double>(std::filesystem::file_size(folder_ / "whole.h5")) / 1024;
  for (const double share : {0.001, 0.02, 0.25, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99})
    expect_failure(fmt::format("ulimit -f {}; vestige export a.mcap -o full.h5", std::ceil(whole * share)), 1,
                   {"full.h5"}, "full.h5");
  expect_no_hidden_file();
}

}  // namespace
}  // namespace vestige
