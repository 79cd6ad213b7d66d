// A ball that bounces and loses nothing: its second impact is after three times the time of its fall.
#include <array>
#include <cmath>

#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/solve/solve.hpp>

int main() {
  using X = std::array<double, 2>;
  const auto falling = [](double, const X& x) { return X{x[1], -10}; };
  const auto floor =
      continuo::falls("floor", [](double, const X& x) { return x[0]; }, [](auto& now) { now.x[1] = -now.before[1]; });
  const auto solution = continuo::solve(falling, X{5, 0}, {0, 4}, continuo::Tsitouras5{}, {.events = {floor}});
  return solution.outcome && solution.events.size() == 2 && std::abs(solution.events[1].t - 3) < 1e-9 ? 0 : 1;
}
