// What it costs to prove that a guard has no root in a step: a guard of ten operations enclosed over the whole step,
// against the step itself, by dop853 on the same small model; and guards of unknowns, by rodas5p.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::vector<double>;

// Ten operations each, far from zero.
const char* const oscillator = R"(
param k = 4, c = 0.1, m = 2, g = 9.81, r = 3, drive = 0.5
x'' = -k/m*x - c/m*x' + drive*sin(t)
x(0) = 1; x'(0) = 0
when r*r - x*x - x'*x' + 0.5*x*x' + k*t + 20 falls through 0 { mark "left" }
)";
const char* const pendulum = R"(
param g = 9.81, l = 1.5, c = 0.05
a'' = -g/l*sin(a) - c*a'
a(0) = 1; a'(0) = 0
when (a'^2*l - g*cos(a))*c*0.1 + l*sin(a) + 5 - a falls through 0 { mark "low" }
)";
const char* const lorenz = R"(
param s = 10, r = 28, b = 2.6666666666666665
x' = s*(y - x)
y' = x*(r - z) - y
z' = x*y - b*z
x(0) = 1; y(0) = 1; z(0) = 1
when x*x + y*y + (z - r)*(z - r) + s*z - x*y*0.1 + 1000 falls through 0 { mark "out" }
)";

// A pendulum of two coordinates, whose force in the rod is the unknown; a transistor's node; a ladder of diodes.
const char* const rod = R"(
unknown force = 10
param g = 9.81
x'' = -force*x
y'' = -force*y - g
x(0) = 1; x'(0) = 0; y(0) = 0; y'(0) = 0
0 = x'^2 + y'^2 - force*(x^2 + y^2) - g*y
when force falls through -5 { mark "slack" }
)";
const char* const node = R"(
unknown u = 0.1
c' = 1 - u
c(0) = 0.5
0 = (sin(3*t) + c - u)/2 - 1e-3*(exp(u/0.3) - 1)
when u rises through 5 { mark "high" }
)";

std::string ladder(std::size_t nodes) {
  std::string text = "c' = 1 - u1\nc(0) = 0.5\n";
  const auto u = [&](std::size_t i) { return i == 0 ? "(sin(3*t) + c)" : i > nodes ? "0" : "u" + std::to_string(i); };
  for (std::size_t i = 1; i <= nodes; ++i)
    text += "unknown " + u(i) + " = 0.1\n0 = " + u(i - 1) + " - 2*" + u(i) + " + " + u(i + 1) + " - 1e-3*(exp(" + u(i) +
            "/0.3) - 1)\n";
  return text + "when " + u(nodes) + " rises through 5 { mark \"high\" }\n";
}

/// Seconds of one call: the least of several runs.
template <class F>
double seconds(std::size_t calls, F&& f) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 500; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t k = 0; k < calls; ++k) f();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    least = std::min(least, passed.count() / static_cast<double>(calls));
  }
  return least;
}

template <class Method>
void compare(const char* title, const std::string& text, double end) {
  model::Loaded loaded = model::load(model::Source(std::string(title) + ".sim", text));
  if (!loaded.model) {
    std::fputs(loaded.text().c_str(), stderr);
    return;
  }
  const auto program = model::compile(std::move(*loaded.model));
  const auto variables = model::start_values(program->model);
  const model::ModelSystem system(program, variables);
  const auto states = variables.begin() + program->model.layout.states;
  const X start(states, states + static_cast<std::ptrdiff_t>(program->model.states.size()));

  const Options<X> options{.rtol = 1e-6, .atol = 1e-6, .save = Save<X>::only_end()};
  double step = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 100; ++repeat) {
    const auto run = solve(system, start, {0, end}, Method{}, options);
    step = std::min(step, run.statistics.seconds / static_cast<double>(run.statistics.steps));
  }

  // The dense output of a step behind the first ones, which are short.
  Integrator integrator(system, start, {0, end}, Method{}, options);
  for (int k = 0; k < 10; ++k) integrator.advance();
  const std::span<const X> output = integrator.dense_output();
  const model::Step of{integrator.step_begin(), integrator.step_size(), output};
  const model::NodeId guard = program->model.events.front().guard;
  const auto block = model::UnknownCoupling(*program, system.equations()).block(guard);
  const std::size_t blocks = block && !block->empty() ? 1 : 0;
  model::StepEnclosure enclosure(*program, std::span(&guard, 1), variables, std::span(&*block, blocks));
  Enclosure<double> found;
  const double with_slope = seconds(500, [&] { found = enclosure.over(of, 0, 1)[0].value; });
  const double value = seconds(500, [&] { found = enclosure.values_over(of, 0, 1)[0]; });
  std::printf("| %s | %.0f | %.0f | %.0f | **%.2f** | %.2f |\n", title, 1e9 * step, 1e9 * value, 1e9 * with_slope,
              value / step, with_slope / step);
  if (found.holds(0)) std::puts("the guard is not proved to be free of roots");
}

}  // namespace
}  // namespace continuo::bench

int main() {
  using namespace continuo;
  using namespace continuo::bench;
  std::puts("| Model | Step, ns | Values, ns | Values and slopes, ns | Values : step | Values and slopes : step |");
  std::puts("|---|---|---|---|---|---|");
  compare<Dop853>("Oscillator", oscillator, 100);
  compare<Dop853>("Pendulum", pendulum, 100);
  compare<Dop853>("Lorenz", lorenz, 20);
  compare<Rodas5P>("Force in a rod, 1 unknown", rod, 10);
  compare<Rodas5P>("Diode, 1 unknown", node, 10);
  compare<Rodas5P>("Ladder, 5 unknowns", ladder(5), 10);
  compare<Rodas5P>("Ladder, 20 unknowns", ladder(20), 10);
}
