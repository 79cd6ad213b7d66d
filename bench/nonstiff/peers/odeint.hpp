// bench/nonstiff/peers/odeint.hpp
// The peer: Boost.odeint's adaptive explicit solvers with their own step control and their own defaults. Its states are
// std::array too, which it adds up with loops of fixed length.
#pragma once
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <bench/nonstiff/measure.hpp>
#include <boost/numeric/odeint.hpp>

namespace continuo::bench {

/// The problem as odeint calls it.
template <class Problem>
struct ForOdeint {
  using State = std::array<double, Problem::size>;
  void operator()(const State& x, State& dxdt, double t) const { Problem{}(t, x, dxdt); }
};
template <class Problem>
struct CountedForOdeint {
  using State = std::array<double, Problem::size>;
  std::size_t* count;
  void operator()(const State& x, State& dxdt, double t) const {
    ++*count;
    Problem{}(t, x, dxdt);
  }
};

/// `make(tolerance)` gives a controlled stepper. The first step is found beforehand, at no cost to the peer.
template <class Problem, class Make>
Solver odeint_solver(std::string name, double first_step, Make make) {
  using State = std::array<double, Problem::size>;
  const auto run = [make, first_step](auto system, double tolerance) {
    State x = Problem::start();
    boost::numeric::odeint::integrate_adaptive(make(tolerance), std::move(system), x, 0.0, Problem::duration,
                                               first_step);
    return x;
  };
  return {std::move(name), false,
          [run](double tolerance) {
            std::size_t count = 0;
            const State x = run(CountedForOdeint<Problem>{&count}, tolerance);
            return Answer{end_error<Problem>(x), count};
          },
          [run](double tolerance) { return timed([&] { return run(ForOdeint<Problem>{}, tolerance); }); }};
}

template <class Problem>
std::vector<Solver> odeint_solvers(double first_step) {
  namespace odeint = boost::numeric::odeint;
  using State = std::array<double, Problem::size>;
  const auto controlled = []<class Stepper>(std::type_identity<Stepper>) {
    return [](double tolerance) { return odeint::make_controlled<Stepper>(tolerance, tolerance); };
  };
  return {odeint_solver<Problem>("odeint fehlberg78", first_step,
                                 controlled(std::type_identity<odeint::runge_kutta_fehlberg78<State>>{})),
          odeint_solver<Problem>("odeint dopri5", first_step,
                                 controlled(std::type_identity<odeint::runge_kutta_dopri5<State>>{})),
          odeint_solver<Problem>("odeint cash_karp54", first_step,
                                 controlled(std::type_identity<odeint::runge_kutta_cash_karp54<State>>{})),
          odeint_solver<Problem>("odeint bulirsch_stoer", first_step,
                                 [](double tolerance) { return odeint::bulirsch_stoer<State>(tolerance, tolerance); })};
}

}  // namespace continuo::bench
