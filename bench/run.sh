#!/usr/bin/env bash
# Measures what events, enclosures and the tape cost, and how far the default choice is off: bench/run.sh. Tables go to
# build-bench/results; RESULTS.md beside this file says what they mean. Against the peers: nonstiff/run.sh and
# stiff/run.sh. Let the machine do nothing else meanwhile.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
results=$root/build-bench/results
cmake -S "$root" -B "$root/build-bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCONTINUO_BENCH=ON -DCONTINUO_TESTS=OFF \
  -DCONTINUO_APP=OFF
cmake --build "$root/build-bench" --target event_cost tape_cost enclosure_cost choice_table residual_table
mkdir -p "$results"
"$root/build-bench/bench/event_cost" | tee "$results/events.md"
"$root/build-bench/bench/tape_cost" "$root/models" | tee "$results/tape.md"
"$root/build-bench/bench/enclosure_cost" | tee "$results/enclosure.md"
"$root/build-bench/bench/choice_table" | tee "$results/choice.md"
"$root/build-bench/bench/residual_table" | tee "$results/residual.md"
