#!/usr/bin/env bash
# The dam break against the experiment: runs the paper's scheme and the recommended one to T = 8,
# prints both reports, then one line per requirement, pass or fail. Takes minutes. What follows an
# impact depends on where single particles hit: five more runs of the paper's scheme to T = 5.2 tell
# the spread of its first peak, three more of the recommended one that of its error, each started
# with its own displacement of 1e-4 dx. Their medians are judged.
#
#   tests/validation.sh [SLUICE]      SLUICE: the program; default: built in build/release
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

# displaced SCENE SEED END: runs SCENE from displaced particles to END, s; prints the report's path.
displaced() {
  local scene=$1 seed=$2 end=$3 job=$work/$1-displaced-$2 target
  python3 - "schemas/examples/$scene.json" "$seed" "$end" >"$job.json" <<'END'
import json, sys
scene = json.load(open(sys.argv[1], encoding="utf-8"))
scene["perturbation"] = {"amplitude": 1e-4, "seed": int(sys.argv[2])}
scene["end_time"] = float(sys.argv[3])
scene.pop("output", None)
json.dump(scene, sys.stdout)
END
  target=("$job.json" --folder "$job")
  [[ -d $job ]] && target=("$job")
  "$program" run "${target[@]}" >"$job.log"
  "$program" report "$job" --json >"$job.report.json"
  echo "$job.report.json"
}

echo "== displaced runs"
peaks=()
for seed in 1 2 3 4 5; do
  peaks+=("$(displaced dambreak-paper "$seed" 0.92)")  # T = 5.2: the first peak is looked for until T = 5
done
errors=()
for seed in 1 2 3; do errors+=("$(displaced dambreak "$seed" 1.399)"); done

python3 tests/report/check_validation.py "$work/dambreak-paper.report.json" "$work/dambreak.report.json" \
  --peaks "${peaks[@]}" --errors "${errors[@]}"
