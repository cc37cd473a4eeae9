#pragma once

#include <filesystem>
#include <memory>

#include "traces/trace_writer.hpp"

namespace vestige {

/// A trace that is complete or absent, where `TraceWriter` alone keeps what it can: for what is made of other files,
/// which can be read again. "-", devices and pipes are just written to. Throws `Error` as `TraceWriter` does.
class StagedTrace {
 public:
  StagedTrace(const std::filesystem::path& path, Session session, const Avatar& avatar,
              const TraceAttachments& attachments, TraceWriterOptions options);
  ~StagedTrace();
  StagedTrace(const StagedTrace&) = delete;
  StagedTrace& operator=(const StagedTrace&) = delete;

  TraceWriter& writer() { return *writer_; }
  /// Finishes the trace and gives it its name.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_path_;  ///< empty: written in place
  Overwrite overwrite_;
  std::unique_ptr<TraceWriter> writer_;
};

}  // namespace vestige
