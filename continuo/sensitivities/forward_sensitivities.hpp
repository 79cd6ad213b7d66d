// How the motion of a C++ system depends on its parameters and initial values: S = dx/dp and dx/dx0 along the run, by
// any method, through events, whose times move too.
//
//   const auto decay = [](auto, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = -p[0] * x[0]; };
//   const auto run = forward_sensitivities(decay, std::array{1.0}, std::array{2.0}, {0, 1}, Dop853{});
//   run.sensitivity(run.rows() - 1, 0, 0);  // -exp(-2)
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/sensitivities/forward/variational_events.hpp>
#include <continuo/sensitivities/forward/variational_system.hpp>
#include <continuo/sensitivities/parametric_event.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {

/// The options of a run with forward sensitivities.
template <State X>
struct SensitivityOptions {
  using Real = Scalar<X>;
  /// Those of the run. The tolerances hold for x and for S: atol of dx_i/dp_k is that of x_i over the size of p_k. Its
  /// events are not used: they follow the options as arguments. Of saving, the callback is not supported.
  Options<X> run{};
  /// dx/dx0 too, as further columns after those of the parameters.
  bool by_initial_values = false;
  /// dx0/dp, n * m numbers row by row, where the initial values depend on the parameters; empty: they do not.
  std::vector<Real> initial_by_parameters{};
  /// How large each parameter is, for tolerances and differences; empty: as it is, or 1 where it is 0.
  std::vector<Real> parameter_sizes{};
};

/// A run with the sensitivities of all components.
template <State X>
struct ForwardSensitivities {
  using Real = Scalar<X>;
  std::size_t components = 0, parameters = 0, columns = 0;
  /// The run of x and S: its states are x, then the columns of S.
  Solution<std::vector<Real>> run{};
  /// The events of the run, and how their times depend on the influences.
  std::vector<EventTime<Real>> events{};
  /// The cost of f and its derivatives.
  DerivativeCosts costs{};
  /// A failure where the run failed, and where the motion has no derivative; the rows up to there are kept.
  Status status{};

  /// The number of saved rows.
  [[nodiscard]] std::size_t rows() const { return run.x.size(); }
  /// The time of row r.
  [[nodiscard]] Real time(std::size_t r) const { return run.t[r]; }
  /// x_i at row r.
  [[nodiscard]] Real value(std::size_t r, std::size_t i) const { return run.x[r][i]; }
  /// dx_i at row r by influence k: the parameters in order, then the initial values where they were asked for.
  [[nodiscard]] Real sensitivity(std::size_t r, std::size_t i, std::size_t k) const {
    return run.x[r][components * (1 + k) + i];
  }
  /// The same at the end of the run, whatever is saved.
  /// @{
  [[nodiscard]] Real final_value(std::size_t i) const { return run.final_state()[i]; }
  [[nodiscard]] Real final_sensitivity(std::size_t i, std::size_t k) const {
    return run.final_state()[components * (1 + k) + i];
  }
  /// @}
};

namespace detail {

/// The outcome of a run in any number type as a Status.
template <class Real>
[[nodiscard]] Status status_of_run(const Outcome<Real>& outcome) {
  return status(Outcome<double>{.ending = outcome.ending,
                                .t = static_cast<double>(outcome.t),
                                .h = static_cast<double>(outcome.h),
                                .error = static_cast<double>(outcome.error),
                                .component = outcome.component,
                                .event = outcome.event,
                                .limit_time = static_cast<double>(outcome.limit_time),
                                .hint = outcome.hint});
}

/// Of each component, for differences: what is small is told by the tolerances.
template <State X>
[[nodiscard]] std::vector<Scalar<X>> sizes_for_differences(const X& x, const Options<X>& options) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  std::vector<Real> sizes(dimension(x));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Real rtol = i < options.rtol_each.size() ? options.rtol_each[i] : options.rtol;
    const Real atol = i < options.atol_each.size() ? options.atol_each[i] : options.atol;
    const Real small = atol / rtol;
    sizes[i] = max(Real(abs(x.data()[i])), small > 0 && is_finite(small) ? small : Real(0));
    if (!(sizes[i] > 0)) sizes[i] = Real(1);
  }
  return sizes;
}
template <State P>
[[nodiscard]] std::vector<Scalar<P>> sizes_of_parameters(const P& p, const std::vector<Scalar<P>>& given) {
  using Real = Scalar<P>;
  using std::abs;
  if (!given.empty()) return given;
  std::vector<Real> sizes(dimension(p));
  for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = p.data()[k] == Real(0) ? Real(1) : Real(abs(p.data()[k]));
  return sizes;
}

/// Why these options are not those of a run with sensitivities; empty where they are.
template <State X, State P>
[[nodiscard]] std::string problem_of_sensitivities(const X& x0, const P& p, const Options<X>& run,
                                                   const std::vector<Scalar<X>>& parameter_sizes) {
  if (!run.events.empty())
    return "the events of a run with sensitivities follow its options as arguments: those in the options have no "
           "derivatives";
  if (run.save.callback) return "a run with sensitivities does not support a callback for saved states";
  if (run.projection || !run.signs.empty())
    return "a run with sensitivities supports neither a projection nor signs: they move the state by a way whose "
           "derivative is not known";
  for (std::size_t k = 0; k < dimension(p); ++k)
    if (!is_finite(p.data()[k])) return "parameter " + std::to_string(k) + " is not finite";
  if (!parameter_sizes.empty() && parameter_sizes.size() != dimension(p))
    return "parameter_sizes has " + std::to_string(parameter_sizes.size()) + " numbers for " +
           std::to_string(dimension(p)) + " parameters";
  for (const auto& size : parameter_sizes)
    if (!is_positive(size)) return "the size of a parameter must be greater than 0 and finite";
  if (std::string why = problem_of_tolerances(x0, run); !why.empty()) return why;
  return {};
}
template <State X, State P>
[[nodiscard]] std::string problem_of_sensitivities(const X& x0, const P& p, const SensitivityOptions<X>& options) {
  if (std::string why = problem_of_sensitivities(x0, p, options.run, options.parameter_sizes); !why.empty()) return why;
  const std::size_t wanted = dimension(x0) * dimension(p), given = options.initial_by_parameters.size();
  if (given != 0 && given != wanted)
    return "initial_by_parameters has " + std::to_string(given) +
           " numbers: it needs n * m = " + std::to_string(wanted);
  return {};
}

