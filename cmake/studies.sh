#!/usr/bin/env bash
# Started by the command in the place of its program continuo-studies where continuo.sh has started the command: builds the
# program when a verb needs it for the first time, and when the sources have changed, and becomes it.
set -euo pipefail

root=${BASH_SOURCE[0]%/*}/..
build=$root/build
# shellcheck source=cmake/setup.sh
source "$root/cmake/setup.sh"

setup_program continuo-studies
exec -a continuo "$build/continuo-studies" "$@"
