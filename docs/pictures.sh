#!/usr/bin/env bash
# Makes the pictures of the documentation again: docs/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/.."
pictures=docs/pictures
mkdir -p "$pictures"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The block of a page marked `sim file=NAME`, as a file: block PAGE NAME.
block() {
  awk -v mark="file=$2" '/^```/ { inside = !inside && index($0, mark); next } inside' "docs/$1" > "$scratch/$2"
}

picture() {  # picture NAME MODEL [OPTION ...]
  local name=$1 model=$2
  shift 2
  "${CONTINUO:-./continuo.sh}" run "$model" "$@" --plot "$pictures/$name.svg" -o "$scratch/$name.csv"
}

block tutorial_bouncing_ball.md bounce.sim
picture bouncing_ball models/bouncing_ball.sim
picture ball_through_floor models/ball_through_floor.sim
picture bounce "$scratch/bounce.sim"
picture double_pendulum models/double_pendulum.sim

block tutorial_stiffness.md door.sim
picture stiff_door_explicit "$scratch/door.sim" --method explicit_euler --step 0.0021 --until 0.1
picture stiff_door_implicit "$scratch/door.sim" --method rosenbrock23 --step 0.1
picture van_der_pol_stiff models/van_der_pol_stiff.sim
picture robertson models/robertson.sim

block tutorial_boundary_values.md throw.sim
picture throw "$scratch/throw.sim"
study() {  # study NAME VERB [OPTION ...]
  local name=$1
  shift
  "${CONTINUO:-./continuo.sh}" "$@" --plot "$pictures/$name.svg" > /dev/null
}

study lorenz_branches steady models/lorenz.sim --along rho=0..30
block tutorial_equilibria.md bautin.sim
study bautin_orbits orbit "$scratch/bautin.sim" --along mu=-1..1
block tutorial_two_parameters.md bazykin.sim
study bazykin_curves steady "$scratch/bazykin.sim" --along alpha=0..1 --and delta=0..1
study pendulum_plane phase models/pendulum.sim --box "theta=-7..7,theta'=-8..8"
study differences converge --derivative "sin(x)" --at 1
study orders converge models/mass_spring_damper.sim --methods euler,heun,bogacki_shampine3,rk4,tsitouras5
study regions stability euler,heun,rk4,central_difference,implicit_euler,bdf2
study heat_regions stability euler,heun,rk4,dop853 --model models/heat_equation.sim
study sweep_ball sweep models/bouncing_ball.sim --vary "h0 normal(10, 0.02) [m]" --vary "e uniform(0.88, 0.92)" \
  --runs "1024 sobol seed 7" --keep "h at 0..10 by 0.05"
study sweep_damping sweep models/mass_spring_damper.sim --vary "c from 0.2 to 8 [N*s/m] count 40" \
  --vary "m from 0.25 to 4 [kg] count 40" --keep "max(x) as peak" --until 60
block tutorial_sweep.md braking.sim
study sweep_braking sweep "$scratch/braking.sim"
for file in spring.csv ball.csv ball.sim; do block tutorial_fit.md "$file"; done
study sense_spring sense models/mass_spring_damper.sim --param k,c
study fit_spring fit models/mass_spring_damper.sim "$scratch/spring.csv" --param k,c
study fit_ball fit "$scratch/ball.sim" "$scratch/ball.csv" --param e,h0 --loss cauchy
awk '/^```/ { inside = /python/; next } inside' docs/python_worlds.md > "$scratch/worlds.py"
root=$PWD
(cd "$scratch" && MPLBACKEND=Agg "$root/continuo.sh" python worlds.py)
mv "$scratch/ragdoll.png" "$pictures/"
