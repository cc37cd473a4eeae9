// Writes the seeds of trace_fuzzer and recover_fuzzer into the folder that is its argument: small traces of every
// compression, one whole with events and what viewers draw, one cut, one with a broken chunk.

#include <fstream>

#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/files/input_file.hpp"

namespace {

void write(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int count, char** arguments) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  TraceWriterOptions options = test::steady_options(400);
  options.overwrite = Overwrite::kAllow;
  options.compression = Compression::kNone;
  test::write_trace(folder / "none", 4, options);
  options.compression = Compression::kLz4;
  test::write_trace(folder / "lz4", 4, options);
  options.compression = Compression::kZstd;
  test::write_trace(folder / "zstd", 4, options);
  const std::vector<std::byte> whole = read_file(folder / "none");
  write(folder / "cut", std::span(whole).first(whole.size() * 2 / 3));
  std::vector<std::byte> broken = whole;
  broken[broken.size() / 2] ^= std::byte{0xFF};
  write(folder / "broken", broken);
  {
    const auto glb = test::skeleton_glb(1);
    TraceWriter writer(folder / "events", {}, {{test::skeleton(1), {.avatar_glb = glb}}}, options);
    for (std::uint64_t i = 0; i < 2; ++i) {
      TraceFrame frame = test::frame(i, 1, 1);
      frame.teleported = {3};
      writer.note_dropped("/pose", i);
      writer.note_marker("m");
      writer.write(frame);
    }
    writer.finish();
  }
  return 0;
}
