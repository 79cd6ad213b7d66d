// An implicit method with a dense Jacobian by differences, a state of run-time size: x decays fast to cos t.
#include <cmath>
#include <vector>

#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/solve/solve.hpp>

int main() {
  using X = std::vector<double>;
  const auto relaxation = [](double t, const X& x, X& dxdt) {
    dxdt[0] = -1e4 * (x[0] - std::cos(t)) - std::sin(t);
    dxdt[1] = -x[1];
  };
  const auto solution = continuo::solve(relaxation, X{1, 1}, {0, 2}, continuo::Bdf{}, {.rtol = 1e-8, .atol = 1e-10});
  const X& x = solution.final_state();
  return solution.outcome && std::abs(x[0] - std::cos(2.0)) < 1e-5 && std::abs(x[1] - std::exp(-2.0)) < 1e-5 ? 0 : 1;
}
