# cmake/setup.sh: what continuo.sh, studies.sh and test.sh share. Sourced, with `root` set to the folder of the clone.
# Everything here speaks on standard error.

# What the build and the tests need: package, the command that proves it is there ("-": ask the package system), why.
packages_to_build=(
  "g++                    c++          the compiler"
  "cmake                  cmake        configures the build"
  "ninja-build            ninja        runs the build"
  "libfmt-dev             -            text and numbers"
  "nlohmann-json3-dev     -            JSON: manifests and --json"
  "libcli11-dev           -            the command line"
  "libudunits2-dev        -            physical units"
  "libxsimd-dev           -            vector instructions"
  "libsuitesparse-dev     -            sparse linear systems"
  "libtbb-dev             -            threads"
  "libqhull-dev           -            convex hulls"
  "libeigen3-dev          -            eigenvalues of matrices"
  "libceres-dev           -            least squares, and dual numbers"
  "zlib1g-dev             -            the page of the live view, compressed"
  "libboost-dev           -            the live view's server"
  "nodejs                 node         builds the live view's page"
  "npm                    npm          builds the live view's page"
  "gnuplot-nox            gnuplot      plots"
)
packages_to_document=(
  "doxygen                doxygen      the reference of the library, as pages"
  "python3                python3      builds the pages"
  "python3-markdown       -            Markdown as HTML"
)
packages_for_python=(
  "python3                python3      runs the module"
  "python3-dev            -            its headers"
  "pybind11-dev           -            calls C++ from Python"
  "python3-numpy          -            arrays"
)
packages_to_test=(
  "python3-pytest         -            the tests of the Python module"
  "python3-matplotlib     -            its plots"
  "python3-nbclient       -            runs its notebooks"
  "python3-ipykernel      -            what they run in"
  "mypy                   mypy         judges its types"
  "libgtest-dev           -            unit tests"
  "libgmock-dev           -            unit tests"
  "chromium               chromium     the live view's page, tested in a browser"
  "libnetcdf-dev          -            reads our netCDF files, as their inventors do"
  "python3-xarray         -            reads our netCDF files, as users do"
  "python3-netcdf4        -            what it reads them with"
  "python3-pandas         -            reads our CSV, as users do"
  "python3-scipy          -            compared with on docs/coming_from_scipy.md"
  "python3-numba          -            compiles right-hand sides for the Python module, as users do"
  "octave-dev             mkoctfile    calls continuo.h, and runs the programs of docs/coming_from_matlab.md"
  "python3-jsonschema     -            judges the answers to --json by their schemas"
  "libopenmpi-dev         -            sweeps on many processors: continuo-mpi"
  "openmpi-bin            mpirun       starts them"
  "python3-clang-19       -            lists the public functions, all of which must be documented"
  "clang-19               clang++-19   the second compiler, with sanitizers"
  "libclang-rt-19-dev     -            sanitizers and the fuzzer"
  "lld-19                 ld.lld-19    its linker: six times as fast on sanitized programs"
  "clang-format-19        clang-format-19 the layout of the code"
)

say() { printf 'continuo: %s\n' "$*" >&2; }

