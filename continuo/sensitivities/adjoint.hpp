// The gradient of a number that depends on the motion, by all parameters and initial values at once, at the cost of two
// more runs however many they are: the discrete adjoint of the steps that a run has taken, through its events.
//
//   const auto f = [](auto, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = -p[0] * x[0]; };
//   auto run = solve_for_adjoint(f, std::array{1.0}, std::array{2.0}, {0, 1}, Dop853{}, {.rtol = 1e-10});
//   const auto gradient = run.gradient(AtEnd{[](auto, const auto& x, const auto&) { return x[0]; }});
//   gradient.by_parameters[0];  // -exp(-2)
//
// It is the derivative of the numerical solution itself, for the given steps: the times at which steps end do not move,
// but for the times of events, which do.
#pragma once
#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/sensitivities/adjoint/adjoint_sweep.hpp>
#include <continuo/sensitivities/adjoint/runge_kutta_table.hpp>
#include <continuo/sensitivities/adjoint/steps_recorder.hpp>
#include <continuo/sensitivities/forward_sensitivities.hpp>
#include <continuo/sensitivities/objective.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {

namespace detail {

/// x' = f(t, x, p) at fixed p as a System.
template <class F, State X, State P>
class AtParameters : public AutonomyOf<F> {
 public:
  using Real = Scalar<X>;

  AtParameters(ParameterDerivatives<F, X, P> derivatives, P p)
      : derivatives_(std::move(derivatives)), p_(std::move(p)) {
    if constexpr (KnowsAutonomous<F>) this->autonomous = is_autonomous(derivatives_.function());
  }
  void operator()(const Real& t, const X& x, X& dxdt) { derivatives_.derivative(t, x, p_, dxdt); }
  [[nodiscard]] std::string component_name(std::size_t i) const {
    return continuo::component_name(derivatives_.function(), i);
  }
  [[nodiscard]] const ParameterDerivatives<F, X, P>& derivatives() const { return derivatives_; }

 protected:
  ParameterDerivatives<F, X, P> derivatives_;
  P p_;
};
/// The same with df/dx, where it is known without differences.
template <class F, State X, State P>
class AtParametersWithJacobian : public AtParameters<F, X, P> {
 public:
  using AtParameters<F, X, P>::AtParameters;
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    this->derivatives_.go_to(t, x, this->p_);
    this->derivatives_.rows_by_x(rows);
  }
};
template <class F, State X, State P>
using SystemAtParameters = std::conditional_t<ParameterDerivatives<F, X, P>::knows_jacobian,
                                              AtParametersWithJacobian<F, X, P>, AtParameters<F, X, P>>;

/// Refuses, at compile time, a method whose steps have no adjoint here.
template <class M>
[[nodiscard]] consteval bool check_adjoint_method() {
  constexpr bool has_table = HasRungeKuttaTable<M>;
  static_assert(
      has_table,
      "the adjoint goes back over the steps of Runge-Kutta methods: explicit ones with a tableau, such as "
      "Dop853 and Tsitouras5, and diagonally implicit ones, such as Kvaerno5 and TrBdf2; for any other method "
      "use forward_sensitivities");
  return has_table;
}

}  // namespace detail

/// The value of an objective, and its derivatives.
template <State X, State P>
struct Gradient {
  Scalar<X> value{};
  X by_initial_values;  // dG/dx0
  P by_parameters;      // dG/dp, at fixed x0
  DerivativeCosts costs{};
  Scalar<X> error_of_integral{};  // an estimate; not a number where the tableau has no embedded weights
  Status status{};                // a failure where there is no gradient
};

/// A run whose steps are kept: a state for each. It is made by solve_for_adjoint.
template <class F, State X, State P, class M>
class AdjointRun {
 public:
  using Real = Scalar<X>;

  /// The states at the times that the run saves, and the last one.
  Solution<X> solution;
  /// The cost of the run.
  DerivativeCosts costs;
  /// A failure of the run.
  Status status;

  /// Runs; see solve_for_adjoint.
  AdjointRun(F f, X x0, P p, Interval<Real> interval, Options<X> options,
             std::vector<detail::ParametricEvent<X, P>> events)
      : x0_(std::move(x0)),
        p_(std::move(p)),
        interval_(interval),
        events_(std::move(events)),
        derivatives_(std::move(f), x0_, p_, detail::sizes_for_differences(x0_, options),
                     detail::sizes_of_parameters(p_, std::vector<Real>{})) {
    std::string why = detail::problem_of_sensitivities(x0_, p_, options, std::vector<Real>{});
    using Kind = typename Save<X>::Kind;
    if (why.empty() && (options.save.kind == Kind::grid || options.save.kind == Kind::dense))
      why = "an adjoint run keeps its steps: what it can save besides is states at given times, save_at({...})";
    status = invalid_input(why);
    if (status) integrate(std::move(options));
  }

  /// The number of steps that are kept.
  [[nodiscard]] std::size_t steps() const { return taken_.steps.size(); }

  /// The value of an objective and its gradient. Costs, for each step and stage, one evaluation of f and one product
  /// lambda^T df/d(x, p), which together are at most a few evaluations of f; an implicit stage costs the evaluations
  /// and Jacobians of Newton's iteration instead. The integral is the sum of the method's weights over its stages. The
  /// steps are those that x needs: where `error_of_integral` is too large, make the integral a component of x. Where
  /// the run ends at an event, its end moves with the parameters.
  template <class... Terms>
  [[nodiscard]] Gradient<X, P> gradient(const Terms&... terms) const {
    Gradient<X, P> result{.by_initial_values = x0_, .by_parameters = p_};
    if constexpr (detail::check_terms<Terms...>()) {
      const detail::Objective objective{detail::term_of<AtEnd>(terms...), detail::term_of<AtTimes>(terms...),
                                        detail::term_of<Integral>(terms...)};
      go_back(objective, result);
    }
    return result;
  }

