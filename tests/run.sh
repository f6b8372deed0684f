#!/usr/bin/env bash
# Everything that is checked before a change goes in, from a fresh clone, in one command.
# Closes with one line, "N passed, N failed", and exits 0 only when nothing failed.
#
#   tests/run.sh                    release, format and asan
#   tests/run.sh STEP...            some of: release format asan tsan tidy
#
#   release   build and run all tests but those labelled "long" and "storm" (attacks and kills on the
#             service; ctest --preset release -L storm)
#   format    clang-format finds nothing to change
#   asan      the engine's tests under the address and undefined-behaviour sanitizers
#   tsan      the service's tests and those with "Thread" in their names under the thread
#             sanitizer; by name only, for the time of its build
#   tidy      clang-tidy finds nothing in engine/, service/ and cli/; by name only, for its time
#
# Builds are kept in build/release, build/asan and build/tsan, so that a second run is quick; tidy
# configures build/debug.
# Jobs side by side: SLUICE_JOBS, else the number of cores.
set -uo pipefail
cd "$(dirname "$0")/.."

steps=("$@")
((${#steps[@]})) || steps=(release format asan)
for step in "${steps[@]}"; do
  case "$step" in
    release | format | tidy | asan | tsan) ;;
    -h | --help) sed -n '2,18s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "run.sh: unknown step '$step'; try --help" >&2; exit 2 ;;
  esac
done

jobs=${SLUICE_JOBS:-$(nproc)}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0
failed=0
skipped=0
failures=()

say() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }
pass() { passed=$((passed + 1)); }
fail() {
  failed=$((failed + 1))
  failures+=("$1")
}

# build PRESET [TARGET...]: configure and build, all targets by default.
build() {
  local preset=$1
  shift
  local targets=()
  (($#)) && targets=(--target "$@")
  say "build $preset"
  cmake --preset "$preset" >"$scratch/configure" || { cat "$scratch/configure"; return 1; }
  cmake --build --preset "$preset" -j "$jobs" "${targets[@]}"
}

# check PRESET ARGUMENT...: run ctest with these arguments and add up what it counted.
check() {
  local preset=$1 report="$scratch/$1.xml" names tests=0 bad=0 left_out=0
  shift
  say "tests, $preset"
  ctest --preset "$preset" -j "$jobs" --no-tests=error --output-junit "$report" "$@"
  local status=$?
  if [[ -s $report ]]; then
    tests=$(grep -c '<testcase ' "$report")
    bad=$(grep -c '<testcase .*status="fail"' "$report")
    left_out=$(grep -cE '<testcase .*status="(notrun|disabled)"' "$report")
    names=$(sed -n 's/.*<testcase name="\([^"]*\)".*status="fail".*/\1/p' "$report")
    while read -r name; do [[ -n $name ]] && failures+=("$preset: $name"); done <<<"$names"
  fi
  passed=$((passed + tests - bad - left_out))
  failed=$((failed + bad))
  skipped=$((skipped + left_out))
  if ((status != 0 && bad == 0)); then fail "$preset: ctest ended with status $status"; fi
}

sources() { git ls-files -z --cached --others --exclude-standard -- '*.cpp' '*.hpp'; }

step_release() {
  if build release; then check release -LE 'long|storm'; else fail "release: build"; fi
}

step_format() {
  say "format"
  if sources | xargs -0 -r clang-format --dry-run -Werror; then pass; else fail "format"; fi
}

step_tidy() {
  say "tidy"
  # The commands of a build that compiles each file by itself.
  cmake --preset debug >"$scratch/configure" || { cat "$scratch/configure"; fail "tidy: configure"; return; }
  local root
  root=$(printf '%s' "$PWD" | sed 's/[][\.*^$+?(){}|]/\\&/g')
  local ours="^$root/(engine|service|cli)/"
  # The build's options are the compiler's, and clang does not know all of its warnings.
  if run-clang-tidy -quiet -p build/debug -j "$jobs" -extra-arg=-Wno-unknown-warning-option \
    -header-filter="$ours" "$ours" >"$scratch/tidy" 2>/dev/null; then
    pass
  else
    grep -vE '^clang-tidy|^$' "$scratch/tidy" | tail -n 200
    fail "tidy"
  fi
}

step_asan() {
  export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}
  export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
  # Properties hold for 100 cases each in the release build; here a quarter of them shows bad reads.
  export RC_PARAMS=${RC_PARAMS:-max_success=25}
  local parts=(space sph scene store export run draw study report)
  if build asan "${parts[@]/#/test_}"; then
    # Names of scripts begin small: they run the program, which is not built here. Damaged bits are each read in a child
    # process, which takes a sanitizer minutes; other kinds of damage are among these tests. Left out as well: what runs long
    # to hold a result against physics, over code that shorter tests go through; the integrators in double precision; pools
    # of space, which take long to pack; the growth of waves on lattices, which is plain arithmetic.
    local left_out='Damage\.OfAnyBit|KickDriftKickDouble|LeapFrogMixed|kick_drift_kick_double|leap_frog_mixed|LatticeGrowth'
    left_out+='|CalmStart|StillWater|HoldsStillWater|EnergyGuard|Leaks\.Through|SpaceFilling\.(Keeps|FillsAPrism|Packs)'
    left_out+='|WaterBesideABed|KeepsEveryExampleOnItsLattice'
    check asan -R "^($(IFS='|' && echo "${parts[*]}"))\.[A-Z]" -E "$left_out" -LE long
  else
    fail "asan: build"
  fi
}

step_tsan() {
  if build tsan test_sph test_scene test_execute test_service; then
    check tsan -R '^(execute|service)\.[A-Z]|[Tt]hread'
  else
    fail "tsan: build"
  fi
}

deploy/install-dependencies.sh --tests || exit 1
for step in "${steps[@]}"; do "step_$step"; done

say "summary"
((${#failures[@]})) && printf 'failed: %s\n' "${failures[@]}"
((skipped)) && echo "$skipped skipped"
echo "$passed passed, $failed failed"
((failed == 0 && passed > 0))
