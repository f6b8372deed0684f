#!/usr/bin/env bash
# The dam break against the experiment: runs the paper's scheme and the recommended one to T = 8,
# prints both reports, then one line per requirement, pass or fail. Takes minutes.
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

python3 tests/study/check_evidence.py "$work/dambreak-paper.report.json" "$work/dambreak.report.json"
