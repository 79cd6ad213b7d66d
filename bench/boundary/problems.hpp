// The problems of bench/boundary. The same stand in against_scipy.py.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>

namespace continuo::bench {

struct BoundaryCase {
  std::string name;
  boundary::BoundaryValueProblem problem;
  boundary::BoundaryValueGuess guess;
};

inline std::vector<BoundaryCase> boundary_cases() {
  using X = std::vector<double>;
  const auto ends = [](double a, double b) {
    return [a, b](Values x, Values, std::span<double> g) {
      g[0] = x[0] - a;
      g[1] = x[2] - b;
    };
  };
  std::vector<BoundaryCase> cases;
  cases.push_back(
      {"bratu, upper",
       {parametric_system(2, [](double, const X& x, X& d) { d = {x[1], -std::exp(x[0])}; }), {0, 1}, ends(0, 0)},
       [](double t, std::span<double> x) { x[0] = 12 * t * (1 - t), x[1] = 12 * (1 - 2 * t); }});
  cases.push_back({"troesch, mu = 5",
                   {parametric_system(2, [](double, const X& x, X& d) { d = {x[1], 5 * std::sinh(5 * x[0])}; }),
                    {0, 1},
                    ends(0, 1)},
                   [](double t, std::span<double> x) { x[0] = t, x[1] = 1; }});
  cases.push_back(
      {"blasius",
       {parametric_system(3, [](double, const X& x, X& d) { d = {x[1], x[2], -x[0] * x[2] / 2}; }),
        {0, 12},
        [](Values x, Values, std::span<double> g) { g[0] = x[0], g[1] = x[1], g[2] = x[4] - 1; }},
       [](double t, std::span<double> x) { x[0] = t * t / (t + 2), x[1] = t / (t + 1), x[2] = std::exp(-t); }});
  cases.push_back(
      {"layer, eps = 1e-4",
       {parametric_system(2, [](double, const X& x, X& d) { d = {x[1], -x[1] / 1e-4}; }), {0, 1}, ends(0, 1)},
       [](double, std::span<double> x) { x[0] = x[1] = 0; }});
  return cases;
}

}  // namespace continuo::bench
