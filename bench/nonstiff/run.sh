#!/usr/bin/env bash
# Measures again and writes docs/benchmarks_nonstiff.md: bench/nonstiff/run.sh [SECONDS PER PROBLEM].
exec "$(dirname "${BASH_SOURCE[0]}")/../compare.sh" nonstiff "$@"
