#!/usr/bin/env bash
# usage: refusals.sh SOURCE COMPILER [NUMBER ...]: all programs, or those with these numbers
# Compiles every program of mistakes.cpp. Each but the first must be refused: the first error names the mistake and a line
# of the program, in at most 25 lines.
set -uo pipefail
source=$1 compiler=$2
shift 2
chosen=" $* "
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
most_lines=25
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sed "/#pragma once/d" "$here/user.hpp" >"$scratch/user.hpp"
sed 's,#include "user.hpp",,' "$here/mistakes.cpp" >"$scratch/mistakes.cpp"
flags=(-std=c++20 "-I$source" -Wall -Wextra -fno-diagnostics-color)
if "$compiler" --version | grep -q clang; then
  # What the header alone needs is instantiated once. A program ends at its first error, which has its notes all the same:
  # otherwise the rest of some would be compiled for eight seconds.
  "$compiler" "${flags[@]}" -Xclang -fpch-instantiate-templates -x c++-header "$scratch/user.hpp" -o "$scratch/user.hpp.pch" ||
    exit 1
  flags+=(-include-pch "$scratch/user.hpp.pch" -Wfatal-errors)
else
  "$compiler" "${flags[@]}" -x c++-header "$scratch/user.hpp" -o "$scratch/user.hpp.gch" || exit 1
  flags+=(-include "$scratch/user.hpp")
fi

# The output of the compiler up to its second error.
first_error() {
  awk '/error:/ { if (++errors == 2) exit } /^In file included from|^[^ ].*: (In|At) / && errors == 1 { held = held $0 "\n"; next }
       { printf "%s%s\n", held, $0; held = "" }' "$1"
}

try() {
  local n=$1 expected=$2 first=$3 last=$4 log=$scratch/$1.log
  if (cd "$scratch" && "$compiler" "${flags[@]}" -DMISTAKE="$n" -fsyntax-only mistakes.cpp) >"$log" 2>&1; then
    [[ -z $expected ]] || echo "program $n compiles; expected: $expected"
    return
  fi
  if [[ -z $expected ]]; then
    echo "program $n has no mistake, and does not compile:"
    head -n 40 "$log"
    return
  fi
  local text lines line found=
  text=$(first_error "$log")
  lines=$(wc -l <<<"$text")
  ((lines <= most_lines)) || echo "program $n: the first error has $lines lines"
  grep -qF -- "$expected" <<<"$text" || { echo "program $n: the first error does not name the mistake: $expected"; head -n 12 <<<"$text"; }
  for line in $(grep -oE 'mistakes\.cpp:[0-9]+' <<<"$text" | cut -d: -f2); do
    ((line >= first && line <= last)) && found=yes
  done
  [[ $found ]] || { echo "program $n: the first error does not point into the program"; head -n 12 <<<"$text"; }
}

mapfile -t programs < <(grep -nE '^#(if|elif) MISTAKE == [0-9]+ +// refused:|^#else' "$scratch/mistakes.cpp")
((${#programs[@]} > 40)) || { echo "only ${#programs[@]} programs were found"; exit 1; }
for ((i = 0; i + 1 < ${#programs[@]}; ++i)); do
  first=${programs[i]%%:*} last=${programs[i + 1]%%:*}
  n=$(sed -E 's/.*MISTAKE == ([0-9]+) .*/\1/' <<<"${programs[i]}")
  expected=$(sed -E 's/.*refused: ?//' <<<"${programs[i]}")
  [[ -z ${chosen// /} || $chosen == *" $n "* ]] || continue
  try "$n" "$expected" "$first" "$last" >"$scratch/$n.report" &
  while (($(jobs -rp | wc -l) >= 2)); do wait -n; done
done
wait
cat "$scratch"/*.report
[[ -z $(cat "$scratch"/*.report) ]]
