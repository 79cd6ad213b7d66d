#!/usr/bin/env bash
# Builds the command, the library and the tests, and runs the tests; the last lines are ctest's own summary.
#
#   ./test.sh                 unit tests, models, documentation, page, installation, format
#   ./test.sh --sanitized     also those under the second compiler with sanitizers, and fuzzing
#   ./test.sh --all           also the long tests: large inputs, long runs
#   ./test.sh -R architecture the tests whose name matches; arguments go to ctest
#
# If no file and no compiler has changed since the tests passed, `./test.sh` repeats only those that take a minute together.
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

all=
if [[ ${1-} == --all || ${1-} == --sanitized ]]; then
  all=$1
  shift
fi
setup_packages test
say "building the command, the library and the tests"
cmake --preset release -DCONTINUO_TESTS=ON -DCONTINUO_CHECKS=ON -DCONTINUO_PYTHON=ON -DCMAKE_UNITY_BUILD=ON >&2
touch build/.built.began
cmake --build build >&2
mv build/.built.began build/.built
cp -p build/.built build/.built_studies  # continuo.sh finds both programs of the command fresh

# One more than there are processors, as the tests of the page, which run one at a time, mostly wait for the browser.
tests=(ctest --test-dir build --output-on-failure --parallel "$(($(nproc) + 1))")
if (($#)); then exec "${tests[@]}" "$@"; fi
state=$(state_of_checkout)
if [[ -z $all && -n $state && -e build/.tested && $(<build/.tested) == "$state" ]]; then
  say "nothing has changed since the tests passed: only the short ones run again (all of them: ./test.sh --all)"
  exec "${tests[@]}" -R '^(architecture|boundary|docs|gallery|language|numerics|results|runs|solve|status|symbolic|system|worlds)'
fi
rm -f build/.tested
if [[ $all != --all ]]; then
  say "without the long tests (all of them: ./test.sh --all)"
  tests+=(--exclude-regex "$(<build/long_tests.txt)")
fi
if [[ -z $all ]]; then tests+=(--label-exclude long); fi
"${tests[@]}"
printf '%s\n' "$state" >build/.tested
