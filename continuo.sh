#!/usr/bin/env bash
# The command continuo from a fresh clone: installs what is missing, builds it once, then hands over.
#
#   ./continuo.sh run models/bouncing_ball.sim --plot ball.svg
#   ./continuo.sh docs      builds the documentation as a site, and prints the path of its first page
#
# Works from any folder. Its own messages go to standard error; standard output is that of the command.
set -euo pipefail

self=${BASH_SOURCE[0]}
if [[ -L $self ]]; then self=$(readlink -f -- "$self"); fi
root=.
if [[ $self == */* ]]; then root=${self%/*}; fi
build=$root/build
stamp=$build/.built
web=$root/web
if [[ ! -d $web ]]; then web=$root/cmake; fi  # a clone without the page

# If nothing is newer than the last build, run the command at once. A folder's time changes when files are added or removed.
if [[ ! -x $build/continuo || ! -e $stamp ]] ||
   [[ -n $(find "$root/continuo" "$root/apps" "$root/cmake" "$root/CMakeLists.txt" "$root/CMakePresets.json" \
             "$web" -name node_modules -prune -o -newer "$stamp" ! -name '*.md' -print -quit) ]]; then
  # shellcheck source=cmake/setup.sh
  source "$root/cmake/setup.sh"
  setup_packages build
  setup_build "$build" continuo "$stamp"
fi
if [[ ${1-} == docs ]]; then
  # shellcheck source=cmake/setup.sh
  source "$root/cmake/setup.sh"
  setup_packages docs
  exec "$(python_of_packages)" "$root/docs/site/build.py" --command "$build/continuo" --out "$build/site"
fi
exec "$build/continuo" "$@"
