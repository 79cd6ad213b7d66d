// E2xx: the text is read, but does not make a model. E290 and up are warnings.
#include <array>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

namespace {

constexpr std::array check_entries = {
    Code{"E201", "units do not match",
         R"(Terms that are added, compared, assigned or equated must have the same dimension:

  x'' = (F - k*x - c*x)/m          F - k*x is N, c*x is N*s: c*x' was meant

Units that differ by a factor only (km and m, h and s) are converted automatically. A number without unit takes the
unit of the other term of a sum; a name declared without unit is not checked.
degC and degF have another zero than K and cannot be mixed with it: use K throughout.)"},
    Code{"E202", "a dimensionless number is required",
         R"(The arguments of sin, exp, log, floor and similar functions, and exponents, must be dimensionless:

  F = F0*sin(2*t)                  2*t is s; write sin(2 [1/s]*t), or sin(w*t) with param w = 2 [1/s]

Angles may be in deg or rad; they are converted.)"},
    Code{"E203", "this is not a unit",
         R"(Units are those of UDUNITS-2: m/s^2, N*s, kg m2 s-2, km/h, 1/s, rad, deg, degC, eV, fs, ... with the
prefixes of SI. Capitals matter: mN is a millinewton, MN a meganewton.)"},
    Code{"E204", "a power has no unit",
         R"(The exponent of a quantity with a unit must be a number, since the unit of the result depends on it:

  v^2, r^-3, A^0.5                 good
  (x/L)^n                          good: x/L is a pure number
  x^n                              n could change

Roots whose unit has no simple exponent are refused.)"},
    Code{"E210", "there is no such name",
         R"(Every name must be a state (it has an equation and an initial value), a param, input, let, output,
energy, unknown or table, or one of t and pi. Capitals matter.)"},
    Code{
        "E211", "a name is defined twice",
        R"(A name is defined once in the whole model; a name defined in a mode may be defined again in another mode.)"},
    Code{"E212", "a definition depends on itself",
         R"(let a = b + 1 and let b = 2*a depend on each other. To solve them together as equations, declare
unknown a = 0 and write 0 = a - b - 1; if one of them is a state, give it an equation a' = ...)"},
    Code{
        "E213", "a name has a definition and an equation",
        R"(A name with an equation for its derivative is a state; it cannot be a param, let, input or unknown as well.)"},
    Code{"E214", "a name is reserved",
         R"(t is time, pi is 3.14159..., and functions such as sin or max keep their names.)"},
    Code{"E215", "there is no such function",
         R"(sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log ln log2 log10 sqrt cbrt pow
hypot abs sign min max floor ceil round mod smooth, and interp for tables. A product needs its sign: k*(x + 1), not
k(x + 1).)"},
    Code{"E216", "wrong number of arguments",
         R"(atan2(y, x), hypot(x, y), mod(a, b), pow(a, b), interp(table, x) take two, min and max two or more, the
others one.)"},
    Code{"E217", "a number and a condition are mixed up",
         R"(x > 0 is a condition, x is a number. Conditions are used after if and when, and with and, or, not. To
convert a condition to a number write if x > 0 then 1 else 0. An event detects a sign change, not an equality: when
x crosses 3.)"},
    Code{"E218", "there is no such derivative",
         R"(Derivatives up to the highest one in the equations may be used: with x'' = -x these are x, x' and x''.
The highest one is given by the equation; if it differs between modes, write its expression instead. Params, inputs
and lets have no derivatives.)"},
    Code{"E219", "an index is wrong",
         R"(A member of a family needs an index, an integer: u[3] or u[i+1]. Other names have no index.)"},
    Code{"E220", "an index is out of range",
         R"(for i in 1..N { u[i]' = u[i+1] - u[i] } needs u[N+1] at its end. Write the equations at the ends apart:

  for i in 2..N-1 { u[i]' = u[i-1] - 2*u[i] + u[i+1] }
  u[1]' = ...
  u[N]' = ...

A list must contain one value for each member of its param.)"},
    Code{
        "E221", "a range or a size is not sensible",
        R"(A range goes from its smaller to its larger end. Families and sums together may have half a million members.)"},
    Code{"E222", "this must not change with time",
         R"(Sizes of families, indices and tolerances may depend on numbers, params, and lets of these. Values of
params, initial values and times of events may depend on params, too. States, inputs and t change with time and are
not allowed here. An initial value may also depend on other initial values, y(0) = 2*x(0), and on lets, inputs and
t, with their values at the start; but not on an unknown, because unknowns are solved for after the initial values
are known.)"},
    Code{"E223", "there is no such body",
         R"(Bodies are declared in the world, one by one or by a pattern, whose members are counted from 1:

  world {
    body ball at (0, 10) radius 0.5
    bodies grain grid 10 x 20 from (1, 1) spacing (1.1, 1.1)      # grain[1] to grain[200]
  }

Capitals matter.)"},
    Code{"E224", "there is no such member",
         R"(A body in the plane has the members ball.x, ball.x', ball.y, ball.y', ball.angle, ball.angle' (or
ball.spin), ball.radius and ball.mass; in space ball.z, ball.z' and the spin ball.spin_x, ball.spin_y, ball.spin_z
instead of the angle. A joint with a name has its force_x, force_y and torque (in space torque_x, ...), a hinge an
angle, a slider, distance, rope or wheel a length, and its motor_torque or motor_force; a joint without a name gives
all but angle and length to its first body, door.torque. The world has the members world.kinetic, world.potential,
world.momentum_x, ... and world.collisions. A body or a joint itself is no number.)"},
    Code{"E225", "this cannot be in a world",
         R"(Radius, mass and density are greater than 0, restitution goes from 0 (no bounce) to 1 (no loss),
friction is 0 or more; a spring has a stiffness and two ends; the lower corner of a container comes first. A body has
one shape: a ball of a radius, or a box, a capsule, or the hull of points that are not on one line (in space: not in one
plane). A joint connects two bodies, or a body with the world, of which one can move; its limits go from the lower to
the upper one, and a slider, and in space a hinge, needs its axis. Bodies at random are placed where they touch no
other: a box holds them up to about a half of the plane or a third of space.)"},
    Code{"E226", "bodies are moved by forces",
         R"(A body has no equation and no initial value of its own. Its initial state is given in the world, and
forces move it:

  world { body ball at (0, 10) velocity (1, 0) mass 2 }
  force on ball = (-k*ball.x, 0)

Forces may use parameters, t, inputs, positions and velocities of bodies and the states of equations; equations may use
positions and velocities of bodies. Members of the world (world.kinetic) and of joints (door.torque) are for outputs
and checks.)"},
    Code{"E227", "the dimension is wrong",
         R"(A world has 2 dimensions, or 3 with `dimension 3`; all its points have this number of coordinates.)"},
    Code{"E230", "an equation is missing",
         R"(Every variable with a derivative needs one equation for its highest one:

  x'' = v'/2 + 1                   v' is used here, so v needs an equation as well

A name with an initial value only is often misspelt.)"},
    Code{"E231", "one equation too many",
         R"(There is one equation for each highest derivative. Equations outside of modes are valid in every mode:
an equation for x' outside and another one in a mode are two.)"},
    Code{"E232", "an equation cannot be solved",
         R"(An equation may be written as on the blackboard, m*x'' + c*x' + k*x = F, if it is linear in its highest
derivative; coupled equations are solved together. x'^2 = x has two solutions: write x' = sqrt(x) or x' = -sqrt(x).)"},
    Code{"E233", "an equation determines nothing",
         R"(An equation must contain a highest derivative (x' = ...) or an unknown (0 = ... with unknown z = 1). To
name an expression use let.)"},
    Code{"E234", "modes define different states",
         R"(All modes must define derivatives of the same order, so that a change of mode replaces only the right-hand
side:

  mode flight { h'' = -g }
  mode rest   { h'' = 0 }          not h' = 0: set h' := 0 in the event that leads here)"},
    Code{"E235", "unknowns and algebraic equations differ in number",
         R"(Each unknown z = guess needs one equation without derivatives, 0 = ...)"},
    Code{"E236", "the index of the algebraic equations is above 1",
         R"(The equations 0 = ... must determine the unknowns when the states are given: then the index is 1. For a
pendulum written as x'' = -T*x, y'' = -T*y - g with 0 = x^2 + y^2 - L^2 they do not: the last equation does not
contain T, and constrains the states only. Its second derivative with respect to time contains T:

  0 = x'^2 + y'^2 - T*(x^2 + y^2) - g*y

The initial states must lie on the circle, with a velocity tangent to it.)"},
    Code{"E237", "a mass matrix is singular",
         R"(Coupled equations are solved together for their highest derivatives, whose coefficient matrix must be
invertible: m*x'' + m*y'' = F and m*x'' + m*y'' = G do not determine x'' and y'', because they contain only the sum.

Fix: check whether an equation was written twice or is missing; a variable whose derivative no equation determines is
an `unknown`, with an equation 0 = ... of its own.)"},
    Code{"E240", "an initial value is missing",
         R"(A variable of order n needs n values at the start: h'' needs h(0) and h'(0).)"},
    Code{"E241", "an initial value is given twice",
         R"(Each component has one value at each time; in families make sure that the ranges do not overlap.)"},
    Code{"E242", "this has no initial value",
         R"(With h'' = -g, h and h' have initial values; h'' follows from the equation.)"},
    Code{"E244", "the number of boundary conditions is wrong",
         R"(Conditions at more than one time (x(1) = 3; x(7) = 4) make a boundary-value problem: one condition per
state, here two for x''. A condition may name a state at another time (x(0) = x(10)). An `unknown` without an
equation 0 = ... is a constant to be found, and needs one condition more.)"},
    Code{"E245", "the time of a condition is outside of the run",
         R"(Every condition of a boundary-value problem is at a time between the ends of `run A..B`.)"},
    Code{"E246", "initial values depend on each other in a cycle",
         R"(An initial value may depend on others at the same time, in any order: S(0) = 1 - I(0) - R(0). It must not
depend on itself, neither directly nor through other initial values or a `let`.

Fix: give one state of the cycle an independent initial value, or solve for it by hand: x(0) = 1 - x(0)/2 is x(0) =
2/3.)"},
    Code{"E250", "there is no such mode",
         R"(`in MODE`, `go MODE` and `start in MODE` name a mode of the model: mode NAME { equations }.)"},
    Code{"E251", "an event assigns or changes the mode twice",
         R"(All assignments of an event read the state before the event and are executed simultaneously, so on every
path each state may be assigned only once, and the mode changed only once:

  when h falls through 0 {
    if h' < -1 { h' := -e*h' } else { h' := 0 }
  })"},
    Code{"E252", "this cannot be assigned",
         R"(Events assign to states only. A quantity that changes at events only is a state with the derivative 0:

  level' = 0
  level(0) = 1
  every 2 { level := level/2 })"},
    Code{"E260", "there is no such method",
         R"(explicit_euler (also euler), semi_implicit_euler, symplectic_euler_position_first, central_difference,
velocity_verlet, midpoint, heun, rk4, rk38, bogacki_shampine3, dormand_prince5, tsitouras5, dop853, verner7,
verner9 and many more.)"},
    Code{"E261", "a time or tolerance is not sensible",
         R"(The end of a run must be after its start; steps, output intervals, periods and tolerances must be
greater than zero.)"},
    Code{"E262", "a statement is given twice",
         R"(A model has one `run`, one `start in` and one `world`. Other experiments are options of the command:
--until, --method, --step.)"},
    Code{
        "E263", "the number of tolerances is wrong",
        R"(abs takes one tolerance for all states or one for each, in the order in which `continuo info` lists them.)"},
    Code{"E264", "the method does not fit the model",
         R"(velocity_verlet and central_difference are for x'' = a(t, x): every state must be a position or its
velocity, and both in units that fit (x in m, x' in m/s, time in s). The other methods are general. The method of a
world of bodies is its mode, exact or fast. Of joints, and of bodies that are driven or are not balls, the exact mode
refuses what it does not know, and the fast mode has its usual integrator.)"},
    Code{"E265", "there is nothing to drag",
         R"(`drag` lets the mouse move the states that a point depends on: ball (x, y) drag, or for a pendulum
ball (l*sin(theta), -l*cos(theta)) drag. A point that depends on no state cannot be dragged.)"},
    Code{"E270", "a file does not exist",
         R"(Files of tables, inputs, meshes and chains are found relative to the folder of the model.)"},
    Code{"E271", "a table and a number are mixed up",
         R"(table NAME from "file.csv" is read by interp(NAME, x), and by nothing else.)"},
    Code{"E272", "a file is not a table",
         R"(A table has columns of numbers, separated by commas, semicolons or blanks; the first column increases.
The first line may contain names. An input reads the column with its own name, or the second one.)"},
    Code{"E273", "a file is not a mesh",
         R"(A mesh of a world is read from a Wavefront OBJ file: lines `v x y z` are its corners, lines `f 1 2 3` its
faces, by the numbers of their corners, which go counter-clockwise seen from the side that is free. Faces of more
corners are cut into triangles. Each face has an area; other lines have no meaning here.)"},
    Code{"E280", "there is nothing to simulate",
         R"(The smallest model is an equation with its initial value: x' = -x and x(0) = 1.)"},
    Code{"E281", "a check cannot be made",
         R"(A check refers to times within the run, to events of the model (the text is the beginning of an event's
name as listed by `continuo info`), or to the energy if the model declares one.)"},
    Code{"E282", "a value at a time outside of a check",
         R"(Only a condition, x(3) = 1, and a check, check x(3) = 1, may refer to a given time; other expressions
use the present values. A product needs its sign: k*(x + 1), not k(x + 1).)"},
    Code{"E283", "this cannot be varied",
         R"(A sweep varies parameters by their names, initial values, also those of bodies, and inputs without a file:

  sweep {
    k from 1 to 10 [N/m] count 50
    x(0) in (1, 2, 5) [m]
    ball.y(0) normal(10, 0.1) [m]
  }

Each is varied once. Of a model with conditions at several times only parameters and inputs can be varied.)"},
    Code{"E284", "the values of a sweep cannot be used",
         R"(Values are written in one of these ways, with units as everywhere:

  k from 1 to 10 [N/m] count 50            with `log` behind it in equal ratios, both ends of one sign
  k in (1, 2, 5) [N/m]
  k uniform(1, 10)                         from low to high
  k normal(5, 0.5)                         mean and deviation, above 0
  k lognormal(5, 0.1)                      median and deviation of the logarithm, both above 0
  k triangular(1, 5, 10)                   low, mode and high
  k from "samples.csv"                     the column named k, or the only one)"},
    Code{"E285", "the number of runs of a sweep cannot be used",
         R"(Without `runs` a sweep runs all combinations of its values. `runs 10000 sobol seed 7` makes so many runs,
with values drawn from the distributions, and from grids, lists and files with equal probability. What has a
distribution needs it. Instead of sobol there are latin_hypercube and monte_carlo; `runs 10000 indices` chooses runs
that tell how much of the spread each quantity causes (Sobol' indices), and `runs 200 morris` few runs that tell which
of many quantities matter. There are at most 1e9 runs.)"},
    Code{"E286", "this cannot be kept of a run",
         R"(A sweep keeps of every run what a check can read, and what happens along the run:

  keep x at end, x at 3 [s], x after event 2, time of event 1 as landing, count of events, energy drift
  keep max(abs(x)) as peak, min(x), mean(x^2), x at 0..10 by 0.1

Each column has its own name: that after `as`, else the text.)"},
    Code{"E290", "a value lies outside its range",
         R"(A warning: the value of a param or input lies outside of its range, which is that of its slider.)"},
    Code{"E291", "an event never happens", R"(A warning: the condition of the event is the same number at all times.)"},
    Code{"E292", "a method loses its order",
         R"(A warning: velocity_verlet and central_difference are designed for accelerations that depend on time
and positions only. With friction or a Coriolis force they work at a lower order.)"},
    Code{"E293", "a group of bodies that nothing ignores",
         R"(A warning: bodies of a group collide like all others unless the world contains
`ignore GROUP with GROUP`. Conversely, an ignored group without bodies is probably a misspelt name.)"},
    Code{"E294", "a force on a body that does not move",
         R"(A warning: a fixed body stays where it is, whatever acts on it.)"},
    Code{"E295", "bodies overlap at the start",
         R"(A warning: at the start bodies overlap each other or a wall. Their motion is then not that of hard bodies:
the exact mode separates those that approach each other, the fast mode pushes all of them apart.

Fix: leave room, or let their groups ignore each other. A body that begins behind ground of facets falls through it: a
chain is free on the left of the way from point to point, a mesh where the corners of its faces go counter-clockwise.)"},
};

}  // namespace

std::span<const Code> check_codes() {
  return check_entries;
}

}  // namespace continuo::model
