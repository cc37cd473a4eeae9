#include "traces/staged_trace.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

namespace vestige {

StagedTrace::StagedTrace(const std::filesystem::path& path, Session session, const Avatar& avatar,
                         const TraceAttachments& attachments, TraceWriterOptions options)
    : path_(path), overwrite_(options.overwrite) {
  std::error_code ignored;
  const bool is_stream =
      path == "-" || (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored));
  if (!is_stream) {
    refuse_overwrite(path, overwrite_);
    if (std::filesystem::is_symlink(path_, ignored)) path_ = std::filesystem::weakly_canonical(path_);
    temporary_path_ = path_.parent_path() / fmt::format(".{}.{}", path_.filename().string(), ::getpid());
    options.overwrite = Overwrite::kAllow;
  }
  writer_ = std::make_unique<TraceWriter>(is_stream ? path : temporary_path_, std::move(session), avatar, attachments,
                                          options);
}

StagedTrace::~StagedTrace() {
  writer_.reset();
  std::error_code ignored;
  if (!temporary_path_.empty()) std::filesystem::remove(temporary_path_, ignored);
}

void StagedTrace::commit() {
  writer_->finish();
  if (temporary_path_.empty()) return;
  give_name(temporary_path_, path_, overwrite_);
  temporary_path_.clear();
}

}  // namespace vestige
