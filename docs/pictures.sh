#!/usr/bin/env bash
# Makes the pictures of the documentation again: docs/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/.."
pictures=docs/pictures
mkdir -p "$pictures"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The block of the tutorial marked `sim file=NAME`, as a file.
block() {
  awk -v mark="file=$1" '/^```/ { inside = !inside && index($0, mark); next } inside' \
    docs/tutorial_bouncing_ball.md > "$scratch/$1"
}

picture() {  # picture NAME MODEL [OPTION ...]
  local name=$1 model=$2
  shift 2
  "${CONTINUO:-./continuo.sh}" run "$model" "$@" --plot "$pictures/$name.svg" -o "$scratch/$name.csv"
}

block bounce.sim
picture bouncing_ball models/bouncing_ball.sim
picture ball_through_floor models/ball_through_floor.sim
picture bounce "$scratch/bounce.sim"
picture double_pendulum models/double_pendulum.sim
