// E3xx: the model is right, but the numbers failed, or the run was asked for something it cannot do.
#include <array>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

namespace {

constexpr std::array numerical_entries = {
    Code{"E300", "the run ended early",
         R"(The run stopped before its end for a reason that has no code of its own. What was computed is kept.)"},
    Code{"E301", "the equations give no finite number",
         R"(A right-hand side was infinite or not a number, and smaller steps did not help. Possible causes are a
division by zero, the root or logarithm of a negative number, and an exponential beyond 1e308.

  x' = sqrt(-x)          with x(0) = 1

Fix: check the equation of the named state at the given time; guard the expression (max(x, 0)), stop before this
point with `when ... { stop }`, or correct the equation.)"},
    Code{"E302", "the step shrinks to nothing",
         R"(To meet the tolerance the step became so small that t + h equals t. The solution tends to infinity in
finite time (x' = x^2), jumps without an event, or the tolerance is below rounding. With `0 = ...` the cause may be a
fold, beyond which the unknown has no solution.

Fix: describe a jump of a right-hand side by an event (`when`, `at`); stop before a singularity with
`when ... { stop }`; increase a tolerance below 1e-14.)"},
    Code{
        "E303", "too many steps",
        R"(The run needs more steps than the limit: the number given by `max steps` or --max-steps, else 10 million. Where
the step is given, its steps do not count unless a limit is. A run with --record can go on: `continuo resume`.
Most often the equations are stiff: a fast component has decayed, but would grow without bound if the step were longer
than about twice its time constant. Stability, not accuracy, then limits the steps of an explicit method, although the
solution hardly changes, and a larger tolerance does not help.

  x'' = 1e6*(1 - x^2)*x' - x      between its jumps x hardly moves, and deviations die out within a microsecond

Fix: use an implicit method, whose steps the fast component does not limit: rodas5p for a few equations, radau for tight
tolerances, bdf for many equations.

  continuo run FILE --method rodas5p

If the message does not mention stiffness, increase the tolerance or shorten the run.)"},
    Code{"E304", "every step is rejected",
         R"(Steps of decreasing size were tried at one point, and none met the tolerance: the right-hand side jumps
there, or is noisy at the level of the tolerance.

Fix: describe a jump by an event, or increase the tolerance.)"},
    Code{"E305", "the implicit equations find no solution",
         R"(An implicit method solves equations in each step, and their solver did not converge even with small steps.
At the start of a run it is the equations `0 = ...` that found no values for their unknowns.

Fix: at the start, give a better guess (unknown v = GUESS), or look for a contradiction in the equations. Later,
check whether a right-hand side jumps (describe the jump by an event) or is undefined where the solver evaluates
it; otherwise increase the tolerance, or use another method.)"},
    Code{"E306", "the run cannot begin",
         R"(An initial value or a time of the run is not a finite number, for example because of a division by zero.

Fix: check the initial values with the parameters of this run; `continuo info` prints them.)"},
    Code{"E307", "interrupted",
         R"(The run was interrupted (Ctrl-C). What was computed until then is kept and written.)"},
    Code{"E310", "events accumulate",
         R"(An event occurs at ever shorter intervals, and its times converge to a limit: a ball that loses part of
its speed at each bounce bounces infinitely often in finite time (Zeno behaviour). Or two events alternate at one
instant (chattering). Infinitely many events cannot be simulated; without them the ball would fall through the floor.

Fix: give the event actions for the limit, after `then`. A ball comes to rest in a mode of its own:

  mode flight { h'' = -g }
  mode rest   { h'' = 0 }
  when h falls through 0 in flight { h := 0; h' := -e*h' } then { h := 0; h' := 0; go rest }

A thermostat that chatters needs a gap between `on` and `off` (hysteresis). `stop` and `stop after 10` end the run
before.)"},
    Code{"E320", "the method cannot solve algebraic equations",
         R"(The model has equations `0 = ...` with unknowns. Explicit methods compute derivatives only; they have no
way to satisfy an equation.

Fix: use an implicit method such as rodas5p, radau or bdf, or leave the choice to Continuo. If the unknown can be
written as an expression, use `let` instead of an equation.)"},
    Code{"E321", "conditions at different times do not fit here",
         R"(The model gives values of its states at different times (x(0) = 1; x(7) = 4). `continuo run` solves such
problems, for models without events, modes and algebraic equations; verbs that integrate from the start cannot.

Fix: give all values at the start, or use `continuo run`.)"},
    Code{"E322", "the boundary-value problem was not solved",
         R"(No solution was found that satisfies all conditions. There may be none, or several, or the initial guess
was too far away; or the problem is so ill-conditioned that rounding alone changes the solution by more than the
tolerance.

Fix: `guess x = ...` gives an initial guess as a function of t; `guess x' = ...` as well.
`continuo run --along eps=1..1e-3` starts from a parameter value that makes the problem easy, --guess FILE from an
earlier run. Or increase the tolerance.)"},
    Code{"E323", "a world of bodies does not fit here",
         R"(Collisions of bodies are not part of the equations: `continuo run`, `verify`, `compare` and `converge`
simulate a world, `sense` and `fit` compare runs of it with different parameters, `check` and `info` read it. A
world has no equations x' = f(x) for equilibria, orbits or a linearization; it cannot be combined with equations
`0 = ...` or with conditions at several times.)"},
    Code{"E324", "the bodies cannot be moved on",
         R"(The motion of the world ended before the run did; the message says why. What was computed is kept.

Possible causes: a force or an initial value is not a number; a spring is too stiff for the step (use a smaller step, or
`mode exact`); bodies pressed between others collide without end (use `mode fast`).)"},
    Code{"E325", "a recording does not fit its model",
         R"(`continuo replay` and `continuo resume` read the model from the recording itself, but tables from their
files. Its states differ from those of the model, or its world is invalid: the file was written by another version,
or changed.)"},
    Code{"E330", "there is no such method", R"(`continuo methods` lists the methods with their order and use.)"},
    Code{"E331", "the method needs a step",
         R"(Methods with an error estimate choose their step size by the tolerance. This method has none: it uses a
fixed step size, which you must give.

Fix: --step 0.01, or in the model:  run 0..10 method rk4, step 0.01)"},
    Code{"E332", "the method does not fit the equations",
         R"(Methods such as velocity_verlet and semi_implicit_euler update positions and velocities separately. They
need equations of the form x'' = a(t, x): every state must be a position or its velocity.

Fix: use a method for first-order equations, such as rk4 or tsitouras5.)"},
    Code{"E333", "the experiment cannot be run",
         R"(The run statement, or an option that replaces a part of it, is invalid: an end before the start, a step
or an interval that is not positive, or a number of tolerances different from the number of states.)"},
    Code{"E334", "there is no such method for bodies",
         R"(A world is moved `exact`, from collision to collision, where under forces the paths between are
integrated by `dop853` to a tolerance or by `rk4` with a step; or `fast` in steps, its forces by
semi_implicit_euler, symplectic_euler_position_first, implicit_euler, central_difference or explicit_euler. Each of
these names may stand behind --method.)"},
    Code{"E335", "a mass matrix is singular at the start",
         R"(The equations are solved for their highest derivatives: m*x'' = F by a division by m, coupled ones by the
matrix before them. With the parameters and the initial state this coefficient is 0, or the matrix is singular, so the
equations do not determine these derivatives.

Fix: a mass, a capacity or an inertia of 0 leaves an equation without derivative: declare `unknown x = guess` and write
0 = F. Where only this one state is singular, start beside it.)"},
    Code{"E340", "there is no such parameter",
         R"(--set takes the names of parameters, with their index where they have one: --set k=5 --set m[2]=3.
`continuo info FILE` lists them. Initial values are set through the parameter they use.)"},
    Code{"E341", "the value cannot be set",
         R"(--set NAME=VALUE accepts the same values as `param NAME =`: a number or an expression of numbers,
optionally with a unit (--set "k=30 [N/cm]"). The default is the unit of the parameter; a unit of a different
dimension is rejected.)"},
    Code{"E342", "the value is outside the declared range",
         R"(The model declares a range for the parameter (in 0..1). The run uses your value; the range is that of
the slider in the live view, intended by the author of the model.)"},
    Code{"E343", "the parameter decides how many equations there are",
         R"(A parameter in the bounds of a `for` or `sum` (for i in 1..N) determines the number of equations, so it
cannot be changed after the model has been read. The command line reads the model again; in C++ pass the value to
`load`:

  load("heat.sim", {.overrides = {{"N", 200}}}))"},
    Code{"E344", "there is no such state",
         R"(--initial, --tol and --atol accept the column names of states, with primes and index: --atol "h'=1e-9" --tol
"u[3]=1e-10". The name of a family without an index means all of its members: --tol u=1e-10.)"},
    Code{"E345", "the tolerance cannot be used",
         R"(--tol takes a relative tolerance, a number without a unit between 0 and 1; --atol an absolute one, in
the unit of the state unless it names another of the same kind: --atol "h = 1 [um]". With NAME= before it the
tolerance is that of one state, without it that of all.)"},
    Code{
        "E346", "the initial value cannot be used",
        R"(The text behind --initial is not an initial value. The name is that of a state as the columns of a run have it
(x, x', u[3]) or of a family of states (u); the value is read like that of a parameter in a model, and its unit, if
there is one, measures the same kind of quantity as the state. Bodies begin where `world` puts them, and a
boundary-value problem has no start.

Fix: for example --initial x=3, --initial "x'=0.5 [m/s]", --initial "u[1]=2".)"},
    Code{"E348", "the text is no plot",
         R"(--plot takes the name of a picture, or plots in words: the curves, what they are drawn against (t where
nothing is said), for families the times of their profiles, and `log x`, `log y` or `log xy` for logarithmic axes:

  --plot ball.svg --plot "h, h'" --plot "h' against h"
  --plot heat.png --plot "u[1..N] against index at 0, 1, 5; u[3] against t log xy")"},
    Code{"E349", "the guess does not fit the model",
         R"(--guess reads the initial guess from a CSV file, as written by `continuo run -o`: a column `t` and at
least one column with the name of a state, `y` or `y'`, at times within the run.)"},
    Code{"E361", "there are no sensitivities of this",
         R"(Sensitivities through events that change the state or the mode are not available for models with
equations `0 = ...`. It is not possible to differentiate by a parameter that determines the number of equations, by
the guess of an unknown, or by an initial value that follows from conditions at several times.)"},
};

}  // namespace

std::span<const Code> numerical_codes() {
  return numerical_entries;
}

}  // namespace continuo::model
