// Whether a problem is linear, and at which ends f has no value, from f and g at a few places.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <continuo/boundary/boundary_nature.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo::boundary {

namespace {

/// The same numbers each time, between -1 and 1.
class Scatter {
 public:
  double operator()() {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1;
  }
  std::vector<double> operator()(std::size_t size) {
    std::vector<double> numbers(size);
    for (double& number : numbers) number = (*this)();
    return numbers;
  }

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// Whether y(a + 2 d) - y(a) = 2 (y(a + d) - y(a)) at a place and in a direction, but for rounding.
bool is_straight(const std::function<void(Values x, std::span<double> y)>& function, std::size_t from, std::size_t to,
                 Scatter& scatter) {
  const std::vector<double> a = scatter(from), d = scatter(from);
  std::vector<double> x(a);
  std::array<std::vector<double>, 3> y;
  for (std::size_t k = 0; k < 3; ++k) {
    y[k].resize(to);
    for (std::size_t i = 0; i < from; ++i) x[i] = a[i] + static_cast<double>(k) * d[i];
    function(x, y[k]);
  }
  for (std::size_t i = 0; i < to; ++i) {
    const double size = std::max({std::abs(y[0][i]), std::abs(y[1][i]), std::abs(y[2][i])});
    if (!(std::abs(y[2][i] - 2 * y[1][i] + y[0][i]) <= 1e-10 * size)) return false;
  }
  return true;
}

}  // namespace

bool is_linear(const BoundaryValueProblem& problem) {
  if (problem.system.parameters() > 0) return false;
  const std::size_t n = problem.system.size;
  const double from = problem.times.front(), length = problem.times.back() - from;
  Scatter scatter;
  for (int sample = 0; sample < 5; ++sample) {
    const double t = from + length * (scatter() + 1) / 2;
    const auto f = [&](Values x, std::span<double> y) { problem.system.derivative(t, x, {}, y); };
    const auto g = [&](Values x, std::span<double> y) { problem.conditions(x, {}, y); };
    if (!is_straight(f, n, n, scatter) || !is_straight(g, n * problem.times.size(), n, scatter)) return false;
  }
  return true;
}

OpenEnds open_ends(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess) {
  const std::size_t n = problem.system.size;
  std::vector<double> x(n), f(n);
  const auto has_value = [&](double t) {
    problem.system.derivative(t, x, problem.system.constants, f);
    return all_finite(f);
  };
  const double from = problem.times.front(), to = problem.times.back();
  const auto is_open = [&](double t, double beside) {
    Scatter scatter;
    for (int sample = 0; sample < 4; ++sample) {
      std::ranges::fill(x, 0.0);
      if (guess) guess(t, x);
      if (sample > 0)
        for (double& value : x) value += scatter() * (value == 0 ? 1 : std::abs(value));
      if (has_value(t)) return false;
      if (sample == 0 && !has_value(beside)) return false;
    }
    return true;
  };
  constexpr double little = 1e-3;
  return {is_open(from, from + little * (to - from)), is_open(to, to - little * (to - from))};
}

}  // namespace continuo::boundary
