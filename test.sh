#!/usr/bin/env bash
# Builds everything and runs every test; the last lines are ctest's own summary. Arguments go to ctest:
#
#   ./test.sh                 all of it: unit tests, models, sanitizers, fuzzing, both compilers, format, install
#   ./test.sh -R architecture only the tests whose name matches
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")"
root=$PWD
source cmake/setup.sh

setup_packages test
say "building the command, the library and the tests"
cmake --preset release -DCONTINUO_TESTS=ON -DCONTINUO_CHECKS=ON -DCMAKE_UNITY_BUILD=ON >&2
touch build/.built.began
cmake --build build >&2
mv build/.built.began build/.built  # continuo.sh finds the command fresh

exec ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
