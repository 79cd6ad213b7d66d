// The models of the recorded runs that are initial inputs of the fuzzer of recordings.
#pragma once
#include <array>

namespace continuo {

struct RecordedModel {
  const char* name;  // of the file with its run
  const char* text;
};

/// By all that a run remembers: an exact world and a fast one, with equations and events.
inline constexpr std::array<RecordedModel, 3> recorded_models{{
    {"exact", R"(
world { gravity (0, -10); wall floor (0, 1) at 0; material restitution 0.7 friction 0.2
  body ball at (0, 2) velocity (1, 0); body other at (3, 1); spring ball to other stiffness 3; container box (-4, 0) to (4, 9) }
when ball.y falls through 1 { mark "low" }
run 0..1 output 0.1
)"},
    {"fast_with_equations", R"(
world { gravity (0, -10); wall floor (0, 1) at 0; body ball at (0, 2) velocity (1, 0); body other at (3, 1)
  character hero at (5, 1) walk u; mode fast step 1/60 }
force on ball = (-2*(ball.x - u), 0)
u' = ball.x - u
u(0) = 1
every 0.3 { ball.x' := ball.x' + 0.01 }
check ball.y(0.5) = 1 within 100
check energy drift < 1000
run 0..1 output 0.1
)"},
    {"exact_with_equations", R"(
world { dimension 3; body ball at (0, 0, 2) velocity (1, 0, 0); wall (0, 0, 1) at 0 }
force on ball = (-u*ball.x, 0, -1)
u'' = -u
u(0) = 1; u'(0) = 0
run 0..1 output log 3 per decade from 0.01
)"},
}};

/// Of equations: events with modes and a schedule, jumps of equations, algebraic equations. No two have as many states.
inline constexpr std::array<RecordedModel, 3> recorded_equations{{
    {"equations", R"(
param g = 9.8
mode flight { h'' = -g }
mode rest { h'' = 0 }
h(0) = 1; h'(0) = 0
when h falls through 0 in flight { h := 0; if -0.5*h' > 0.3 { h' := -0.5*h' } else { h' := 0; go rest } }
every 0.3 { mark "tick" }
energy height = g*h
run 0..1 output 0.1 method dop853_radau tol 1e-4
)"},
    {"equations_with_jumps", R"(
v' = sin(9*t) - 0.5*sign(v)
u' = floor(3*t) - 100*u
w' = v*u
v(0) = 0.3; u(0) = 0; w(0) = 1
check always w < 100
run 0..1 output 0.1 method bdf tol 1e-4
)"},
    {"algebraic_equations", R"(
unknown v = 0.6
q' = 1e-3*(exp(v/0.2) - 1)
0 = 3 - q - 1e-3*(exp(v/0.2) - 1) - v
p'' = -p
q(0) = 0; p(0) = 1; p'(0) = 0
when v falls through 0.9 { mark "low" }
run 0..1 output 0.1 method radau tol 1e-4
)"},
}};

}  // namespace continuo
