#!/usr/bin/env bash
# Feeds the fuzzers: what reads bytes from outside, under the address and undefined-behaviour
# sanitizers. Exits 0 only when none found anything.
#
#   tests/fuzz/run.sh [SECONDS [NAME...]]    600 each by default; all of: scene mesh http checkpoint
#
# Two run side by side. What they learn is kept in build/fuzz/corpus, and an input that broke
# something in build/fuzz/findings: run build/fuzz/tests/fuzz/fuzz_NAME FILE to see it again.
set -uo pipefail
cd "$(dirname "$0")/../.."

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
  sed -n '2,8s/^# \{0,1\}//p' "$0"
  exit 0
fi
seconds=${1:-600}
shift || true
names=("$@")
((${#names[@]})) || names=(scene mesh http checkpoint)

deploy/install-dependencies.sh --tests || exit 1
cmake --preset fuzz >/dev/null || exit 1
cmake --build --preset fuzz -j "${SLUICE_JOBS:-$(nproc)}" --target "${names[@]/#/fuzz_}" || exit 1

# seeds NAME: folders to begin with.
seeds() {
  echo "tests/fuzz/corpus/$1"
  [[ $1 == scene ]] && printf '%s\n' schemas/examples tests/scene/fixtures/{valid,invalid,beyond_schema}
}

# feed NAME: one fuzzer for its time; its words go to a log.
feed() {
  local name=$1 folders
  mkdir -p "build/fuzz/corpus/$name" build/fuzz/findings
  mapfile -t folders < <(seeds "$name")
  local options=(-max_total_time="$seconds" -timeout=30 -rss_limit_mb=2048 -print_final_stats=1
    -artifact_prefix="build/fuzz/findings/$name-")
  [[ -f tests/fuzz/$name.dict ]] && options+=(-dict="tests/fuzz/$name.dict")
  "build/fuzz/tests/fuzz/fuzz_$name" "${options[@]}" "build/fuzz/corpus/$name" "${folders[@]}" \
    >"build/fuzz/$name.log" 2>&1
}

# told NAME: what the log says in one line.
told() {
  local log=build/fuzz/$1.log
  printf '%s: %s inputs, %s edges of the code reached, %s inputs kept\n' "$1" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -d' ' -f2)" \
    "$(find "build/fuzz/corpus/$1" -type f | wc -l)"
}

failed=0
running=()
finish_first() {
  local name=${running[0]%%:*} pid=${running[0]##*:}
  running=("${running[@]:1}")
  if wait "$pid"; then
    told "$name"
  else
    failed=$((failed + 1))
    tail -n 40 "build/fuzz/$name.log"
    echo "$name: a finding, see above and build/fuzz/findings"
  fi
}
for name in "${names[@]}"; do
  feed "$name" &
  running+=("$name:$!")
  ((${#running[@]} < 2)) || finish_first
done
while ((${#running[@]})); do finish_first; done
echo "$seconds s each: $failed of ${#names[@]} fuzzers found something"
((failed == 0))