 private:
  void integrate(Options<X> options);
  [[nodiscard]] Status problem_of_gradient(bool at_times) const;
  template <class End, class Times, class Integrand>
  void go_back(const detail::Objective<End, Times, Integrand>& objective, Gradient<X, P>& result) const;

  X x0_;
  P p_;
  Interval<Real> interval_;
  std::vector<detail::ParametricEvent<X, P>> events_;
  ParameterDerivatives<F, X, P> derivatives_;
  detail::StepsOfRun<X> taken_;
  bool has_times_ = false;
};

/// Integrates x' = f(t, x, p) from x(from) = x0 by the Runge-Kutta method M and keeps its steps, for `gradient`. f is
/// called as f(t, x, p) or f(t, x, p, dxdt); for its derivatives see parametric_function.hpp. A method that has no
/// adjoint is refused by the compiler. Of saving, times are supported: steps end there. The events are those of falls,
/// rises, crosses, at and every (parametric_event.hpp). A failure does not throw: see `status`.
template <class F, State X, State P, class M, class... Events>
[[nodiscard]] auto solve_for_adjoint(F f, X x0, P p, Interval<std::type_identity_t<Scalar<X>>> interval, M,
                                     std::type_identity_t<Options<X>> options = {}, Events... events) {
  if constexpr (detail::check_adjoint_method<M>() && check_parametric_function<F, X, P>() &&
                (detail::check_parametric_event<Events, X, P>() && ...)) {
    return AdjointRun<F, X, P, M>(std::move(f), std::move(x0), std::move(p), interval, std::move(options),
                                  detail::parametric_events<X, P>(events...));
  }
}

template <class F, State X, State P, class M>
void AdjointRun<F, X, P, M>::integrate(Options<X> options) {
  using System = detail::SystemAtParameters<F, X, P>;
  std::vector<Real> times;
  if (options.save.kind == Save<X>::Kind::times) times = std::move(options.save.times);
  has_times_ = !times.empty();
  options.save = Save<X>::only_end();
  for (const auto& event : events_) options.events.push_back(event.event(p_));
  const Real forward = interval_.to < interval_.from ? Real(-1) : Real(1);
  status = invalid_input(detail::problem_of_save(interval_, Save<X>::at(times)));
  if (!status) return;
  times.push_back(interval_.to);
  Integrator<System, X, M> integrator(System(derivatives_, p_), x0_, interval_, M{}, std::move(options));
  detail::StepsRecorder<X, P> recorder(events_, p_, x0_, interval_.from, taken_);
  for (std::size_t j = 0; j < times.size(); ++j) {
    const Real end = forward * (times[j] - interval_.to) > 0 ? interval_.to : times[j];
    integrator.extend_to(end);
    for (bool running = true; running;) {
      running = integrator.advance(recorder);
      recorder.end_step(integrator.x());
    }
    if (integrator.outcome().ending != Ending::reached_end) break;
    if (j + 1 == times.size()) break;
    recorder.output(j, integrator.t(), integrator.x());
    solution.t.push_back(integrator.t());
    solution.x.push_back(integrator.x());
  }
  solution.last = integrator.x();
  solution.outcome = integrator.outcome();
  solution.statistics = integrator.statistics();
  costs = integrator.system().derivatives().costs();
  status = detail::status_of_run(solution.outcome);
}

template <class F, State X, State P, class M>
template <class End, class Times, class Integrand>
void AdjointRun<F, X, P, M>::go_back(const detail::Objective<End, Times, Integrand>& objective,
                                     Gradient<X, P>& result) const {
  constexpr bool of_state = detail::TraceableTerm<End, X, P> && detail::TraceableTerm<Integrand, X, P>,
                 of_times = detail::TraceableTermOfTimes<Times, X, P>;
  static_assert(of_state,
                "AtEnd and Integral have functions that take any number type and return a number: [](auto t, const "
                "auto& x, const auto& p) { return ...; }");
  static_assert(of_times,
                "AtTimes has a function that takes the number of the time, and any number type: [](std::size_t j, auto "
                "t, const auto& x, const auto& p) { return ...; }");
  if constexpr (of_state && of_times) {
    result.status = problem_of_gradient(!std::same_as<Times, detail::NoTerm>);
    if (!result.status) return;
    const auto table = detail::runge_kutta_table<M, Real>();
    detail::AdjointSweep<F, X, P, detail::Objective<End, Times, Integrand>> sweep(
        taken_, events_, table, derivatives_, p_, objective, solution.final_state());
    result.status = sweep.go_back(solution.outcome.t);
    result.value = sweep.value();
    if constexpr (!std::same_as<Integrand, detail::NoTerm>) result.error_of_integral = sweep.error_of_integral();
    result.by_initial_values = sweep.by_state();
    std::copy(sweep.by_parameters().begin(), sweep.by_parameters().end(), result.by_parameters.data());
    result.costs = sweep.costs();
  }
}

template <class F, State X, State P, class M>
Status AdjointRun<F, X, P, M>::problem_of_gradient(bool at_times) const {
  if (!status) return status;
  if (at_times && !has_times_)
    return invalid_input("the objective has a term at times, and the run saves none: give its options save_at({...})");
  if (taken_.is_ambiguous)
    return {.ending = Ending::cannot_continue,
            .message =
                "several guards are crossed at one instant, and an action there sets off a further event: how "
                "its time moves is not known"};
  return {};
}

}  // namespace continuo
