#!/usr/bin/env bash
# usage: fuzz.sh TARGET FOLDER SECONDS: starts from the gallery and the wrong models, does not store the inputs that
# it finds, and prints the input on which the target fails.
set -euo pipefail
target=$1 folder=$2 seconds=$3
found=$(mktemp -d)
trap 'rm -rf "$found"' EXIT
mapfile -t seeds < <(cd "$folder" && for seed in models "tests/fuzz/$(basename "${target#*fuzz_}")" tests/language/wrong; do
  [[ -d $seed ]] && realpath "$seed"; done; true)
"$target" -max_total_time="$seconds" -timeout=60 -max_len=4096 -rss_limit_mb=4096 -print_final_stats=1 \
  -artifact_prefix="$found/" "$found" "${seeds[@]}" >"$found.log" 2>&1 || {
  tail -n 60 "$found.log"
  for input in "$found"/{crash,timeout,oom,leak}-*; do [[ -f $input ]] && base64 "$input"; done
  exit 1
}
grep -E 'stat::(number_of_executed_units|average_exec_per_sec)' "$found.log"
rm -f "$found.log"
