// Implicit methods with a dense Jacobian by differences, on states of run-time size: x decays fast to cos t, and an
// oscillator by a method of structural dynamics.
#include <cmath>
#include <span>
#include <vector>

#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>

int main() {
  using X = std::vector<double>;
  const auto relaxation = [](double t, const X& x, X& dxdt) {
    dxdt[0] = -1e4 * (x[0] - std::cos(t)) - std::sin(t);
    dxdt[1] = -x[1];
  };
  const auto stiff = continuo::solve(relaxation, X{1, 1}, {0, 2}, continuo::Bdf{}, {.rtol = 1e-8, .atol = 1e-10});
  const X& x = stiff.final_state();
  if (!stiff.outcome || std::abs(x[0] - std::cos(2.0)) > 1e-5 || std::abs(x[1] - std::exp(-2.0)) > 1e-5) return 1;

  const auto oscillator =
      continuo::second_order([](double, std::span<const double> q, std::span<double> a) { a[0] = -q[0]; });
  const auto structure = continuo::solve(oscillator, X{1, 0}, {0, 2}, continuo::Newmark{}, {.step = 1e-3});
  return structure.outcome && std::abs(structure.final_state()[0] - std::cos(2.0)) < 1e-6 ? 0 : 2;
}
