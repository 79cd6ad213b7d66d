#!/usr/bin/env bash
# Measures one side and writes its page in docs/ and the plots: bench/compare.sh stiff|nonstiff [SECONDS PER PROBLEM].
# Let the machine do nothing else meanwhile.
set -euo pipefail
side=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
results=$root/build-bench/results/$side
cmake -S "$root" -B "$root/build-bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCONTINUO_BENCH=ON -DCONTINUO_TESTS=OFF \
  -DCONTINUO_APP=OFF
cmake --build "$root/build-bench" --target "against_$side"
mkdir -p "$results"
cd "$root"
"$root/build-bench/bench/against_$side" "$results" "${2:-15}"
cp "$results/$side.md" "$root/docs/benchmarks_$side.md"
if command -v gnuplot >/dev/null; then
  for plot in "$results"/*.gp; do gnuplot "$plot"; done
  cp "$results"/*.svg "$root/docs/pictures/"
fi
