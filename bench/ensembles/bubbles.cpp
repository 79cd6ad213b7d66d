// Bubbles in water under two frequencies of sound, by the equation of J. Keller and M. Miksis (J. Acoust. Soc. Am. 68,
// 1980) in the dimensionless form of the first tutorial of MPGOS: x = R / R0, time in periods of the first frequency.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <bench/ensembles/hard_problems.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>

namespace continuo::bench {
namespace {

using Bubble = std::array<double, 2>;
using Coefficients = std::array<double, 12>;

constexpr std::size_t grid = 16, bubbles = grid * grid;
constexpr double periods = 2;

const auto bubble = [](const auto& t, const auto& x, auto& dxdt, const auto& p) {
  using std::cos, std::pow, std::sin;
  constexpr double turn = 2 * std::numbers::pi;
  const auto first = turn * t, second = turn * (p[11] * t);
  const auto inverse = 1.0 / x[0];
  const auto relative = 1.0 + p[9] * x[1];
  const auto numerator = (p[0] + p[1] * x[1]) * pow(inverse, p[10]) - p[2] * relative - (p[3] + p[4] * x[1]) * inverse -
                         1.5 * (1.0 - p[9] * x[1] * (1.0 / 3.0)) * x[1] * x[1] -
                         (p[5] * sin(first) + p[6] * sin(second)) * relative -
                         x[0] * (p[7] * cos(first) + p[8] * cos(second));
  dxdt[0] = x[1];
  dxdt[1] = numerator / (x[0] - p[9] * x[0] * x[1] + p[4] * p[9]);
};

/// A bubble of 10 um in water of 25 degrees, under 0.5 and 0.7 bar of two frequencies from 20 to 1000 kHz.
Coefficients coefficients(std::size_t run) {
  constexpr double vapour = 3166.775638952003, density = 997.0639504998557, tension = 0.071977583160056,
                   viscosity = 8.902125058209557e-4, sound = 1497.251785455527, radius = 1e-5, ambient = 1e5,
                   exponent = 1.4, amplitude1 = 0.5e5, amplitude2 = 0.7e5;
  const auto frequency = [](std::size_t i) {
    return 2e4 * std::pow(50.0, static_cast<double>(i) / static_cast<double>(grid - 1));
  };
  const double f1 = frequency(run % grid), f2 = frequency(run / grid), period = 1 / f1;
  const double gas = 2 * tension / radius + ambient - vapour, scale = period * period / (radius * radius * density);
  const double turn = 2 * std::numbers::pi, compressed = radius * turn / (density * sound) * scale * density;
  return {gas * scale,
          (1 - 3 * exponent) * gas * period / (radius * sound * density),
          (ambient - vapour) * scale,
          2 * tension / radius * scale,
          4 * viscosity * period / (density * radius * radius),
          amplitude1 * scale,
          amplitude2 * scale,
          compressed * f1 * amplitude1,
          compressed * f2 * amplitude2,
          radius * f1 / sound,
          3 * exponent,
          f2 / f1};
}

template <class M>
std::vector<Bubble> together(double tolerance) {
  const auto start = [](std::size_t run) { return RunStart{Bubble{1, 0}, coefficients(run)}; };
  const auto result =
      ensemble(bubble, starts(bubbles, start), {0, periods}, M{}, {.rtol = tolerance, .atol = tolerance, .threads = 1});
  std::vector<Bubble> ends;
  for (const auto& run : result.runs) ends.push_back(run.x);
  return ends;
}
template <class Stepper>
std::vector<Bubble> odeint(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  std::vector<Bubble> ends;
  for (std::size_t run = 0; run < bubbles; ++run) {
    Bubble x{1, 0};
    const auto f = [p = coefficients(run)](const Bubble& y, Bubble& dydt, double t) { bubble(t, y, dydt, p); };
    odeint::integrate_adaptive(odeint::make_controlled(tolerance, tolerance, Stepper()), f, x, 0.0, periods, 0.01);
    ends.push_back(x);
  }
  return ends;
}

}  // namespace

void compare_bubbles() {
  constexpr double allowed = 1e-6;
  const std::vector<Bubble> exact = together<Verner9>(1e-13);
  std::printf("256 bubbles by Keller and Miksis under two frequencies, 2 periods of the first\n");
  std::printf("  the reference differs from that of dop853 by %.1e\n",
              largest_error_of(together<Dop853>(1e-13), exact));
  namespace peers = boost::numeric::odeint;
  const Cost high = cost_at(allowed, exact, odeint<peers::runge_kutta_fehlberg78<Bubble>>);
  const Cost low = cost_at(allowed, exact, odeint<peers::runge_kutta_dopri5<Bubble>>);
  const Cost& unit = high.seconds < low.seconds ? high : low;
  print_cost("odeint runge_kutta_fehlberg78", high, bubbles, unit);
  print_cost("odeint runge_kutta_dopri5", low, bubbles, unit);
  print_cost("ensemble, dop853", cost_at(allowed, exact, together<Dop853>), bubbles, unit);
  print_cost("ensemble, verner9", cost_at(allowed, exact, together<Verner9>), bubbles, unit);
}

}  // namespace continuo::bench
