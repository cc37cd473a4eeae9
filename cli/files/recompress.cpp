#include <memory>

#include "cli/files/rewriting.hpp"
#include "cli/verbs.hpp"

namespace vestige::cli {

namespace {

struct RecompressOptions {
  CommonOptions common;
  std::string file;
  std::string output;
  std::string compression = "zstd";
};

void run_recompress(const RecompressOptions& options, Invocation& invocation) {
  RewriteOptions how;
  how.compression = mcap::Compression::kZstd;
  if (options.compression == "lz4") how.compression = mcap::Compression::kLz4;
  if (options.compression == "none") how.compression = mcap::Compression::kNone;
  run_rewrite(options.file, options.output, how, "Recompressing", options.common, invocation);
}

}  // namespace

void add_recompress(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<RecompressOptions>();
  CLI::App* verb = add_verb(program, "recompress", "Rewrite a trace, or any MCAP file, with another compression",
                            "  vestige recompress man.mcap -o fast.mcap --compression lz4\n"
                            "  vestige recompress man.mcap -o plain.mcap --compression none\n");
  verb->add_option("FILE", options->file, "The trace, or any MCAP file, or '-' for standard input")->required();
  verb->add_option("--compression", options->compression, "How the new file's chunks are compressed")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "lz4", "none"}));
  verb->add_option("-o,--output", options->output, "The file to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_recompress(*options, invocation); });
}

}  // namespace vestige::cli
