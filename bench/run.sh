#!/usr/bin/env bash
# Builds the benchmarks and runs them: bench/run.sh [SECONDS PER PROBLEM]. Tables, curves and plots go to
# build-bench/results; RESULTS.md beside this file says what they mean. Let the machine do nothing else meanwhile.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
results=$root/build-bench/results
cmake -S "$root" -B "$root/build-bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCONTINUO_BENCH=ON -DCONTINUO_TESTS=OFF \
  -DCONTINUO_APP=OFF
cmake --build "$root/build-bench" --target against_odeint event_cost tape_cost
mkdir -p "$results"
"$root/build-bench/bench/against_odeint" "$results" "${1:-15}"
"$root/build-bench/bench/event_cost" | tee "$results/events.md"
"$root/build-bench/bench/tape_cost" "$root/models" | tee "$results/tape.md"
if command -v gnuplot >/dev/null; then
  for plot in "$results"/*.gp; do gnuplot "$plot"; done
fi
