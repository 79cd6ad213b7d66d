#!/usr/bin/env bash
# Measures again and writes docs/benchmarks_stiff.md: bench/stiff/run.sh [SECONDS PER PROBLEM].
exec "$(dirname "${BASH_SOURCE[0]}")/../compare.sh" stiff "$@"
