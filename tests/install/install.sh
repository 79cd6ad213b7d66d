#!/usr/bin/env bash
# usage: install.sh CMAKE BUILD COMPILER
set -euo pipefail
cmake=$1 build=$2 compiler=$3
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT

"$cmake" --install "$build" --prefix "$prefix" >/dev/null
# Public headers are directly in a module; of the others only those that they include are installed.
(cd "$prefix/include" && ls continuo/*.hpp continuo/*/*.hpp) >"$prefix/headers"
mkdir "$prefix/consumer"
sed 's/.*/#include <&>/' "$prefix/headers" >"$prefix/consumer/public_headers.cpp"
for private in language/syntax/parser_core live/server/client studies/orbits/continuation/orbit_marks; do
  if [[ -e $prefix/include/continuo/$private.hpp ]]; then echo "$private.hpp is private, and installed" >&2; exit 1; fi
  if [[ ! -e $here/../../continuo/$private.hpp ]]; then echo "$private.hpp is no more" >&2; exit 1; fi
done

"$cmake" -S "$here/consumer" -B "$prefix/consumer" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
"$cmake" --build "$prefix/consumer"
"$here/components.sh" "$cmake" "$compiler" "$prefix"
cd "$prefix"
consumer/consumer
if [[ ! -x bin/continuo ]]; then exit 0; fi

# After installation the parts that the command loads are in another folder, unlike in the build folder. The whole
# installation can be moved, and the command can be called through a link.
mkdir moved
mv bin lib* moved/
ln -s moved/bin/continuo command
./command --version
printf 'param a = 1\nx\x27 = -a*x\nx(0) = 1\nrun 0..2 output 1\n' >decay.sim
printf 't,x\n0,1\n1,0.1353352832366127\n2,0.01831563888873418\n' >measured.csv
./command run decay.sim -o decay_of_command.nc
./command fit decay.sim measured.csv --param a
