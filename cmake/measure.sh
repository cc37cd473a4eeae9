#!/bin/sh
# Measures this machine with the programs beside this script: contexts, agreement with slower exact checks, replays with
# and without skipping, the sweep over collider counts, accuracy. Each step's output is kept in log/. A step that fails
# does not keep the others from running. The verdict at the end says what all of it shows.
set -u
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 1
PATH=$here/bin:$PATH
export PATH

usage="usage: measure [--quick | --short] [--pairs N] [FOLDER]
  FOLDER     where the results go (default: results-DATE-RENDERER in the current folder)
  --quick    less than a minute instead of about an hour, to see whether everything works
  --short    a few minutes, where an hour cannot be had: all steps, with fewer pairs, frames and counts
  --pairs N  adversarial pairs that each method decides; of spheres, a twentieth (default: 10000000; 500000 with
             --short, 5000 with --quick)
Exit codes: 0 exact, and all steps ran; 1 not exact, or a step failed; 2 wrong usage"
wrong_usage() {
  echo "measure: error: $1" >&2
  echo "$usage" >&2
  exit 2
}
size=full
pairs=
out=
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) echo "$usage"; exit 0 ;;
    --quick | --short)
      [ "$size" = full ] || wrong_usage "either --quick or --short"
      size=${1#--}
      ;;
    --pairs)
      case ${2:-} in '' | *[!0-9]* | 0*) wrong_usage "--pairs: '${2:-}' is not a number of pairs" ;; esac
      pairs=$2
      shift
      ;;
    -*) wrong_usage "there is no flag '$1'" ;;
    *)
      [ -z "$out" ] || wrong_usage "only one folder"
      out=$1
      ;;
  esac
  shift
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
paper_differs=

# step NAME COMMAND...: output goes to log/NAME.txt, its end to the terminal. Returns the command's exit code: 4 says that
# contacts differ.
step() {
  step_name=$1
  shift
  echo "== $step_name: $*"
  "$@" >"$out/log/$step_name.txt" 2>&1 </dev/null
  code=$?
  tail -n 40 "$out/log/$step_name.txt" | cut -c1-160
  case $code-$step_name in
    0-*) ;;
    4-*-paper) paper_differs="$paper_differs $step_name" ;;
    4-*) differs="$differs $step_name" ;;
    *) failed="$failed $step_name($code)"; echo "measure: $step_name FAILED with $code" >&2 ;;
  esac
  return $code
}

# into FILE COMMAND...: writes standard output to FILE, which is complete or absent.
into() {
  into_file=$1
  shift
  "$@" >"$into_file.part"
  into_code=$?
  case $into_code in
    0 | 4) mv "$into_file.part" "$into_file" ;;
    *) rm -f "$into_file.part" ;;
  esac
  return $into_code
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

case $size in
  quick)
    pairs=${pairs:-5000} duration=0.05 counts=1,100 sweep_flags="--min-time 0.02 --runs 2 --run-frames 5"
    accuracy_flags="--detector paper,cpu,boxes --duration 0.05 --rate 60,1000 --truth-rate 2000 --events 1 --passes 1 --check-frames 5"
    stress_flags="--n 3"
    ;;
  short)
    pairs=${pairs:-500000} duration=0.25 counts=1,10:100:10 sweep_flags="--min-time 0.25"
    accuracy_flags="--detector paper,geometry,compute,cpu,embree,boxes --duration 0.25 --rate 60,250,1000 --events 1 --passes 2 --check-frames 5"
    stress_flags="--n 20"
    ;;
  *)
    pairs=${pairs:-10000000} duration=2 counts=1,2,4,6,8,10:100:5 sweep_flags='' accuracy_flags='' stress_flags=''
    ;;
esac

step machine machine
step devices vestige devices --json "$out/devices.json"
vestige devices >"$out/devices.txt" 2>&1
# What it says of the context that --context auto takes.
device=$(awk '/^\*/ && !seen {on = seen = 1; print; next} /^ ? ?[^ ]/ {on = 0} on' "$out/devices.txt")
refused=$(printf '%s\n' "$device" | sed -n "s/^ *'geometry' is refused there: //p")
geometry=
[ -z "$renderer" ] || [ "$refused" ] || geometry=geometry

# The driver's own messages go to the logs of all that is not timed.
VESTIGE_GL_DEBUG=1
export VESTIGE_GL_DEBUG

