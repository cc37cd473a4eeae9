#include "analysis/batch/slurm_script.hpp"

#include <fmt/format.h>

namespace vestige {

namespace {

std::string shell_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += fmt::format(" {}", shell_quoted(word));
  return text;
}

}  // namespace

std::string shell_quoted(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char letter : text) {
    if (letter == '\'') {
      quoted += "'\\''";
    } else {
      quoted += letter;
    }
  }
  quoted += "'";
  return quoted;
}

std::string slurm_script(const SlurmBatch& batch) {
  const std::string output = shell_quoted(batch.output);
  const std::string common = fmt::format("--parsable --requeue --open-mode=append --chdir={}{}",
                                         shell_quoted(batch.working_folder), shell_words(batch.sbatch));
  std::string folders;
  for (std::size_t i = 1; i <= batch.shards; ++i) folders += fmt::format(" {}/shards/{}", output, i);
  return fmt::format(R"script(#!/bin/bash
# A batch in {shards} shards, as a Slurm job array, and a job that merges them. Written by 'vestige batch slurm'.
# Run this on a machine that has sbatch; run it again to go on after a failure: what is finished is not run again.
set -euo pipefail
cd {folder}
mkdir -p {output}/shards {output}/logs

array=$(sbatch {common} --job-name=vestige-batch --array=1-{shards} --cpus-per-task={jobs} \
  --signal=B:TERM@60 --output={output}/logs/shard-%a.log <<'SHARD'
#!/bin/bash
stopped=
stop() {{ stopped=1; kill -TERM "$worker"; }}
trap stop TERM
{program} batch{arguments} \
  --shard "$SLURM_ARRAY_TASK_ID/{shards}" --jobs {jobs} -v -o {output}/shards/"$SLURM_ARRAY_TASK_ID" &
worker=$!
# A signal ends wait, not the worker, which finishes its files first.
while wait "$worker"; code=$?; kill -0 "$worker" 2>/dev/null; do :; done
# Preempted, near the time limit, or killed (137: out of memory, or by somebody): what is finished stays, and the shard
# goes on from there.
if {{ [ -n "$stopped" ] && [ "$code" -ne 0 ]; }} || [ "$code" -ge 128 ]; then
  if [ "${{SLURM_RESTART_COUNT:-0}}" -lt 5 ]; then
    echo "shard $SLURM_ARRAY_TASK_ID ended with $code; queued again"
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
  fi
  exit "$code"
fi
# 3: some inputs could not be used. The merged result says which; the others are done.
[ "$code" -eq 3 ] && code=0
exit "$code"
SHARD
)

merge=$(sbatch {common} --job-name=vestige-merge --dependency="afterok:$array" --kill-on-invalid-dep=yes \
  --output={output}/logs/merge.log <<'MERGE'
#!/bin/bash
{program} batch merge{folders}{merge_arguments} -o {output}
MERGE
)
echo "shards: job $array; merge: job $merge; the result will be in "{output}
)script",
                     fmt::arg("shards", batch.shards), fmt::arg("folder", shell_quoted(batch.working_folder)),
                     fmt::arg("output", output), fmt::arg("common", common), fmt::arg("jobs", batch.jobs),
                     fmt::arg("program", shell_quoted(batch.program)),
                     fmt::arg("arguments", shell_words(batch.arguments)), fmt::arg("folders", folders),
                     fmt::arg("merge_arguments", shell_words(batch.merge_arguments)));
}

}  // namespace vestige
