#!/bin/sh
# Measures this machine with the vestige beside this script: contexts, replays checked against the CPU, the sweep over
# collider counts, accuracy. A step that fails is said at the end, and does not keep the others from running.
set -u
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 1
PATH=$here/bin:$PATH
export PATH

usage="usage: measure [--quick] [FOLDER]
  FOLDER   where the results go (default: results-DATE-RENDERER in the current folder)
  --quick  a minute's worth, to see whether everything works
Exit codes: 0 done; 1 a step failed; 2 wrong usage; 4 all ran, and contacts of two detectors differ"
quick=
out=
for argument in "$@"; do
  case $argument in
    -h | --help) echo "$usage"; exit 0 ;;
    --quick) quick=yes ;;
    -*) echo "measure: error: there is no flag '$argument'" >&2; echo "$usage" >&2; exit 2 ;;
    *)
      [ -z "$out" ] || { echo "measure: error: only one folder" >&2; exit 2; }
      out=$argument
      ;;
  esac
done

# The renderer that --context auto takes names the folder: the JSON begins with it.
renderer=$(vestige devices --json - 2>/dev/null | sed -n 's/^ *"renderer": "\(.*\)",$/\1/p' | sed 1q)
name=$(printf %s "${renderer:-no OpenGL}" | tr '[:upper:]' '[:lower:]' | tr -cs 'a-z0-9' '-' | sed 's/^-*//; s/-*$//' | cut -c1-60)
out=${out:-results-$(date -u +%Y-%m-%d)-$name}
out=${out%/}
for existing in "$out" "$out.tar.gz"; do
  [ ! -e "$existing" ] || { echo "measure: error: $existing already exists: move it, or name another folder" >&2; exit 1; }
done
mkdir -p "$out/log" || exit 1

failed=
differs=

# step NAME COMMAND...: output goes to log/NAME.txt, its end to the terminal. Returns the command's exit code.
step() {
  step_name=$1
  shift
  echo "== $step_name: $*"
  "$@" >"$out/log/$step_name.txt" 2>&1 </dev/null
  code=$?
  tail -n 40 "$out/log/$step_name.txt" | cut -c1-160
  case $code in
    0) ;;
    4) differs="$differs $step_name" ;;
    *) failed="$failed $step_name($code)"; echo "measure: $step_name FAILED with $code" >&2 ;;
  esac
  return $code
}

machine() {
  uname -a
  sed -n 's/^PRETTY_NAME=//p' /etc/os-release
  sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | sort | uniq -c
  sed -n 's/^MemTotal: *//p' /proc/meminfo
  vestige --version
  if command -v nvidia-smi >/dev/null; then
    nvidia-smi && nvidia-smi -q >"$out/nvidia-smi.txt"
  else
    echo "nvidia-smi is not there"
  fi
}

if [ "$quick" ]; then
  duration=0.05 counts=1,10,100 sweep_flags="--min-time 0.02 --runs 2 --run-frames 5"
  accuracy_flags="--duration 0.05 --rate 60,1000 --truth-rate 2000" stress_flags="--n 3"
else
  duration=2 counts=1,2,4,6,8,10:100:5 sweep_flags= accuracy_flags= stress_flags=
fi

step machine machine
step devices vestige devices --json "$out/devices.json"
vestige devices >"$out/devices.txt" 2>&1

# Every scenario that this vestige knows, as it tells a shell.
scenarios=$(vestige complete record --colliders '' | sed -n 's/^\([a-z_-]*\)	.*/\1/p')
for scenario in ${scenarios:-swarm}; do
  step "record-$scenario" vestige record --colliders "$scenario" --count 100 --rate 1000 --duration "$duration" \
    -o "$out/$scenario.mcap" --json "$out/record-$scenario.json" || continue
  step "replay-$scenario-cpu" vestige replay "$out/$scenario.mcap" --detector cpu --json "$out/replay-$scenario-cpu.json"
  for detector in ${renderer:+paper geometry}; do
    step "replay-$scenario-$detector" vestige replay "$out/$scenario.mcap" --detector $detector --verify cpu \
      --json "$out/replay-$scenario-$detector.json"
  done
  for method in ${renderer:+carried ccd}; do
    step "replay-$scenario-geometry-$method" vestige replay "$out/$scenario.mcap" --detector geometry --method $method \
      --verify cpu --json "$out/replay-$scenario-geometry-$method.json"
  done
done

sweep_on=
for scenario in swarm $scenarios; do
  [ -z "$sweep_on" ] && [ -e "$out/$scenario.mcap" ] && sweep_on=$out/$scenario.mcap
done
if [ -n "$sweep_on" ]; then
  # One command measures all contexts, taking turns.
  # shellcheck disable=SC2086  # a list of words
  step sweep vestige sweep "$sweep_on" --detector paper,geometry,cpu,embree --counts "$counts" $sweep_flags --no-figure -o "$out/sweep"
else
  failed="$failed sweep(no trace)"
fi

# shellcheck disable=SC2086  # lists of words
step accuracy vestige accuracy $accuracy_flags --no-figure -o "$out/accuracy"
# shellcheck disable=SC2086
step stress vestige stress $stress_flags --no-figure -o "$out/stress"
step claims vestige claims "$out" -o "$out/README.md"

[ -z "$differs" ] || printf '\nContacts differ in:%s\n' "$differs" >>"$out/README.md"
[ -z "$failed" ] || printf '\nFAILED:%s\n' "$failed" >>"$out/README.md"
if command -v tar >/dev/null && command -v gzip >/dev/null; then
  tar -C "$(dirname -- "$out")" -czf "$out.tar.gz" "$(basename -- "$out")" || failed="$failed tar"
  echo "Packed: $out.tar.gz"
fi
echo "Results: $out (look at README.md, devices.txt, log/)"
[ -z "$differs" ] || echo "NOTE: contacts of two detectors differ in:$differs" >&2
if [ -n "$failed" ]; then
  echo "measure: error: these steps failed:$failed; see $out/log" >&2
  exit 1
fi
[ -z "$differs" ] || exit 4
