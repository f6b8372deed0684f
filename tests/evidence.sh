#!/usr/bin/env bash
# The dam break against the experiment: runs the paper's scheme and the recommended one to T = 8,
# prints both reports, then one line per requirement, pass or fail. Takes minutes. The height of the
# first peak depends on where single particles hit: five more runs of the paper's scheme to T = 5.2,
# each started with its own displacement of 1e-4 dx, tell its spread, and their median is judged.
#
#   tests/evidence.sh [SLUICE]      SLUICE: the program; default: built in build/release
#
# Exits 0 only when every line passes. Set KEEP to a folder to keep the two job folders there.
set -euo pipefail
cd "$(dirname "$0")/.."

program=${1:-}
if [[ -z $program ]]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target sluice
  program=build/release/cli/sluice
fi

if [[ -n ${KEEP:-} ]]; then
  work=$KEEP
  mkdir -p "$work"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

for case in dambreak-paper dambreak; do
  echo "== $case"
  if [[ -d $work/$case ]]; then
    "$program" run "$work/$case" >"$work/$case.log"
  else
    "$program" run "schemas/examples/$case.json" --folder "$work/$case" >"$work/$case.log"
  fi
  "$program" report "$work/$case"
  "$program" report "$work/$case" --json >"$work/$case.report.json"
  echo
done

echo "== first peak at P1 of five displaced runs"
peaks=()
for seed in 1 2 3 4 5; do
  job=$work/peak-$seed
  python3 - "$seed" schemas/examples/dambreak-paper.json >"$work/peak-$seed.json" <<'END'
import json, sys
scene = json.load(open(sys.argv[2], encoding="utf-8"))
scene["jitter"] = {"amplitude": 1e-4, "seed": int(sys.argv[1])}
scene["end_time"] = 0.92  # T = 5.2: the first peak is looked for until T = 5
scene.pop("output", None)
json.dump(scene, sys.stdout)
END
  target=$work/peak-$seed.json
  [[ -d $job ]] && target=$job
  "$program" run "$target" $([[ -d $job ]] || echo "--folder $job") >"$work/peak-$seed.log"
  "$program" report "$job" --json >"$work/peak-$seed.report.json"
  peaks+=("$work/peak-$seed.report.json")
done

python3 tests/study/check_evidence.py "$work/dambreak-paper.report.json" \
  "$work/dambreak.report.json" "${peaks[@]}"