/// The options of the run of x and S.
template <State X>
[[nodiscard]] Options<std::vector<Scalar<X>>> variational_options(const X& x0, const SensitivityOptions<X>& options,
                                                                  std::span<const Scalar<X>> influence_sizes) {
  using Real = Scalar<X>;
  using Z = std::vector<Real>;
  const Options<X>& run = options.run;
  Options<Z> result{.first_step = run.first_step, .max_step = run.max_step};
  result.step = run.step;
  result.rtol = run.rtol;
  result.controller = run.controller;
  result.max_steps = run.max_steps;
  result.max_rejects_in_a_row = run.max_rejects_in_a_row;
  result.interrupt = run.interrupt;
  result.progress = run.progress;
  result.save.kind = static_cast<typename Save<Z>::Kind>(run.save.kind);
  result.save.times = run.save.times;
  result.save.spacing = run.save.spacing;
  const std::size_t n = dimension(x0);
  for (std::size_t b = 0; b <= influence_sizes.size(); ++b) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real atol = run.atol_each.empty() ? run.atol : run.atol_each[i];
      result.atol_each.push_back(b == 0 ? atol : atol / influence_sizes[b - 1]);
      if (!run.rtol_each.empty()) result.rtol_each.push_back(run.rtol_each[i]);
    }
  }
  return result;
}

/// x0, then S at the start.
template <State X>
[[nodiscard]] std::vector<Scalar<X>> variational_start(const X& x0, std::size_t parameters,
                                                       const SensitivityOptions<X>& options) {
  using Real = Scalar<X>;
  const std::size_t n = dimension(x0), columns = parameters + (options.by_initial_values ? n : 0);
  std::vector<Real> z(n * (1 + columns));
  for (std::size_t i = 0; i < n; ++i) {
    z[i] = x0.data()[i];
    for (std::size_t k = 0; k < parameters && !options.initial_by_parameters.empty(); ++k)
      z[n * (1 + k) + i] = options.initial_by_parameters[i * parameters + k];
    if (options.by_initial_values) z[n * (1 + parameters + i) + i] = Real(1);
  }
  return z;
}

}  // namespace detail

/// Integrates x' = f(t, x, p) from x(from) = x0 with its sensitivities by the parameters p, and by x0 where the options
/// say so. f is called as f(t, x, p) or f(t, x, p, dxdt); for its derivatives see parametric_function.hpp. The events
/// are those of falls, rises, crosses, at and every (parametric_event.hpp); where one moves with the influences, S
/// jumps:
///   S+ = dr/dx (S- + f- dt) + dr/dt dt + dr/dp - f+ dt,   dt = -(dg/dx S- + dg/dp) / (dg/dx f- + dg/dt),
/// with the action r and the guard g. An event at the start of the run does not move. A failure does not throw: see
/// `status`. Each evaluation costs one traced evaluation of f, and n (1 + columns) n products; df/dx is a full matrix.
template <class F, State X, State P, class M, class... Events>
[[nodiscard]] ForwardSensitivities<X> forward_sensitivities(F f, X x0, P p,
                                                            Interval<std::type_identity_t<Scalar<X>>> interval,
                                                            M method,
                                                            std::type_identity_t<SensitivityOptions<X>> options = {},
                                                            Events... events) {
  using Real = Scalar<X>;
  using Z = std::vector<Real>;
  const std::size_t n = dimension(x0), m = dimension(p), columns = m + (options.by_initial_values ? n : 0);
  ForwardSensitivities<X> result{.components = n, .parameters = m, .columns = columns};
  if constexpr (check_parametric_function<F, X, P>() && (detail::check_parametric_event<Events, X, P>() && ...)) {
    result.status = invalid_input(detail::problem_of_sensitivities(x0, p, options));
    if (!result.status) return result;
    std::vector<Real> influence_sizes = detail::sizes_of_parameters(p, options.parameter_sizes);
    using System = VariationalSystem<F, X, P>;
    System system(std::move(f), x0, p, columns, detail::sizes_for_differences(x0, options.run), influence_sizes);
    for (std::size_t i = m; i < columns; ++i) {
      using std::abs;
      influence_sizes.push_back(x0.data()[i - m] == Real(0) ? Real(1) : Real(abs(x0.data()[i - m])));
    }
    using std::abs;
    VariationalEvents<F, X, P> source(detail::parametric_events<X, P>(events...), x0, p, interval.from,
                                      abs(interval.to - interval.from));
    Integrator<System, Z, M, VariationalEvents<F, X, P>> integrator(
        std::move(system), detail::variational_start(x0, m, options), interval, method,
        detail::variational_options(x0, options, std::span<const Real>(influence_sizes)), std::move(source));
    result.run = continuo::run(integrator);
    result.events = integrator.events().times();
    result.costs = integrator.system().costs();
    result.status = integrator.events().status();
    if (result.status) result.status = detail::status_of_run(result.run.outcome);
  }
  return result;
}

}  // namespace continuo
