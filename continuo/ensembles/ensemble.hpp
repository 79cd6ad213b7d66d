// Many runs of one system, from many starts and with many parameters, several at once in the lanes of SIMD registers
// and on all cores:
//
//   auto lorenz = [](auto, const auto& x, auto& dxdt, const auto& p) {
//     dxdt[0] = 10.0 * (x[1] - x[0]);
//     dxdt[1] = x[0] * (p[0] - x[2]) - x[1];
//     dxdt[2] = x[0] * x[1] - 8.0 / 3.0 * x[2];
//   };
//   auto result = ensemble(lorenz, starts(10'000, [](std::size_t run) {
//                            return RunStart{std::array{1.0, 0.0, 0.0}, std::array{28e-4 * double(run)}};
//                          }), {0, 10}, Dop853{}, {.rtol = 1e-8});
//   result.runs[17].x;  // the last state of run 17
//
// docs/ensembles.md tells what the same bits are promised for.
#pragma once
#include <concepts>
#include <cstddef>
#include <functional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include <continuo/ensembles/ensemble_options.hpp>
#include <continuo/ensembles/lanes/lane_groups.hpp>
#include <continuo/ensembles/run_result.hpp>
#include <continuo/ensembles/run_start.hpp>
#include <continuo/ensembles/worker_threads.hpp>

namespace continuo {

/// The lanes of an ensemble where no number of lanes is named: one register of AVX-512, two of AVX2, four of SSE2.
inline constexpr std::size_t default_lanes = 8;

namespace detail {

template <class M, class X>
concept ExplicitRungeKuttaMethod = requires {
  { M::tableau.first_same_as_last() } -> std::convertible_to<bool>;
} && !is_implicit<M>();

template <class M, class X>
concept MethodForLanes = ExplicitRungeKuttaMethod<M, X> || RosenbrockForLanes<M>;

/// Why no run can begin: what is wrong for the first one, and is not its state. Empty where they can.
template <class M, State X, State P, class F, class... E>
[[nodiscard]] std::string problem_of_all(F& f, const RunStart<X, P>& first, const RunSettings<X, P, E...>& settings) {
  const SystemWithParameters<F, P> system{&f, first.p};
  X x = first.x;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!is_finite(x.data()[i])) x.data()[i] = 0;  // which is that run's own failure
  std::string why = wrong_input(needs_of<M>(system, x), system, x, settings.interval, settings.options);
  if (why.empty()) why = RunEvents<X, E...>(settings.events).problem(settings.interval);
  return why;
}

}  // namespace detail

/// Integrates dx/dt = f(t, x, p) over the interval for every start, W runs or more at once on each thread. f is called
/// with lanes of numbers and with plain ones: it is a template over both (`auto`), has no `if` on its numbers (see
/// `select`), and is written as f(t, x, dxdt, p), or to return dx/dt as f(t, x, p); without p for starts that have no
/// parameters. Each thread has a copy of f. The method is an explicit Runge-Kutta method, or for stiff systems a
/// Rosenbrock method, which takes f.jacobian(t, x, rows, p) where f has it, else differences. Events are those of
/// `falls`, `rises`, `crosses`, `at` and `every`: a guard may take (t, x, p), an action (now, p), and changes p for its
/// run alone. A run that fails is a result with its outcome, as of `solve`.
template <std::size_t W = default_lanes, class F, RunStarts Starts, class M, class... Events>
[[nodiscard]] Ensemble<detail::StateOf<Starts>, detail::ParametersOf<Starts>> ensemble(
    const F& f, const Starts& starts, Interval<double> interval, M,
    std::type_identity_t<EnsembleOptions<detail::StateOf<Starts>, detail::ParametersOf<Starts>>> options = {},
    const Events&... events) {
  using X = detail::StateOf<Starts>;
  using P = detail::ParametersOf<Starts>;
  static_assert(detail::MethodForLanes<M, X>,
                "an ensemble takes an explicit Runge-Kutta method, such as Dop853{} or Rk4{}, or for stiff systems a "
                "Rosenbrock method, such as Rodas5P{}");
  static_assert(!detail::RosenbrockForLanes<M> || !(detail::has_guard<Events> || ...),
                "an ensemble by a Rosenbrock method has no guards, only events at given times: its steps would have to "
                "end at the crossings");
  static_assert(!HasMassDiagonal<F, X> && !HasMassMatrix<F, X>,
                "an ensemble would ignore the mass matrix of the system: divide by the masses in f");
  Ensemble<X, P> result;
  (result.event_names.push_back(events.name), ...);
  if (starts.size() == 0) return result;
  const std::tuple<Events...> list(events...);
  detail::RunSettings<X, P, Events...> settings{interval, options.of_one_run(), options.keep_events, list,
                                                options.watcher};
  F copy = f;
  settings.problem = detail::problem_of_all<M>(copy, detail::as_run_start(starts[0]), settings);
  detail::RunQueue<X, P> queue(starts.size(), options, result.runs);
  detail::on_threads(options.threads, (starts.size() + W - 1) / W, [&] {
    try {
      detail::LaneGroups<F, Starts, M, W, Events...>(f, starts, settings, queue).run();
    } catch (...) {
      queue.stop();
      throw;
    }
  });
  result.complete = queue.complete();
  for (std::size_t run = queue.begun(); run < result.runs.size(); ++run) {
    result.runs[run].run = run;
    result.runs[run].outcome.ending = Ending::interrupted;
    result.runs[run].outcome.t = interval.from;
  }
  return result;
}

}  // namespace continuo
