#!/usr/bin/env bash
# The command continuo from a fresh clone: installs what is missing, builds it once, then hands over.
#
#   ./continuo.sh run models/bouncing_ball.sim --plot ball.svg
#   ./continuo.sh python    opens Python with the module continuo; with arguments: ./continuo.sh python script.py
#   ./continuo.sh docs      builds the documentation as a site, and prints the path of its first page
#
# Works from any folder. Its own messages go to standard error; standard output is that of the command.
set -euo pipefail

self=${BASH_SOURCE[0]}
if [[ -L $self ]]; then self=$(readlink -f -- "$self"); fi
root=.
if [[ $self == */* ]]; then root=${self%/*}; fi
build=$root/build
# shellcheck source=cmake/setup.sh
source "$root/cmake/setup.sh"

if [[ ${1-} == python ]]; then
  shift
  setup_python
  # The studies of a model are those of the command, which is built when the first one is asked for.
  CONTINUO_COMMAND=$(cd -- "$root" && pwd)/continuo.sh
  PYTHONPATH=$(cd -- "$build" && pwd)/python${PYTHONPATH:+:$PYTHONPATH}
  export CONTINUO_COMMAND PYTHONPATH
  if (($#)); then exec "$(python_of_packages)" "$@"; fi
  exec "$(python_of_packages)" -i -c 'import continuo; print("continuo", continuo.__version__, "is imported")'
fi

setup_program continuo
# These two catch what the studies say, so that is not the time to build them.
if [[ ${1-} == docs || (${1-} == report && " $* " == *" --with"*) ]]; then setup_program continuo-studies; fi
if [[ ${1-} == docs ]]; then
  setup_packages docs
  exec "$(python_of_packages)" "$root/docs/site/build.py" --command "$build/continuo" --out "$build/site"
fi
# The command starts its program for studies by this script, which builds it the first time.
export CONTINUO_STUDIES=$root/cmake/studies.sh
if [[ $root != /* ]]; then CONTINUO_STUDIES=$PWD/$CONTINUO_STUDIES; fi
exec "$build/continuo" "$@"
