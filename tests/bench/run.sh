#!/usr/bin/env bash
# Speed and memory, printed as tables with the machine's name. Takes about half an hour; nothing else
# should run meanwhile. Figures of different machines or days are not to be compared; ratios of one
# table are.
#
#   tests/bench/run.sh              everything below
#   tests/bench/run.sh speed        schemes x particles x precisions x threads (speed.py)
#   tests/bench/run.sh scale        both schemes from 20 000 to 4 million particles, one thread
#   tests/bench/run.sh targets      the paper's and the recommended scheme on each SIMD target
#   tests/bench/run.sh left-out     what a scene saves by leaving a term out (left_out_bench.cpp)
#   tests/bench/run.sh case         the whole dam break to T = 8, core-seconds and errors
#   tests/bench/run.sh sensors      what a thousand sensors cost a run (sensors.py)
#   tests/bench/run.sh memory       the most memory at once against the plan (memory.py)
#   tests/bench/run.sh work         instructions per particle and step, by function (instructions.py),
#                                   and what the core can do at best (core_bench.cpp)
set -euo pipefail
cd "$(dirname "$0")/../.."

parts=("$@")
((${#parts[@]})) || parts=(speed scale targets left-out case sensors memory work)
cmake --preset release -DSLUICE_BENCHMARKS=ON >/dev/null
cmake --build --preset release --target sluice bench_left_out bench_core -j "$(nproc)" >/dev/null
sluice=$PWD/build/release/cli/sluice

for part in "${parts[@]}"; do
  printf '\n== %s\n' "$part"
  case "$part" in
    speed) python3 tests/bench/speed.py "$sluice" schemas/examples ;;
    scale)
      python3 tests/bench/speed.py "$sluice" schemas/examples --precision mixed --threads 1 \
        --particles 2e4,1e5,5e5,2e6,4e6
      ;;
    targets)
      for simd in SSE4 AVX2 AVX3; do
        python3 tests/bench/speed.py "$sluice" schemas/examples --particles 2e4 --threads 1 \
          --simd "$simd" || echo "$simd does not run here"
      done
      ;;
    left-out)
      build/release/tests/bench_left_out --benchmark_enable_random_interleaving=true \
        --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
      ;;
    case)
      folder=$(mktemp -d)
      trap 'rm -rf "$folder"' EXIT
      for scene in dambreak-paper dambreak; do
        for threads in 1 2; do
          echo "-- $scene, $threads thread(s)"
          "$sluice" run "schemas/examples/$scene.json" --folder "$folder/$scene-$threads" \
            --threads "$threads" --progress none
        done
        "$sluice" report "$folder/$scene-1" | grep 'mean relative L2'
      done
      ;;
    sensors) python3 tests/bench/sensors.py "$sluice" schemas/examples ;;
    memory) python3 tests/bench/memory.py "$sluice" schemas/examples ;;
    work)
      python3 tests/bench/instructions.py "$sluice" schemas/examples --profile
      build/release/tests/bench_core
      ;;
    *) echo "run.sh: unknown part '$part'; see its first lines" >&2; exit 2 ;;
  esac
done