threads=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
# agreements INFIX PAIRS FLAGS...: of each method, to agreement-{geometry,cpu}-INFIX{METHOD}.json.
agreements() {
  infix=$1
  count=$2
  shift 2
  for method in ${geometry:+static carried ccd}; do
    step "agreement-geometry-$infix$method" into "$out/agreement-geometry-$infix$method.json" \
      geometry_agreement "$@" --method "$method" --skip --pairs "$count"
  done
  for method in static ccd; do
    step "agreement-cpu-$infix$method" into "$out/agreement-cpu-$infix$method.json" \
      agreement "$@" --method $method --pairs "$count" --threads "$threads"
  done
}
agreements '' "$pairs"
# Spheres are decided by other code, whose slow truth is slower.
agreements spheres- $(((pairs + 19) / 20)) --spheres

# replay NAME FLAGS...: through a detector, to replay-NAME.json.
replay() {
  replay_name=$1
  shift
  step "replay-$replay_name" vestige replay "$out/$scenario.mcap" "$@" --json "$out/replay-$replay_name.json"
}

# Every scenario that this vestige knows, as it tells a shell.
scenarios=$(vestige complete record --colliders '' | sed -n 's/^\([a-z_-]*\)	.*/\1/p' | grep -vx none)
[ "$size" != quick ] || scenarios="swarm hug touch"
compared=0
equal=0
for scenario in ${scenarios:-swarm}; do
  count='--count 100'
  [ "$scenario" != touch ] || count='' # the limbs of its people are its colliders
  # shellcheck disable=SC2086  # a list of words
  step "record-$scenario" vestige record --colliders "$scenario" $count --rate 1000 --duration "$duration" \
    -o "$out/$scenario.mcap" --json "$out/record-$scenario.json" || continue
  for method in static carried ccd; do
    # All exact detectors write the texture of cpu without skipping.
    truth=$scenario-cpu-$method-off
    replay "$truth" --detector cpu --method $method --skip off || continue
    for contestant in cpu-on ${geometry:+geometry-off geometry-on compute-off compute-on}; do
      detector=${contestant%-*}
      skip=${contestant#*-}
      replay "$scenario-$detector-$method-$skip" --detector "$detector" --method $method --skip "$skip" \
        --verify "$out/replay-$truth.json"
      case $? in
        0) compared=$((compared + 1)) equal=$((equal + 1)) ;;
        4)
          compared=$((compared + 1))
          # By which contacts: the program does not compare cpu with itself.
          [ "$detector" = cpu ] || replay "$scenario-$detector-$method-$skip-contacts" --detector "$detector" \
            --method $method --skip "$skip" --verify cpu
          ;;
      esac
    done
  done
  [ -z "$renderer" ] || replay "$scenario-paper" --detector paper --verify cpu
done

# shellcheck disable=SC2086  # lists of words
step stress vestige stress $stress_flags --no-figure -o "$out/stress"
unset VESTIGE_GL_DEBUG

sweep_on=
for scenario in swarm $scenarios; do
  [ -z "$sweep_on" ] && [ -e "$out/$scenario.mcap" ] && sweep_on=$out/$scenario.mcap
done
if [ -n "$sweep_on" ]; then
  # One command measures all contexts, taking turns.
  # shellcheck disable=SC2086  # a list of words
  step sweep vestige sweep "$sweep_on" --detector paper,geometry,compute,cpu,embree --skip off,on --counts "$counts" $sweep_flags \
    --no-figure -o "$out/sweep"
else
  failed="$failed sweep(no-trace)"
fi

# shellcheck disable=SC2086
step accuracy vestige accuracy $accuracy_flags --no-figure -o "$out/accuracy"
step claims vestige claims "$out" -o "$out/README.md"

# sum FIELD FILE...: of a number in JSON files.
sum() {
  field=$1
  shift
  cat "$@" 2>/dev/null | sed -n "s/^ *\"$field\": \([0-9]*\),*\$/\1/p" | awk '{n += $1} END {printf "%.0f\n", n}'
}

