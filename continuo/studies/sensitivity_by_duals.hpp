// Sensitivities of a right-hand side that takes any number type, exact by dual numbers, through events too:
//
//   const auto decay = [](auto, const auto& x, const auto& p, auto& dxdt) { dxdt[0] = -p[0] * x[0]; };
//   const auto run = sensitivities(decay, std::array{1.0}, std::array{0.5}, {0, 2}, {.rtol = 1e-10});
//   run.x(run.rows() - 1)[0];           // exp(-1)
//   run.by(run.rows() - 1, 0)[0];       // d x[0] / d p[0] = -2 exp(-1)
//
// A state carries its derivatives by p as it goes through f, so f gives x' and S' = df/dx S + df/dp at once. At an
// event the duals go through guard and action; the derivation stands in sensitive_program.hpp. The error control covers
// x and S. Functions must be found by their argument: sin, not std::sin. Needs <ceres/jet.h>, so nothing includes this
// file but who wants it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <ceres/jet.h>

#include <continuo/solve/automatic.hpp>

namespace continuo::studies {

template <std::size_t N, std::size_t M>
struct SensitivityDuals {
  static constexpr std::size_t states = N, parameters = M;
  using Number = ceres::Jet<double, static_cast<int>(M)>;
  using State = std::array<Number, N>;
  using Parameters = std::array<Number, M>;
  using Wide = std::array<double, N * (1 + M)>;  // x, then dx/dp[0], dx/dp[1], ...

  static State read(const Wide& wide) {
    State x;
    for (std::size_t i = 0; i < N; ++i) {
      x[i].a = wide[i];
      for (std::size_t k = 0; k < M; ++k) x[i].v[static_cast<int>(k)] = wide[N * (1 + k) + i];
    }
    return x;
  }
  static void write(const State& x, Wide& wide) {
    for (std::size_t i = 0; i < N; ++i) {
      wide[i] = x[i].a;
      for (std::size_t k = 0; k < M; ++k) wide[N * (1 + k) + i] = x[i].v[static_cast<int>(k)];
    }
  }
  static Parameters vary(const std::array<double, M>& p) {
    Parameters duals;
    for (std::size_t k = 0; k < M; ++k) duals[k] = Number(p[k], static_cast<int>(k));
    return duals;
  }
};

/// guard(t, x, p) and action(t, before, p, x), which writes x, take any number type, as f does.
template <class Guard, class Action>
struct SensitiveGuard {
  std::string name;
  Guard guard;
  Direction direction;
  Action action;
};
template <class Guard, class Action>
SensitiveGuard(std::string, Guard, Direction, Action) -> SensitiveGuard<Guard, Action>;

template <std::size_t N, std::size_t M>
struct DualSensitivities {
  Solution<std::array<double, N * (1 + M)>> solution;

  std::size_t rows() const { return solution.t.size(); }
  std::array<double, N> x(std::size_t row) const { return part(row, 0); }
  /// dx/dp[k].
  std::array<double, N> by(std::size_t row, std::size_t k) const { return part(row, N * (1 + k)); }

 private:
  std::array<double, N> part(std::size_t row, std::size_t first) const {
    std::array<double, N> values;
    std::copy_n(solution.x[row].begin() + static_cast<std::ptrdiff_t>(first), N, values.begin());
    return values;
  }
};

namespace detail {

/// The event as the wide state sees it.
template <class Duals, class F, class Guard, class Action>
Event<typename Duals::Wide> wide_event(F f, typename Duals::Parameters p, SensitiveGuard<Guard, Action> event) {
  using Number = typename Duals::Number;
  using State = typename Duals::State;
  using Wide = typename Duals::Wide;
  auto slope = [f, p, guard = event.guard](double t, const State& x) mutable {
    // dg/dx x' + dg/dt: along x + eps x', t + eps.
    using Rate = ceres::Jet<double, 1>;
    State rates{};
    f(Number(t), x, p, rates);
    std::array<Rate, Duals::states> moving;
    std::array<Rate, Duals::parameters> still;
    for (std::size_t i = 0; i < moving.size(); ++i) moving[i].a = x[i].a, moving[i].v[0] = rates[i].a;
    for (std::size_t k = 0; k < still.size(); ++k) still[k] = Rate(p[k].a);
    return guard(Rate(t, 0), moving, still).v[0];
  };
  auto act = [f, p, event, slope](EventAction<Wide>& now) mutable {
    const State before = Duals::read(now.before);
    const Number g = event.guard(Number(now.t), before, p);
    const Number time(now.t, (-g.v / slope(now.t, before)).eval());
    State rates{}, moved = before, after{}, after_rates{};
    f(Number(now.t), before, p, rates);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i].v += rates[i].a * time.v;
    after = moved;
    event.action(time, moved, p, after);
    f(Number(now.t), after, p, after_rates);
    for (std::size_t i = 0; i < moved.size(); ++i) after[i].v -= after_rates[i].a * time.v;
    Duals::write(after, now.x);
  };
  std::array<double, Duals::parameters> values{};
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = p[k].a;
  return {.name = event.name,
          .guard =
              [guard = event.guard, values](double t, const Wide& wide) mutable {
                std::array<double, Duals::states> x;
                std::copy_n(wide.begin(), x.size(), x.begin());
                return guard(t, x, values);
              },
          .direction = event.direction,
          .action = act};
}

}  // namespace detail

/// dx/dt = f(t, x, p), x(from) = x0(p) with `start` = dx0/dp, one column per parameter; zero where it is empty.
/// f is called as f(t, x, p, dxdt). `options.events` stay empty: events are the last arguments.
template <class F, std::size_t N, std::size_t M, class... Guards, class... Actions>
DualSensitivities<N, M> sensitivities(F f, const std::array<double, N>& x0, const std::array<double, M>& p,
                                      Interval<double> interval,
                                      Options<typename SensitivityDuals<N, M>::Wide> options = {},
                                      const std::vector<std::array<double, N>>& start = {},
                                      SensitiveGuard<Guards, Actions>... events) {
  using Duals = SensitivityDuals<N, M>;
  typename Duals::Wide wide{};
  std::ranges::copy(x0, wide.begin());
  for (std::size_t k = 0; k < start.size(); ++k)
    std::ranges::copy(start[k], wide.begin() + static_cast<std::ptrdiff_t>(N * (1 + k)));
  const auto varied = Duals::vary(p);
  (options.events.push_back(detail::wide_event<Duals>(f, varied, std::move(events))), ...);
  const auto system = [f, varied](double t, const typename Duals::Wide& x, typename Duals::Wide& dxdt) mutable {
    typename Duals::State rates{};
    f(typename Duals::Number(t), Duals::read(x), varied, rates);
    Duals::write(rates, dxdt);
  };
  return {solve(system, wide, interval, options)};
}

}  // namespace continuo::studies
