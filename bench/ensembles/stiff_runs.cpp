// Robertson's reaction and Van der Pol's equation, 400 of each, by rodas5p together, by `solve` one by one and by
// rosenbrock4 of Boost.odeint. All have the Jacobian by hand.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include <bench/ensembles/hard_problems.hpp>
#include <bench/stiff/peers/ublas_storage.hpp>
#include <boost/numeric/odeint.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {

namespace {

constexpr std::size_t runs = 400;

/// The three rates are p.
struct Robertson {
  using X = std::array<double, 3>;
  using P = std::array<double, 3>;
  static constexpr double end = 1e5, atol = 1e-4;  // of rtol: the second component stays below 1e-4
  static constexpr bool autonomous = true;
  static constexpr const char* name = "Robertson's reaction to t = 1e5, rates within a factor 4";
  static RunStart<X, P> start(std::size_t run) {
    const auto part = [run](std::size_t period) {
      return std::exp2(2 * static_cast<double>(run % period) / static_cast<double>(period) - 1);
    };
    return {{1, 0, 0}, {0.04 * part(97), 3e7 * part(89), 1e4 * part(101)}};
  }
  void operator()(const auto&, const auto& x, auto& dxdt, const auto& p) const {
    dxdt[0] = p[2] * x[1] * x[2] - p[0] * x[0];
    dxdt[2] = p[1] * x[1] * x[1];
    dxdt[1] = -dxdt[0] - dxdt[2];
  }
  void jacobian(const auto&, const auto& x, auto rows, const auto& p) const {
    rows[0] = -p[0];
    rows[1] = p[2] * x[2];
    rows[2] = p[2] * x[1];
    rows[6] = 0.0;
    rows[7] = 2.0 * p[1] * x[1];
    rows[8] = 0.0;
    for (std::size_t j = 0; j < 3; ++j) rows[3 + j] = -rows[j] - rows[6 + j];
  }
};

/// mu is p.
struct VanDerPol {
  using X = std::array<double, 2>;
  using P = std::array<double, 1>;
  static constexpr double end = 100, atol = 1;
  static constexpr bool autonomous = true;
  static constexpr const char* name = "Van der Pol to t = 100, mu 1 to 1000";
  static RunStart<X, P> start(std::size_t run) {
    return {{2, 0}, {std::pow(10, 3 * static_cast<double>(run) / static_cast<double>(runs - 1))}};
  }
  void operator()(const auto&, const auto& x, auto& dxdt, const auto& p) const {
    dxdt[0] = x[1];
    dxdt[1] = p[0] * ((1.0 - x[0] * x[0]) * x[1]) - x[0];
  }
  void jacobian(const auto&, const auto& x, auto rows, const auto& p) const {
    rows[0] = 0.0;
    rows[1] = 1.0;
    rows[2] = -2.0 * p[0] * x[0] * x[1] - 1.0;
    rows[3] = p[0] * (1.0 - x[0] * x[0]);
  }
};

/// With the parameters of one run.
template <class Problem>
struct OneRun {
  using X = typename Problem::X;
  static constexpr bool autonomous = true;
  typename Problem::P p;
  void operator()(double t, const X& x, X& dxdt) const { Problem{}(t, x, dxdt, p); }
  void jacobian(double t, const X& x, std::span<double> rows) const { Problem{}.jacobian(t, x, rows, p); }
};

template <class Problem>
using States = std::vector<typename Problem::X>;

template <class Problem>
States<Problem> together(double tolerance) {
  States<Problem> ends(runs);
  const auto note = [&](const auto& one) { ends[one.run] = one.x; };
  static_cast<void>(ensemble(Problem{}, starts(runs, Problem::start), {0, Problem::end}, Rodas5P{},
                             {.rtol = tolerance, .atol = tolerance * Problem::atol, .threads = 1, .finished = note}));
  return ends;
}
template <class Problem>
States<Problem> one_by_one(double tolerance) {
  using X = typename Problem::X;
  States<Problem> ends;
  for (std::size_t run = 0; run < runs; ++run) {
    const auto start = Problem::start(run);
    ends.push_back(solve(OneRun<Problem>{start.p}, start.x, {0, Problem::end}, Rodas5P{},
                         {.rtol = tolerance, .atol = tolerance * Problem::atol, .save = Save<X>::only_end()})
                       .final_state());
  }
  return ends;
}
template <class Problem>
States<Problem> by_odeint(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  namespace ublas = boost::numeric::ublas;
  using Vector = ublas::vector<double>;
  using Matrix = ublas::matrix<double>;
  States<Problem> ends;
  for (std::size_t run = 0; run < runs; ++run) {
    const auto start = Problem::start(run);
    Vector x(start.x.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = start.x[i];
    const auto f = [&](const Vector& y, Vector& dydt, double t) { Problem{}(t, y, dydt, start.p); };
    const auto jacobian = [&](const Vector& y, Matrix& rows, const double& t, Vector& dfdt) {
      Problem{}.jacobian(t, y, std::span<double>(rows.data().begin(), rows.data().size()), start.p);
      for (std::size_t i = 0; i < y.size(); ++i) dfdt[i] = 0;
    };
    using Stepper = odeint::rosenbrock4_controller<odeint::rosenbrock4<double>>;
    odeint::integrate_adaptive(Stepper(tolerance * Problem::atol, tolerance), std::make_pair(f, jacobian), x, 0.0,
                               Problem::end, 1e-6);
    typename Problem::X last{};
    for (std::size_t i = 0; i < x.size(); ++i) last[i] = x[i];
    ends.push_back(last);
  }
  return ends;
}

template <class Problem>
void compare(double allowed) {
  const States<Problem> exact = together<Problem>(1e-10);
  std::printf("%zu runs: %s\n", runs, Problem::name);
  const Cost unit = cost_at(allowed, exact, by_odeint<Problem>);
  print_cost("odeint rosenbrock4", unit, runs, unit);
  print_cost("solve, rodas5p", cost_at(allowed, exact, one_by_one<Problem>), runs, unit);
  print_cost("ensemble, rodas5p", cost_at(allowed, exact, together<Problem>), runs, unit);
}

}  // namespace

void compare_stiff_runs() {
  compare<Robertson>(1e-7);
  compare<VanDerPol>(1e-3);
}

}  // namespace continuo::bench
