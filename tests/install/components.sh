#!/usr/bin/env bash
# usage: components.sh CMAKE COMPILER PREFIX
# Programs with one component of the installation, on a system that has nothing but the compiler: of /usr/include they
# see only what the standard library reads, and CMake looks for packages and libraries in PREFIX alone.
set -euo pipefail
cmake=$1 compiler=$2 prefix=$3
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

mkdir "$scratch/include"
echo '#include <bits/stdc++.h>' | "$compiler" -std=c++20 -M -x c++ - | tr -s ' \\' '\n' |
  sed -n 's|^/usr/include/\([^/]*\).*|\1|p' | sort -u |
  while read -r name; do ln -s "/usr/include/$name" "$scratch/include/$name"; done
# The parallel algorithms of the standard library read oneTBB where it is installed; no header of ours includes them.
rm -f "$scratch"/include/{tbb,oneapi}
flags="-nostdinc -nostdinc++"
for folder in $("$compiler" -E -v -x c++ /dev/null 2>&1 | sed -n '/^#include <\.\.\.>/,/^End of search/s|^ \(/.*\)|\1|p'); do
  if [[ $folder -ef /usr/include ]]; then folder=$scratch/include; fi
  if [[ ! $folder -ef /usr/local/include ]]; then flags+=" -isystem $folder"; fi
done

configure() {  # build-folder component...
  local build=$1
  shift
  "$cmake" -S "$here/bare" -B "$scratch/$build" -G Ninja -DCMAKE_MAKE_PROGRAM="$(command -v ninja)" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF -DCOMPONENTS="$*" 2>&1
}
must_say() {  # text sentence: line breaks and indents of the text do not count
  if [[ $(tr -s ' \n' ' ' <<<"$1") != *"$2"* ]]; then
    printf 'expected: %s\ngot: %s\n' "$2" "$1" >&2
    exit 1
  fi
}

configure solve solve >"$scratch/log" || { cat "$scratch/log" >&2; exit 1; }
"$cmake" --build "$scratch/solve" >"$scratch/log" || { cat "$scratch/log" >&2; exit 1; }
for program in nonstiff stiff events precompiled; do "$scratch/solve/$program"; done

must_say "$("$cmake" --build "$scratch/solve" --target pattern 2>&1 || true)" \
  "needs the sparse solver KLU: install libsuitesparse-dev"
must_say "$(configure bodies bodies || true)" \
  "the component bodies needs packages that are not installed: libqhull-dev libtbb-dev libxsimd-dev libsuitesparse-dev"
must_say "$(configure language 'solve;language' || true)" \
  "the component language needs packages that are not installed: libqhull-dev libfmt-dev libudunits2-dev nlohmann-json3-dev"
must_say "$(configure unknown solver || true)" "there is no component solver, but status numerics system methods solve"
must_say "$(configure everything || true)" "find_package(Continuo COMPONENTS solve)"