package_is_there() {  # package command
  if [[ $2 != - ]] && command -v "$2" >/dev/null 2>&1; then return 0; fi
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# The distribution's Python, for which its packages are installed, even if another one is first in the path.
python_of_packages() { if [[ -x /usr/bin/python3 ]]; then echo /usr/bin/python3; else echo python3; fi; }

# setup_packages build|docs|python|test: installs what is missing, after saying what and why.
setup_packages() {
  local rows=("${packages_to_build[@]}") row package proof why missing=()
  case $1 in
    docs) rows+=("${packages_to_document[@]}") ;;
    python) rows+=("${packages_for_python[@]}") ;;
    test) rows+=("${packages_to_document[@]}" "${packages_for_python[@]}" "${packages_to_test[@]}") ;;
  esac
  if ! command -v dpkg-query >/dev/null 2>&1; then
    say "this system has no Debian packages; the build needs (names as on Debian):"
    for row in "${rows[@]}"; do read -r package proof why <<<"$row"; printf '  %-20s %s\n' "$package" "$why" >&2; done
    return 0
  fi
  for row in "${rows[@]}"; do
    read -r package proof why <<<"$row"
    if package_is_there "$package" "$proof"; then continue; fi
    if ((${#missing[@]} == 0)); then say "installing from the distribution's packages, this once:"; fi
    missing+=("$package")
    printf '  %-20s %s\n' "$package" "$why" >&2
  done
  if ((${#missing[@]} == 0)); then return 0; fi

  local become=()
  if [[ $(id -u) != 0 ]]; then
    if ! command -v sudo >/dev/null 2>&1; then
      say "cannot install: you are not root and there is no sudo. Ask an administrator for"
      say "  apt-get install ${missing[*]}"
      exit 1
    fi
    become=(sudo)
  fi
  local quiet=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
  "${become[@]}" "${quiet[@]}" update >&2 || say "apt-get update failed; trying with the lists at hand"
  if ! "${become[@]}" "${quiet[@]}" install -y --no-install-recommends "${missing[@]}" >&2; then
    say "the packages could not be installed; the lines above say why. By hand: apt-get install ${missing[*]}"
    exit 1
  fi
}

# quietly LOG COMMAND...: on a terminal the command shows its progress, elsewhere only its failure.
quietly() {
  local log=$1
  shift
  if [[ -t 2 ]]; then
    "$@" >&2
  elif ! "$@" >"$log" 2>&1; then
    cat "$log" >&2
    return 1
  fi
}

# The programs of the command, each with the stamp of its last build.
declare -A stamps=([continuo]=.built [continuo-studies]=.built_studies)

# setup_program NAME: builds a program of the command in the folder that `build` names, unless nothing is newer than its last build.
# A folder's time changes when files are added or removed.
setup_program() {
  local program=$1 stamp=$build/${stamps[$1]} web=$root/web
  if [[ ! -d $web ]]; then web=$root/cmake; fi  # a clone without the page
  if [[ -x $build/$program && -e $stamp ]] &&
     [[ -z $(find "$root/continuo" "$root/apps" "$root/cmake" "$root/CMakeLists.txt" "$root/CMakePresets.json" \
               "$web" -name node_modules -prune -o -newer "$stamp" ! -name '*.md' -print -quit) ]]; then
    return 0
  fi
  setup_packages build
  if [[ $program == continuo-studies && ! -e $stamp ]]; then
    say "building the part of the command for studies, which takes some minutes this once"
  fi
  setup_build "$build" "$program" "$stamp"
}

# setup_python: builds the Python module in the folder that `build` names, as setup_program does the command.
setup_python() {
  local stamp=$build/.built_python
  if [[ -e $build/python/continuo/_continuo.so && -e $stamp ]] &&
     [[ -z $(find "$root/continuo" "$root/python" "$root/cmake" "$root/CMakeLists.txt" "$root/CMakePresets.json" \
               -name __pycache__ -prune -o -newer "$stamp" ! -name '*.md' ! -name '*.pyc' -print -quit) ]]; then
    return 0
  fi
  setup_packages python
  setup_build "$build" continuo_python "$stamp" -DCONTINUO_PYTHON=ON
}

# setup_build FOLDER TARGET STAMP [OPTION]: builds one target; the stamp carries the time at which the build began, so that a
# file changed while it ran counts as newer.
setup_build() {
  local build=$1 target=$2 stamp=$3 option=${4-}
  mkdir -p "$build"
  exec {lock}>"$build/.lock"
  flock "$lock"  # two calls at once build once
  touch "$stamp.began"
  if [[ ! -e $build/build.ninja ]]; then
    say "building, which takes some minutes this once"
    if ! quietly "$build/.log" env -C "$root" cmake --preset release -DCONTINUO_TESTS=OFF -DCMAKE_UNITY_BUILD=ON; then
      say "the build could not be configured"
      exit 1
    fi
  fi
  if [[ -n $option ]] && ! quietly "$build/.log" cmake -S "$root" -B "$build" "$option"; then
    say "the build could not be configured"
    exit 1
  fi
  if ! quietly "$build/.log" cmake --build "$build" --target "$target"; then
    say "the build failed; the lines above say where"
    exit 1
  fi
  mv "$stamp.began" "$stamp"
  exec {lock}>&-
}
