#!/usr/bin/env bash
# usage: format.sh CLANG_FORMAT FOLDER: fails on a source that is not formatted according to .clang-format.
set -euo pipefail
cd "$2"
find continuo apps tests bench -name '*.[ch]pp' -print0 | xargs -0 "$1" --dry-run --Werror
