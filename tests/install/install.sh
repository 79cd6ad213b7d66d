#!/usr/bin/env bash
# usage: install.sh CMAKE BUILD COMPILER
set -euo pipefail
cmake=$1 build=$2 compiler=$3
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT

"$cmake" --install "$build" --prefix "$prefix" >/dev/null
"$cmake" -S "$here/consumer" -B "$prefix/consumer" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
"$cmake" --build "$prefix/consumer"
"$prefix/consumer/consumer"
if [[ -x $prefix/bin/continuo ]]; then "$prefix/bin/continuo" --version; fi
