// E2xx: the text is read, but does not make a model. E290 and up are warnings.
#include <array>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

namespace {

constexpr std::array check_entries = {
    Code{"E201", "units do not match",
         R"(What is added, compared, assigned or equated must measure the same thing:

  x'' = (F - k*x - c*x)/m          F - k*x is N, c*x is N*s: c*x' was meant

Units that differ by a factor only (km and m, h and s) are converted by themselves. A number without unit takes the
unit of its neighbour in a sum; a name declared without unit fits everything.
degC and degF have another zero than K and do not mix with it: use K throughout.)"},
    Code{"E202", "a pure number is wanted",
         R"(sin, exp, log, floor and their like, and exponents, take numbers without unit:

  F = F0*sin(2*t)                  2*t is s; write sin(2 [1/s]*t), or sin(w*t) with param w = 2 [1/s]

Angles may be in deg or rad; they are converted.)"},
    Code{"E203", "this is not a unit",
         R"(Units are read as UDUNITS-2 does: m/s^2, N*s, kg m2 s-2, km/h, 1/s, rad, deg, degC, eV, fs, ... with the
prefixes of SI. Capitals matter: mN is a millinewton, MN a meganewton.)"},
    Code{"E204", "a power has no unit",
         R"(The exponent of a quantity with a unit must be a number, since the unit of the result depends on it:

  v^2, r^-3, A^0.5                 good
  (x/L)^n                          good: x/L is a pure number
  x^n                              n could change

Roots whose unit has no simple exponent are refused.)"},
    Code{
        "E210", "there is no such name",
        R"(Every name must be a state (it has an equation and an initial value), a param, input, let, output, energy, unknown
or table, or one of t and pi. Capitals matter.)"},
    Code{"E211", "a name is defined twice",
         R"(A name stands for one thing in the whole model; names in a mode may be used again in another mode.)"},
    Code{"E212", "a definition leans on itself",
         R"(let a = b + 1 and let b = 2*a need each other. If they are meant as equations to be solved together, declare
unknown a = 0 and write 0 = a - b - 1; if one of them changes with time on its own, give it an equation a' = ...)"},
    Code{"E213", "a name has a definition and an equation",
         R"(What has an equation with a prime is a state; it cannot be a param, let, input or unknown as well.)"},
    Code{"E214", "a name has a meaning of its own",
         R"(t is time, pi is 3.14159..., and functions such as sin or max keep their names.)"},
    Code{
        "E215", "there is no such function",
        R"(sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log ln log2 log10 sqrt cbrt pow hypot abs
sign min max floor ceil round mod smooth, and interp for tables. A product needs its sign: k*(x + 1), not k(x + 1).)"},
    Code{
        "E216", "wrong number of arguments",
        R"(atan2(y, x), hypot(x, y), mod(a, b), pow(a, b), interp(table, x) take two, min and max two or more, the others
one.)"},
    Code{
        "E217", "a number and a condition are mixed up",
        R"(x > 0 is a condition, x is a number. Conditions stand after if and when, and between and, or, not; a number is
made of one by if x > 0 then 1 else 0. An event waits for a sign change, not for equality: when x crosses 3.)"},
    Code{"E218", "there is no such derivative",
         R"(Primes up to the highest derivative in the equations may be used: with x'' = -x there are x, x' and x''. The
highest one is what the equation says, which may differ from mode to mode; then write it out. Params, inputs and lets
have no primes.)"},
    Code{"E219", "an index is wrong",
         R"(A family needs its index, u[3] or u[i+1], a whole number; what is no family has none.)"},
    Code{"E220", "an index is out of range",
         R"(for i in 1..N { u[i]' = u[i+1] - u[i] } needs u[N+1] at its end. Write the equations at the ends apart:

  for i in 2..N-1 { u[i]' = u[i-1] - 2*u[i] + u[i+1] }
  u[1]' = ...
  u[N]' = ...

A list of values must have as many as its param has members.)"},
    Code{
        "E221", "a range or a size is not sensible",
        R"(A range goes from its smaller to its larger end. Families and sums together may have half a million members.)"},
    Code{
        "E222", "this must not change with time",
        R"(Sizes of families, indices, tolerances: numbers, params and lets made of these. The values of params, initial values
and times of events may depend on params, too, and follow them. States, inputs and t change with time. An initial value
may also name other starts, y(0) = 2*x(0), and lets of states, inputs and t, which are what they are then; but no
unknown, which is solved for when the starts are known.)"},
    Code{"E223", "there is no such body",
         R"(Bodies are declared in the world, one by one or by a pattern, whose members are counted from 1:

  world {
    body ball at (0, 10) radius 0.5
    bodies grain grid 10 x 20 from (1, 1) spacing (1.1, 1.1)      # grain[1] to grain[200]
  }

Capitals matter.)"},
    Code{"E224", "there is no such member",
         R"(Of a body in the plane there are ball.x, ball.x', ball.y, ball.y', ball.angle, ball.angle', ball.radius and
ball.mass; in space ball.z, ball.z' and the spin ball.spin_x, ball.spin_y, ball.spin_z instead of the angle. Of the
world there are world.kinetic, world.potential, world.momentum_x, ... and world.collisions. A body itself is no number.)"},
    Code{
        "E225", "this cannot be in a world",
        R"(Radius, mass and density are greater than 0, restitution goes from 0 (no bounce) to 1 (no loss), friction is 0 or
more; a spring has a stiffness and two ends; the lower corner of a container comes first. Bodies at random are placed
where they touch no other: a box holds them up to about a half of the plane or a third of space.)"},
    Code{
        "E226", "bodies are moved by forces",
        R"(A body has no equation and no initial value of its own. Its start stands in the world, and what moves it is a force:

  world { body ball at (0, 10) velocity (1, 0) mass 2 }
  force on ball = (-k*ball.x, 0)

Forces may use parameters, t, inputs, positions and velocities of bodies and the states of equations; equations may use
positions and velocities of bodies. What the world measures (world.kinetic) is for outputs and checks.)"},
    Code{
        "E227", "the dimension is wrong",
        R"(A world has 2 or 3 dimensions, 2 where it does not say `dimension 3`, and all its points as many numbers.)"},
    Code{"E230", "an equation is missing",
         R"(Every variable with a derivative needs one equation for its highest one:

  x'' = v'/2 + 1                   v' stands here, so v needs an equation as well

A name with an initial value only is often misspelt.)"},
    Code{
        "E231", "one equation too many",
        R"(As many equations as highest derivatives. Equations outside modes hold in every mode: an equation for x' outside and
another in a mode are two.)"},
    Code{
        "E232", "an equation cannot be solved",
        R"(An equation may be written as on the blackboard, m*x'' + c*x' + k*x = F, if its highest derivative stands in it
linearly; coupled ones are solved together. x'^2 = x has two solutions: write x' = sqrt(x) or x' = -sqrt(x).)"},
    Code{
        "E233", "an equation determines nothing",
        R"(An equation holds a highest derivative (x' = ...) or an unknown (0 = ... with unknown z = 1). To name an expression
write let.)"},
    Code{
        "E234", "modes define different states",
        R"(All modes define the derivatives of the same order, so that a change of mode needs no more than a new right-hand side:

  mode flight { h'' = -g }
  mode rest   { h'' = 0 }          not h' = 0: set h' := 0 in the event that leads here)"},
    Code{"E235", "unknowns and algebraic equations differ in number",
         R"(Each unknown z = guess needs one equation without derivatives, 0 = ...)"},
    Code{
        "E236", "the index of the algebraic equations is above 1",
        R"(The equations 0 = ... must be able to determine the unknowns while the states are given: then the index is 1. A
pendulum written as x'' = -T*x, y'' = -T*y - g with 0 = x^2 + y^2 - L^2 cannot: T is not in the last equation, which
says something of the states alone. Its second derivative by time holds T:

  0 = x'^2 + y'^2 - T*(x^2 + y^2) - g*y

and the states begin on the circle, with a velocity along it.)"},
    Code{
        "E237", "a mass matrix is singular",
        R"(Coupled equations are solved together for their highest derivatives, which the matrix before them must allow: with
m*x'' + m*y'' = F and m*x'' + m*y'' = G no x'' and y'' are determined, since only their sum is in the equations.

Fix: see whether an equation was written twice or one is missing; a variable whose derivative no equation determines is
an `unknown`, with an equation 0 = ... of its own.)"},
    Code{"E240", "an initial value is missing",
         R"(A variable of order n needs n values at the start: h'' needs h(0) and h'(0).)"},
    Code{"E241", "an initial value is given twice",
         R"(One value for each component at each time; in families also see that ranges do not overlap.)"},
    Code{"E242", "this has no initial value",
         R"(With h'' = -g, h and h' have initial values; h'' follows from the equation.)"},
    Code{
        "E244", "the number of boundary conditions is wrong",
        R"(Conditions at more than one time (x(1) = 3; x(7) = 4) make a boundary-value problem: one condition per state, here
two for x''. A condition may name a state at another time (x(0) = x(10)). An `unknown` without an equation 0 = ... is a
constant to be found, and needs one condition more.)"},
    Code{"E245", "a condition stands outside of the run",
         R"(Every condition of a boundary-value problem is at a time between the ends of `run A..B`.)"},
    Code{
        "E246", "starts go in a circle",
        R"(A start may name others at the same time, in whatever order they stand: S(0) = 1 - I(0) - R(0). Each is computed
from those it names, so it cannot lead back to itself, not through a `let` either.

Fix: give one state of the circle a start of its own, or solve for it by hand: x(0) = 1 - x(0)/2 is x(0) = 2/3.)"},
    Code{"E250", "there is no such mode",
         R"(`in MODE`, `go MODE` and `start in MODE` name a mode of the model: mode NAME { equations }.)"},
    Code{
        "E251", "an event does two things at once",
        R"(All assignments of an event read the state from before it and happen together, so each state is assigned once on
every path, and one mode is gone to:

  when h falls through 0 {
    if h' < -1 { h' := -e*h' } else { h' := 0 }
  })"},
    Code{"E252", "this cannot be assigned",
         R"(Events change states only. A param that changes at events is a state that keeps still between them:

  level' = 0
  level(0) = 1
  every 2 { level := level/2 })"},
    Code{
        "E260", "there is no such method",
        R"(explicit_euler (also euler), semi_implicit_euler, central_difference, velocity_verlet, midpoint, heun, rk4, rk38,
bogacki_shampine3, dormand_prince5, tsitouras5, dop853, verner7, verner9 and many more.)"},
    Code{"E261", "a time or tolerance is not sensible",
         R"(The run ends after it begins; steps, output intervals, periods and tolerances are greater than zero.)"},
    Code{
        "E262", "said twice",
        R"(A model has one `run`, one `start in` and one `world`. Other experiments are options of the command: --until,
--method, --step.)"},
    Code{
        "E263", "the number of tolerances is wrong",
        R"(abs takes one tolerance for all states or one for each, in the order in which `continuo info` lists them.)"},
    Code{
        "E264", "the method does not fit the model",
        R"(velocity_verlet and central_difference are for x'' = a(t, x): every state must be a position or its velocity, and
both in units that fit (x in m, x' in m/s, time in s). The others are general. A world of bodies is moved by its mode,
exact or fast.)"},
    Code{"E265", "there is nothing to drag",
         R"(`drag` lets the mouse move the states that a point depends on: ball (x, y) drag, or for a pendulum
ball (l*sin(theta), -l*cos(theta)) drag. A point that depends on none stays where it is.)"},
    Code{"E270", "a file is not there", R"(Files of tables and inputs are found relative to the folder of the model.)"},
    Code{"E271", "a table is wanted, or not",
         R"(table NAME from "file.csv" is read by interp(NAME, x), and by nothing else.)"},
    Code{
        "E272", "a file is not a table",
        R"(Columns of numbers, told apart by commas, semicolons or blanks; the first one increases. A first line of names
is fine. An input reads the column of its own name, or the second one.)"},
    Code{"E280", "there is nothing to simulate",
         R"(The least model is an equation and its start: x' = -x and x(0) = 1.)"},
    Code{
        "E281", "a check cannot be made",
        R"(A check looks at times within the run, at events that the model has (the text is the beginning of an event's name as
in `continuo info`), at energy where an energy is declared.)"},
    Code{
        "E282", "a value at a time stands outside a check",
        R"(x(3) = 1 is a condition and check x(3) = 1 a check. Elsewhere only the present is known. A product needs its sign:
k*(x + 1), not k(x + 1).)"},
    Code{"E290", "a value lies outside its range",
         R"(A warning: the range of a param or input is that of its slider, and its value does not lie in it.)"},
    Code{"E291", "an event never happens", R"(A warning: the condition of the event is the same number at all times.)"},
    Code{
        "E292", "a method loses its order",
        R"(A warning: velocity_verlet and central_difference take accelerations that depend on time and positions only. With
friction or a Coriolis force they still run, at lower order.)"},
    Code{
        "E293", "a group of bodies that nothing ignores",
        R"(A warning: bodies of a group collide like all others unless the world says `ignore GROUP with GROUP`. The other way
round, a group that is ignored and that no body is in is a name misspelled.)"},
    Code{"E294", "a force on a body that does not move",
         R"(A warning: a fixed body stays where it is, whatever acts on it.)"},
    Code{
        "E295", "bodies overlap at the start",
        R"(A warning: bodies begin within each other, or beyond a wall. What follows is no motion of hard bodies: the exact mode
sends apart those that approach, the fast mode pushes all of them apart.

Fix: leave room, or let their groups ignore each other.)"},
};

}  // namespace

std::span<const Code> check_codes() {
  return check_entries;
}

}  // namespace continuo::model
