#!/bin/bash
# How long a batch takes: 10 maps x 40 traces (100 colliders, 2000 frames each) x 4 laws, with one job and with two.
# usage: batch_benchmark.sh [FOLDER]      'vestige' must be on the PATH; the folder is made, 150 MB
set -euo pipefail
folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
cd "$folder"
for i in $(seq 40); do
  scenario=$(printf 'swarm\nrain\norbit\npunch\nhug\n' | sed -n "$((i % 5 + 1))p")
  [ -e "trace-$i.mcap" ] || vestige record -q --colliders "$scenario" --count 100 --rate 1000 --duration 2 --seed "$i" \
    -o "trace-$i.mcap"
done
# The built-in map, the four layouts, and copies of those under names of their own.
layouts="paper6 torso16 torso40 body"
# shellcheck disable=SC2086  # a list of words
[ -e copies ] || vestige batch -q --maps builtin $layouts --traces trace-1.mcap --laws binary -o copies
maps=$(for map in builtin $layouts; do echo "copies/maps/$map.png"; done)
for jobs in 1 2; do
  rm -rf "jobs-$jobs"
  # shellcheck disable=SC2086
  vestige batch --maps builtin $layouts $maps --traces trace-*.mcap --jobs "$jobs" -o "jobs-$jobs" -q --json "jobs-$jobs.json" \
    --force 2>/dev/null || true
done
python3 - <<'END'
import json
runs = [json.load(open(f"jobs-{jobs}.json")) for jobs in (1, 2)]
for run in runs:
    totals = run["totals"]
    print(f'{run["jobs"]} job(s): {totals["traces"]} traces, {totals["scores"]} scores in {run["wall_s"]:.1f} s; processor time: '
          f'reading {totals["reading_s"]:.2f} s, detecting {totals["detection_s"]:.2f} s, scoring {totals["scoring_s"]:.2f} s')
print(f'two jobs are {runs[0]["wall_s"] / runs[1]["wall_s"]:.2f} times as fast as one')
END
