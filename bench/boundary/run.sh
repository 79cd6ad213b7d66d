#!/usr/bin/env bash
# Ours against SciPy: bench/boundary/run.sh. Let the machine do nothing else meanwhile. PYTHON names the interpreter that has
# SciPy (the distribution's: /usr/bin/python3 with python3-scipy).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cmake -S "$root" -B "$root/build-bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCONTINUO_BENCH=ON -DCONTINUO_TESTS=OFF \
  -DCONTINUO_APP=OFF >&2
cmake --build "$root/build-bench" --target boundary_ours >&2
"$root/build-bench/bench/boundary_ours" | "${PYTHON:-/usr/bin/python3}" "$root/bench/boundary/against_scipy.py"
