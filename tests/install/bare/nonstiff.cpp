// An explicit method with dense output: x'' = -x.
#include <array>
#include <cmath>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/solve/solve.hpp>

int main() {
  using X = std::array<double, 2>;
  const auto oscillator = [](double, const X& x) { return X{x[1], -x[0]}; };
  const auto solution = continuo::solve(oscillator, X{1, 0}, {0, 10}, continuo::Dop853{},
                                        {.rtol = 1e-10, .atol = 1e-12, .save = continuo::save_dense()});
  return solution.outcome && std::abs(solution(5.0)[0] - std::cos(5.0)) < 1e-8 ? 0 : 1;
}
