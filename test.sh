#!/usr/bin/env bash
# Builds everything and runs every test; the last lines are ctest's own summary. Arguments go to ctest:
#
#   ./test.sh                 all of it: unit tests, models, sanitizers, fuzzing, both compilers, format, install
#   ./test.sh -R architecture only the tests whose name matches
#
# Where no file and no compiler has changed since all tests passed, only those that take a minute together run again;
# `./test.sh --all` runs every test all the same.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")"
root=$PWD
source cmake/setup.sh

# A hash of everything on which the results depend; empty if this is no checkout of git.
state_of_checkout() {
  git rev-parse --is-inside-work-tree >/dev/null 2>&1 || return 0
  { git ls-files -co --exclude-standard -z | xargs -0 sha256sum 2>/dev/null
    c++ --version; clang++-19 --version; cmake --version; } | sha256sum
}

again=
if [[ ${1-} == --all ]]; then
  again=yes
  shift
fi
setup_packages test
say "building the command, the library and the tests"
cmake --preset release -DCONTINUO_TESTS=ON -DCONTINUO_CHECKS=ON -DCMAKE_UNITY_BUILD=ON >&2
touch build/.built.began
cmake --build build >&2
mv build/.built.began build/.built  # continuo.sh finds the command fresh

tests=(ctest --test-dir build --output-on-failure --parallel "$(nproc)")
if (($#)); then exec "${tests[@]}" "$@"; fi
state=$(state_of_checkout)
if [[ -z $again && -n $state && -e build/.tested && $(<build/.tested) == "$state" ]]; then
  say "nothing has changed since all tests passed: only the short ones run again (all of them: ./test.sh --all)"
  exec "${tests[@]}" -R '^(architecture|boundary|docs|gallery|language|numerics|results|runs|solve|status|symbolic|system|worlds)'
fi
rm -f build/.tested
"${tests[@]}"
printf '%s\n' "$state" >build/.tested
