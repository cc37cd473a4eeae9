#!/bin/sh
# Replays a trace of 10 GB, most of it holes, and fails if that takes 200 MiB or more:
#   replay_large_trace.sh FOLDER_OF_PROGRAMS
set -eu
programs=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$programs/sparse_trace" "$folder/large.mcap" 10e9
printf '%s bytes, %s KiB of them on disk\n' "$(stat -c %s "$folder/large.mcap")" "$(du -k "$folder/large.mcap" | cut -f1)"
python3 - "$programs/vestige" "$folder/large.mcap" <<'PYTHON'
import resource, subprocess, sys, time
start = time.time()
subprocess.run([sys.argv[1], "replay", sys.argv[2], "--detector", "cpu"], check=True)
used_mib = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
print(f"replayed in {time.time() - start:.1f} s with {used_mib:.0f} MiB")
sys.exit(0 if used_mib < 200 else 1)
PYTHON
