// E3xx: the model is right, but the numbers failed, or the run was asked for something it cannot do.
#include <array>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

namespace {

constexpr std::array numerical_entries = {
    Code{"E300", "the run ended early",
         R"(The run stopped before its end for a reason that has no code of its own. What was computed is kept.)"},
    Code{"E301", "the equations give no finite number",
         R"(A right-hand side was infinite or not a number, and smaller steps did not help: a division by zero, the root
or logarithm of a negative number, or an exponential beyond 1e308.

  x' = sqrt(-x)          with x(0) = 1

Fix: look at the state named and at the time given; guard the expression (max(x, 0)), stop before the place with
`when ... { stop }`, or mend the equation.)"},
    Code{"E302", "the step shrinks to nothing",
         R"(To keep the tolerance the step became so small that t + h is t. The solution escapes to infinity in finite
time (x' = x^2), jumps where the text has no event, or the tolerance is below rounding. With `0 = ...` it may be a fold:
the unknown has no solution beyond that place.

Fix: a jump in a right-hand side wants an event (`when`, `at`); a true singularity wants `when ... { stop }` before it;
a tolerance below 1e-14 wants to be larger.)"},
    Code{"E303", "too many steps",
         R"(The run needs more steps than it may take: 10 million, or what `max steps` or --max-steps say. Most often
the equations are stiff: a fast part of them has died out, and would come back and grow without end if the step were
longer than about twice its time. An explicit method must then creep along although nothing happens; stability bounds
its steps, not accuracy, and a looser tolerance does not help.

  x'' = 1e6*(1 - x^2)*x' - x      between its jumps x hardly moves, and deviations die out within a microsecond

Fix: take an implicit method, whose steps the fast part does not bound: rodas5p for a few equations, radau for tight
tolerances, bdf for many equations.

  continuo run FILE --method rodas5p

If the message does not say that the system is stiff: loosen the tolerance or shorten the run.)"},
    Code{"E304", "every step is rejected",
         R"(Many smaller and smaller steps were tried at one place and none met the tolerance: the right-hand side jumps
there, or is noisy at the level of the tolerance.

Fix: describe a jump as an event, or loosen the tolerance.)"},
    Code{
        "E305", "the implicit equations find no solution",
        R"(An implicit method solves equations in each step, and their solver did not converge even with small steps. At the
start of a run it is the equations `0 = ...` that found no values for their unknowns.

Fix: at the start, begin nearer to a solution (unknown v = GUESS), or look for a contradiction in the equations. Later,
look whether a right-hand side jumps (make the jump an event) or is not defined where the solver tries it; else loosen
the tolerance, or take another method.)"},
    Code{"E306", "the run cannot begin",
         R"(Something it begins with is no number: an initial value that divides by zero, a time that is infinite.

Fix: look at the initial values with the parameters of this run; `continuo info` prints them.)"},
    Code{"E307", "interrupted",
         R"(The run was interrupted (Ctrl-C). What was computed until then is kept and written.)"},
    Code{"E310", "events accumulate",
         R"(An event happens again and again, ever faster, and its times tend to a limit: a ball that loses part of its
speed at each bounce bounces infinitely often in finite time (Zeno). Or two events switch back and forth at one instant
(chattering). No simulator can go beyond; going on would let the ball fall through the floor.

Fix: say after `then` what happens at the limit. A ball comes to rest in a mode of its own:

  mode flight { h'' = -g }
  mode rest   { h'' = 0 }
  when h falls through 0 in flight { h := 0; h' := -e*h' } then { h := 0; h' := 0; go rest }

A thermostat that clicks for ever needs a gap between `on` and `off`. `stop` and `stop after 10` end the run before.)"},
    Code{
        "E320", "the method cannot solve algebraic equations",
        R"(The model has equations `0 = ...` with unknowns. Explicit methods compute derivatives only; they have no way to
satisfy an equation.

Fix: take an implicit method for stiff systems, such as rodas5p, radau or bdf, or leave the choice to Continuo. Where
the unknown can be written as an expression, `let` does without an equation.)"},
    Code{"E321", "conditions at different times do not fit here",
         R"(The model gives values of its states at different times (x(0) = 1; x(7) = 4). `continuo run` solves such
problems, for models without events, modes and algebraic equations; what integrates from the start cannot.

Fix: give all values at the start, or take `continuo run`.)"},
    Code{
        "E322", "the boundary-value problem was not solved",
        R"(No motion was found that meets the conditions at all their times. There may be none, or several, or the search
began too far away; or the conditions hardly determine it, so that rounding alone moves it by more than the tolerance.

Fix: guess x = ... gives the search a place to begin, as a function of t; `guess x' = ...` too. `continuo run --along
eps=1..1e-3` begins where a parameter makes the problem easy, --guess FILE with an earlier run. A greater tolerance asks
for less.)"},
    Code{
        "E323", "a world of bodies does not fit here",
        R"(Bodies collide, which no study of equations can see: `continuo run`, `verify`, `compare` and `converge` move a world,
`sense` and `fit` compare runs of it with other parameters, `check` and `info` read it. A world has no x' = f(x) to find
rest, orbits or a linearization of, no equations `0 = ...` beside it and no conditions at several times.)"},
    Code{"E324", "the bodies cannot be moved on",
         R"(The motion of the world ended before the run did; the message says why. What was computed is kept.

A force or a start that is no number, a spring too stiff for the step (take a smaller one, or `mode exact`), bodies that
collide without end between others that press them (take `mode fast`).)"},
    Code{
        "E325", "a recording does not fit its model",
        R"(`continuo replay` and `continuo resume` read the model from the recording itself, but tables from their files. The
numbers in it are of other states than the model has, or of a world that cannot be: the file was made by another
version, or changed.)"},
    Code{"E330", "there is no such method", R"(`continuo methods` lists the methods with their order and use.)"},
    Code{
        "E331", "the method needs a step",
        R"(Methods with an error estimate choose their step by the tolerance. This one has none: it takes equal steps, and you
say how long they are.

Fix: --step 0.01, or in the model:  run 0..10 method rk4, step 0.01)"},
    Code{"E332", "the method does not fit the equations",
         R"(Methods such as velocity_verlet and semi_implicit_euler move positions by velocities. They need equations of
the form x'' = a(t, x): every state is a position or the velocity of one.

Fix: take a method for first-order equations, such as rk4 or tsitouras5.)"},
    Code{
        "E333", "the experiment cannot be run",
        R"(The run statement, or what replaced parts of it, makes no sense: an end before the start, a step or an interval
that is not positive, a number of tolerances that is not that of the states.)"},
    Code{
        "E334", "there is no such method for bodies",
        R"(A world is moved `exact`, from collision to collision, where under forces the paths between are integrated by `dop853`
to a tolerance or by `rk4` with a step; or `fast` in steps, its forces by semi_implicit_euler, implicit_euler,
central_difference or explicit_euler. Each of these names may stand behind --method.)"},
    Code{
        "E335", "a mass matrix is singular at the start",
        R"(The equations are solved for their highest derivatives: m*x'' = F by a division by m, coupled ones by the matrix
before them. With the parameters and the state of the start that is 0, or the matrix is singular, so the equations say
nothing of these derivatives.

Fix: a mass, a capacity or an inertia of 0 leaves an equation without derivative: declare `unknown x = guess` and write
0 = F. Where only this one state is singular, start beside it.)"},
    Code{"E340", "there is no such parameter",
         R"(--set takes the names of parameters, with their index where they have one: --set k=5 --set m[2]=3.
`continuo info FILE` lists them. Initial values are set through the parameter they use.)"},
    Code{"E341", "the value cannot be set",
         R"(--set NAME=VALUE takes what may stand behind `param NAME =`: a number, an expression of numbers, with a unit
where wanted (--set "k=30 [N/cm]"). Without a unit the parameter's own is meant; one that measures something else is
refused.)"},
    Code{
        "E342", "the value is outside the declared range",
        R"(The model declares a range for the parameter (in 0..1). The run goes on with your value; the range is what the
slider of the live view offers and what the author thought of.)"},
    Code{
        "E343", "the parameter decides how many equations there are",
        R"(A parameter that stands in the bounds of a `for` or `sum` (for i in 1..N) makes the equations; a model that has
been read cannot change it any more. The command line reads the model anew; in C++ give it to `load`:

  load("heat.sim", {.overrides = {{"N", 200}}}))"},
    Code{
        "E344", "there is no such state",
        R"(--tol and --atol take the names of states as the columns of the table call them, with primes and index where they
have them: --atol "h'=1e-9" --tol "u[3]=1e-10". The name of a family without an index means all of it: --tol u=1e-10.)"},
    Code{
        "E345", "the tolerance cannot be used",
        R"(--tol takes a relative tolerance, a number without a unit between 0 and 1; --atol an absolute one, in the unit of
the state unless it names another of the same kind: --atol "h = 1 [um]". With NAME= before it the tolerance is that of
one state, without it that of all.)"},
    Code{
        "E349", "the guess does not fit the model",
        R"(--guess reads where to begin from a CSV file, as `continuo run -o` writes it: a column `t` and columns named like
states, `y` or `y'`. It needs one of them at least, at times within the run.)"},
    Code{
        "E361", "there are no sensitivities of this",
        R"(Where a model has equations `0 = ...`, events that change its state or mode cannot be followed. A parameter that
decides how many equations there are, the guess of an algebraic unknown, and the value at the start of a state that
conditions at several times determine are nothing to differentiate by.)"},
};

}  // namespace

std::span<const Code> numerical_codes() {
  return numerical_entries;
}

}  // namespace continuo::model
