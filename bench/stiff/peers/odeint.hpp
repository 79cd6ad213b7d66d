// bench/stiff/peers/odeint.hpp
// The peer: rosenbrock4 of Boost.odeint with its own step control, as `controlled` and as `dense` stepper. Its state is
// a uBLAS vector and nothing else; checks of indices are off (NDEBUG), as in any release.
#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <bench/stiff/measure.hpp>
#include <bench/stiff/peers/ublas_storage.hpp>
#include <boost/numeric/odeint.hpp>

namespace continuo::bench {

using UblasVector = boost::numeric::ublas::vector<double>;
using UblasMatrix = boost::numeric::ublas::matrix<double>;

/// The numbers of a vector or matrix, row by row, as the problems take them.
template <class Ublas>
std::span<double> entries(const Ublas& v) {
  return {const_cast<double*>(v.data().begin()), v.data().size()};
}
template <class Problem>
void evaluate_at(const Problem& problem, double t, const UblasVector& x, UblasVector& dxdt) {
  std::span<double> slope = entries(dxdt);
  problem(t, entries(x), slope);
}

/// The problem as odeint calls it.
template <class Problem>
struct ForStiffOdeint {
  Problem problem{};
  void operator()(const UblasVector& x, UblasVector& dxdt, double t) const { evaluate_at(problem, t, x, dxdt); }
};
template <class Problem>
struct JacobianForOdeint {
  Problem problem{};
  void operator()(const UblasVector& x, UblasMatrix& rows, const double& t, UblasVector& dfdt) const {
    problem.jacobian(t, entries(x), entries(rows));
    for (std::size_t i = 0; i < x.size(); ++i) dfdt[i] = 0;  // none of the problems depends on t
  }
};
/// Counts, and gives up on a run that never ends.
template <class Problem>
struct CountedForStiffOdeint {
  Problem problem{};
  std::size_t* count;
  void operator()(const UblasVector& x, UblasVector& dxdt, double t) const {
    if (++*count > 3'000'000) throw std::runtime_error("too many evaluations");
    evaluate_at(problem, t, x, dxdt);
  }
};

/// `make(rtol, atol)` gives a stepper with step control. It has to be told a first step: a safe one, from which its
/// control grows by 5 a step.
template <class Problem, class Make>
Solver odeint_stiff_solver(std::string name, Make make) {
  constexpr double first_step = 1e-6;
  const auto run = [make](auto f, double tolerance) {
    const auto start = Problem::start();
    UblasVector x(start.size());
    for (std::size_t i = 0; i < start.size(); ++i) x[i] = start[i];
    boost::numeric::odeint::integrate_adaptive(make(tolerance, tolerance * absolute_part<Problem>),
                                               std::make_pair(std::move(f), JacobianForOdeint<Problem>{}), x, 0.0,
                                               Problem::duration, first_step);
    return x;
  };
  return {std::move(name), false,
          [run](double tolerance) {
            std::size_t count = 0;
            try {
              const UblasVector x = run(CountedForStiffOdeint<Problem>{{}, &count}, tolerance);
              return judged<Problem>(x, tolerance, count);
            } catch (const std::exception&) {
              return Answer{};
            }
          },
          [run](double tolerance) { return timed([&] { return run(ForStiffOdeint<Problem>{}, tolerance); }); }};
}

template <class Problem>
std::vector<Solver> all_odeint_stiff_solvers() {
  namespace odeint = boost::numeric::odeint;
  using Controller = odeint::rosenbrock4_controller<odeint::rosenbrock4<double>>;
  return {odeint_stiff_solver<Problem>("odeint rosenbrock4",
                                       [](double rtol, double atol) { return Controller(atol, rtol); }),
          odeint_stiff_solver<Problem>("odeint rosenbrock4 dense", [](double rtol, double atol) {
            return odeint::rosenbrock4_dense_output<Controller>(Controller(atol, rtol));
          })};
}

}  // namespace continuo::bench
