#!/usr/bin/env bash
# The first five minutes with Sluice, from a fresh clone: installs what is needed, builds, runs the
# paper's dam break (20 000 particles to T = 8), kills it with kill -9 half way, resumes it, prints
# filtered pressures and the comparison with the experiment. Everything it makes is in build/ and a
# temporary folder that it removes, so that it can be run again and again.
#
#   deploy/quickstart.sh [SCENE.json]      default: schemas/examples/dambreak-paper.json
set -euo pipefail
cd "$(dirname "$0")/.."

scene=${1:-schemas/examples/dambreak-paper.json}
if [[ $scene == -h || $scene == --help ]]; then
  sed -n '2,7s/^# \{0,1\}//p' "$0"
  exit 0
fi
[[ -r $scene ]] || { echo "quickstart.sh: cannot read the scene $scene" >&2; exit 2; }

work=$(mktemp -d)
job=$work/job
pid=
clean_up() {
  if [[ -n $pid ]]; then kill -9 "$pid" 2>/dev/null || true; fi
  rm -rf "$work"
}
trap clean_up EXIT

say() { printf '\n== %s\n' "$1"; }

# Share of the run that is done, in percent, by the progress lines in $1.
percent_done() {
  local share
  share=$(sed -n 's/.*"fraction":\([0-9.e+-]*\).*/\1/p' "$1" | tail -n 1)
  awk -v share="${share:-0}" 'BEGIN { printf "%d", 100 * share }'
}

# Follows the run in the background until it ends or, with a second argument, has done that much.
follow() {
  local log=$1 until=${2:-1000} done_now=0 shown=-10
  while kill -0 "$pid" 2>/dev/null; do
    done_now=$(percent_done "$log")
    if [[ -t 1 ]]; then
      printf '\r  %3d %% of the model time' "$done_now"
    elif ((done_now >= shown + 10)); then
      printf '  %d %% of the model time\n' "$done_now"
      shown=$done_now
    fi
    ((done_now >= until)) && break
    sleep 0.2
  done
  if [[ -t 1 ]]; then echo; fi
}

start() {
  "$sluice" run "$@" --progress json >"$work/progress" 2>"$work/summary" &
  pid=$!
}

say "install what is needed"
deploy/install-dependencies.sh

say "build"
cmake -S . -B build/quickstart -G Ninja -DCMAKE_BUILD_TYPE=Release -DSLUICE_TESTS=OFF >"$work/configure" ||
  { cat "$work/configure"; exit 1; }
cmake --build build/quickstart --target sluice
sluice=build/quickstart/cli/sluice
"$sluice" --version

say "run $scene, and kill it half way"
start "$scene" --folder "$job"
follow "$work/progress" 50
if kill -9 "$pid" 2>/dev/null; then echo "  killed with kill -9"; fi
wait "$pid" 2>/dev/null || true
pid=
ls "$job" | sed 's/^/  left in the folder: /'

say "go on: sluice run FOLDER"
start "$job"
follow "$work/progress"
status=0
wait "$pid" || status=$?
pid=
cat "$work/summary"
if ((status != 0)); then
  echo "quickstart.sh: the resumed run ended with exit code $status" >&2
  exit "$status"
fi

say "filtered pressure at P1 (sluice sensors FOLDER P1 --filter gaussian --tau 0.002), 30 of its lines"
"$sluice" sensors "$job" P1 --filter gaussian --tau 0.002 --format csv >"$work/P1.csv"
awk 'NR == FNR { lines = FNR; next } FNR == 1 || FNR % (int(lines / 30) + 1) == 0' "$work/P1.csv" "$work/P1.csv"

say "against the experiment (sluice report FOLDER)"
"$sluice" report "$job"

say "done in $SECONDS s; the program is $sluice"
