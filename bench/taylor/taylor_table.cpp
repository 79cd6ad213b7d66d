// What the method `taylor` costs on models: with the program of series, with machine code, and with an event, beside
// dop853 in machine code.
//   taylor_table [TOLERANCE...]: 1e-10 and 1e-15 where none is given
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::bench {
namespace {

/// A model, a state with its value at the end, and an event.
struct Problem {
  const char *title, *text, *event;
  std::size_t state;
  double exact;
};

constexpr Problem problems[] = {
    {"Kepler, e = 0.5, 10 orbits",
     "x'' = -x/hypot(x, y)^3; y'' = -y/hypot(x, y)^3\n"
     "x(0) = 0.5; x'(0) = 0; y(0) = 0; y'(0) = sqrt(3)\nrun 0..20*pi\n",
     "when y crosses 0 { mark \"apsis\" }\n", 2, 0},
    // Computed in binary128.
    {"Lorenz, to t = 10",
     "x' = 10*(y - x); y' = x*(28 - z) - y; z' = x*y - 8/3*z\nx(0) = 1; y(0) = 0; z(0) = 0\nrun 0..10\n",
     "when z crosses 27 { mark \"section\" }\n", 0, -5.85768538242409002},
    {"outer solar system, 1000 years",
     "param N = 6, G = 2.95912208286e-4\n"
     "param m[1..N] = (1.00000597682, 9.54786104043e-4, 2.85583733151e-4, 4.37273164546e-5, 5.17759138449e-5, "
     "1/1.3e8)\n"
     "param x0[1..N] = (0, -3.5023653, 9.0755314, 8.3101420, 11.4707666, -15.5387357)\n"
     "param y0[1..N] = (0, -3.8169847, -3.0458353, -16.2901086, -25.7294829, -25.2225594)\n"
     "param z0[1..N] = (0, -1.5507963, -1.6483708, -7.2521278, -10.8169456, -3.1902382)\n"
     "param u0[1..N] = (0, 0.00565429, 0.00168318, 0.00354178, 0.00288930, 0.00276725)\n"
     "param v0[1..N] = (0, -0.00412490, 0.00483525, 0.00137102, 0.00114527, -0.00170702)\n"
     "param w0[1..N] = (0, -0.00190589, 0.00192462, 0.00055029, 0.00039677, -0.00136504)\n"
     "for i in 1..N {\n"
     "  x[i]'' = sum(j in 1..N where j != i: G*m[j]*(x[j] - x[i])/hypot(x[j] - x[i], y[j] - y[i], z[j] - z[i])^3)\n"
     "  y[i]'' = sum(j in 1..N where j != i: G*m[j]*(y[j] - y[i])/hypot(x[j] - x[i], y[j] - y[i], z[j] - z[i])^3)\n"
     "  z[i]'' = sum(j in 1..N where j != i: G*m[j]*(z[j] - z[i])/hypot(x[j] - x[i], y[j] - y[i], z[j] - z[i])^3)\n"
     "  x[i](0) = x0[i]; x[i]'(0) = u0[i]; y[i](0) = y0[i]; y[i]'(0) = v0[i]; z[i](0) = z0[i]; z[i]'(0) = w0[i]\n"
     "}\nrun 0..365250\n",
     "when y[2] crosses 0 { mark \"node\" }\n", 6, 6.88878506245507991072},
};

struct Cost {
  double milliseconds = std::numeric_limits<double>::infinity();
  std::size_t steps = 0;
  double error = std::numeric_limits<double>::quiet_NaN();
};

constexpr double seconds_of_runs = 2;

/// The least of the runs of two seconds, so that other work on the machine is not in it.
Cost cost(const Problem& problem, const std::string& text, const char* method, double tolerance, bool native) {
  Cost result;
  model::Loaded loaded = model::load(model::Source("problem.sim", text));
  if (!loaded) {
    std::fputs(loaded.text().c_str(), stderr);
    return result;
  }
  const auto use = native ? model::NativeUse::always : model::NativeUse::never;
  loaded.model->native = std::make_shared<model::NativeCompiler>(model::NativeOptions{.use = use});
  const auto program = model::compile(*loaded.model);
  double spent = 0;
  for (int repeat = 0; repeat < 3 || spent < seconds_of_runs; ++repeat) {
    const model::Simulated simulated =
        model::simulate(program, {.method = method, .rtol = tolerance, .atol = {tolerance}, .keep_rows = false});
    if (!simulated.run) return result;
    spent += simulated.run->statistics.seconds;
    result.milliseconds = std::min(result.milliseconds, 1e3 * simulated.run->statistics.seconds);
    result.steps = simulated.run->statistics.steps;
    result.error = std::abs(simulated.run->final_state()[problem.state] - problem.exact);
  }
  return result;
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  std::vector<double> tolerances;
  for (int i = 1; i < count; ++i) tolerances.push_back(std::strtod(arguments[i], nullptr));
  if (tolerances.empty()) tolerances = {1e-10, 1e-15};
  std::puts(
      "| Problem | Tolerance | `taylor`: steps, error | program | machine code | with an event | `dop853`: error | "
      "time |");
  std::puts("|---|---:|---|---:|---:|---:|---|---:|");
  for (const Problem& problem : problems) {
    for (const double tolerance : tolerances) {
      const Cost program = cost(problem, problem.text, "taylor", tolerance, false);
      const Cost native = cost(problem, problem.text, "taylor", tolerance, true);
      const Cost event = cost(problem, std::string(problem.text) + problem.event, "taylor", tolerance, true);
      const Cost other = cost(problem, problem.text, "dop853", tolerance, true);
      std::printf("| %s | %.0e | %zu, %.0e | %.3g ms | %.3g ms | %.3g ms | %.0e | %.3g ms |\n", problem.title,
                  tolerance, native.steps, native.error, program.milliseconds, native.milliseconds, event.milliseconds,
                  other.error, other.milliseconds);
    }
  }
}
