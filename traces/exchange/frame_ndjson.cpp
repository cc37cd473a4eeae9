#include <fmt/format.h>

#include <iterator>

#include "traces/base/number_text.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/scene/frame_json.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

class FrameNdjson final : public TraceExport {
 public:
  FrameNdjson(const std::filesystem::path& path, Overwrite overwrite) : file_(path, overwrite) {}

  void write(const TraceFrame& frame) override {
    line_.clear();
    fmt::format_to(std::back_inserter(line_), R"({{"frame":{},"time_s":)", frame.index);
    append_seconds(line_, frame.time_ns);
    for (std::size_t person = 0; person < frame.poses.size(); ++person) {
      const Pose& pose = frame.poses[person];
      if (frame.poses.size() > 1 && pose.nodes.empty()) continue;  // it is missing
      fmt::format_to(std::back_inserter(line_), R"(,"{}":)", trace_format::numbered("pose", person));
      append_json(line_, pose);
    }
    line_ += R"(,"colliders":)";
    append_json(line_, frame.colliders);
    if (!frame.teleported.empty())
      fmt::format_to(std::back_inserter(line_), R"(,"teleported":[{}])", fmt::join(frame.teleported, ","));
    line_ += "}\n";
    file_.write(line_);
  }

  void commit() override { file_.commit(); }

 private:
  OutputFile file_;
  std::string line_;
};

}  // namespace

std::unique_ptr<TraceExport> make_frame_ndjson(const std::filesystem::path& path, Overwrite overwrite) {
  return std::make_unique<FrameNdjson>(path, overwrite);
}

}  // namespace vestige
