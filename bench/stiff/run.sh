#!/usr/bin/env bash
# Measures the stiff methods and writes docs/benchmarks_stiff.md and its plots: bench/stiff/run.sh [SECONDS PER PROBLEM].
# Let the machine do nothing else meanwhile.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
results=$root/build-bench/results/stiff
cmake -S "$root" -B "$root/build-bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCONTINUO_BENCH=ON -DCONTINUO_TESTS=OFF \
  -DCONTINUO_APP=OFF
cmake --build "$root/build-bench" --target against_stiff
mkdir -p "$results"
"$root/build-bench/bench/against_stiff" "$results" "${1:-15}"
cp "$results/stiff.md" "$root/docs/benchmarks_stiff.md"
if command -v gnuplot >/dev/null; then
  for plot in "$results"/*.gp; do gnuplot "$plot"; done
  cp "$results"/*.svg "$root/docs/pictures/"
fi