# A line for each series of the sweep with most colliders: frequency, and how many times the fastest cpu's that is.
speeds() {
  [ -e "$out/sweep/sweep.json" ] || { echo "    not measured"; return; }
  awk '
    function text() { sub(/^[^:]*: "/, ""); sub(/".*/, ""); return $0 }
    function number() { sub(/^[^:]*: /, ""); sub(/,.*/, ""); return $0 + 0 }
    /^      "detector":/ { detector[++n] = text() }
    /^      "context":/ { context[n] = text() }
    /^      "skip":/ { skip[n] = text() }
    /^          "colliders":/ { colliders = number() }
    /^          "hz":/ { hz[n] = number() }
    END {
      for (i = 1; i <= n; ++i) if (detector[i] == "cpu" && hz[i] > cpu) cpu = hz[i]
      printf "    With %d colliders, against the fastest cpu:\n", colliders
      for (i = 1; i <= n; ++i)
        printf "    %-8s  skip %-3s  %9.0f Hz  %8.3g x  %s\n", detector[i], skip[i], hz[i], cpu ? hz[i] / cpu : 0, context[i]
    }' "$out/sweep/sweep.json"
}

gl_messages() {
  if [ -z "$renderer" ]; then
    echo "none: no OpenGL"
  elif ! grep -q '^OpenGL debug: marker' "$out"/log/*.txt; then
    echo "not known: this driver passes no messages on"
  else
    cat "$out"/log/*.txt | sed -n 's/^OpenGL debug: //p' | grep -v '^marker' | sort | uniq -c | sort -rn >"$out/gl-messages.txt"
    echo "errors: $(grep -c '^ *[0-9]* error' "$out/gl-messages.txt"), others: $(grep -vc '^ *[0-9]* error' "$out/gl-messages.txt"), each text counted once: $out/gl-messages.txt"
    grep '^ *[0-9]* error' "$out/gl-messages.txt" | head -n 3 | cut -c1-150
  fi
}

# Each step that is named, with its log.
logs_of() {
  for one in $1; do
    one_log=$out/log/${one%(*}.txt
    [ -e "$one_log" ] && echo "    $one: $one_log" || echo "    $one"
  done
}

verdict() {
  where=${renderer:-the CPU; this machine offers no OpenGL 4.5}
  if [ "$differs" ]; then
    echo "VERDICT: NOT EXACT on $where: contacts differ"
  elif [ "$refused" ]; then
    echo "VERDICT: NOT KNOWN TO BE EXACT on $where: geometry is refused, $refused"
  elif [ "$failed" ]; then
    echo "VERDICT: INCOMPLETE on $where: steps failed"
  else
    echo "VERDICT: EXACT on $where"
  fi
  echo "Device:"
  printf '%s\n' "${device:-    cpu}" | sed 's/^\* /    /; s/^  */    /'
  echo "Agreement:"
  [ -z "$geometry" ] || echo "    geometry and compute, with and without skipping, and cpu with it, against cpu without: $(sum missed "$out"/agreement-geometry-*.json) missed, $(sum winners_differing "$out"/agreement-geometry-*.json) other winners, of $(sum pairs "$out"/agreement-geometry-*.json) answers"
  cat "$out"/agreement-cpu-*.json 2>/dev/null | sed -n '/"total"/,/}/p' >"$out/agreement-total.part"
  echo "    cpu, against rational arithmetic: $(sum differences "$out/agreement-total.part") differ, of $(sum pairs "$out/agreement-total.part") answers"
  rm -f "$out/agreement-total.part"
  echo "    replays with the texture of cpu without skipping: $equal of $compared"
  echo "OpenGL messages:"
  gl_messages | sed 's/^ */    /'
  echo "Speed:"
  speeds
  if [ "$differs" ]; then
    echo "Contacts differ in:"
    logs_of "$differs"
  fi
  [ -z "$paper_differs" ] || echo "Contacts of paper, which does not promise to be exact, differ in:$paper_differs"
  if [ "$failed" ]; then
    echo "FAILED:"
    logs_of "$failed"
  fi
}

verdict >"$out/verdict.txt"
{
  printf '\n```\n'
  cat "$out/verdict.txt"
  printf '```\n'
} >>"$out/README.md"
if command -v tar >/dev/null && command -v gzip >/dev/null; then
  tar -C "$(dirname -- "$out")" -czf "$out.tar.gz" "$(basename -- "$out")" || failed="$failed tar"
  echo "Packed: $out.tar.gz"
fi
echo "Results: $out (look at verdict.txt, README.md, devices.txt, log/)"
echo
cat "$out/verdict.txt"
[ -z "$failed" ] || echo "measure: error: these steps failed:$failed; see $out/log" >&2
[ -z "$differs$refused$failed" ] || exit 1
