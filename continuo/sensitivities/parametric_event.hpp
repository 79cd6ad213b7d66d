// Events of runs with parameters, whose times and actions depend on these. They are made by falls, rises, crosses, at
// and every (event.hpp), with a guard g(t, x) or g(t, x, p) and an action that may read the parameters:
//
//   falls("floor", [](auto, const auto& x, const auto&) { return x[0]; },
//         [](auto& now) { now.x[1] = -now.p[1] * now.before[1]; })
//
// Guards and actions take any number type, since they are differentiated by tracing, and an action depends on t, the
// state before and p alone: it may be called several times.
#pragma once
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/sensitivities/parametric_function.hpp>
#include <continuo/solve/event.hpp>

namespace continuo {

/// The data that an action of a run with parameters reads and may change.
template <class X, class P>
struct ParametricAction {
  typename X::value_type t;
  const X& before;
  X& x;  // starts as `before`
  const P& p;
  bool stop = false;
};

/// An event of a run, and how its time depends on the influences: dt/dp, and dt/dx0 where that was asked for.
template <class Real>
struct EventTime {
  std::size_t event;  // its number
  Real t;
  std::vector<Real> moves;
};

namespace detail {

template <class E>
inline constexpr bool is_event_of = false;
template <class G, class A, class Real, class L>
inline constexpr bool is_event_of<EventOf<G, A, Real, L>> = true;

template <class G, class T, class X, class P>
concept GuardOfParameters = std::invocable<G&, T, const X&, const P&>;
template <class G, class T, class X, class P>
concept GuardOfState = std::invocable<G&, T, const X&>;
template <class G, class X, class P>
concept TraceableGuard = GuardOfParameters<G, Traced<Scalar<X>>, TracedState<X>, TracedState<P>> ||
                         GuardOfState<G, Traced<Scalar<X>>, TracedState<X>, TracedState<P>>;
template <class A, class X, class P>
concept TraceableAction = std::invocable<A&, ParametricAction<TracedState<X>, TracedState<P>>&>;

/// g(t, x, p), or g(t, x).
template <class G, class T, class X, class P>
[[nodiscard]] auto guard_value(G& g, const T& t, const X& x, const P& p) {
  if constexpr (GuardOfParameters<G, T, X, P>) {
    return g(t, x, p);
  } else {
    return g(t, x);
  }
}

/// Refuses, at compile time, an event that has no derivative.
template <class E, class X, class P>
[[nodiscard]] consteval bool check_parametric_event() {
  constexpr bool typed = is_event_of<E>;
  static_assert(typed,
                "what follows the options must be events as falls, rises, crosses, at and every make them, where the "
                "type of the state is not named: of an Event<X> the guard cannot be differentiated");
  if constexpr (typed) {
    using Guard = decltype(E::guard);
    using Action = decltype(E::action);
    constexpr bool guard = std::same_as<Guard, NoFunction> || TraceableGuard<Guard, X, P>;
    constexpr bool action = std::same_as<Action, NoFunction> || TraceableAction<Action, X, P>;
    constexpr bool no_limit = std::same_as<decltype(E::at_limit), NoFunction>;
    static_assert(guard,
                  "the guard of an event must take any number type: [](auto t, const auto& x, const auto& p) { return "
                  "...; }, or without p");
    static_assert(action, "the action of an event must take any number type: [](auto& now) { now.x[0] = ...; }");
    static_assert(no_limit,
                  "where events accumulate the motion has no derivative: an action at the limit, `then`, is not "
                  "supported with sensitivities");
    return guard && action && no_limit;
  } else {
    return false;
  }
}

/// One event of a run with parameters, with its derivatives, in the same type for all events.
template <State X, State P>
class ParametricEvent {
 public:
  using Real = Scalar<X>;

  template <class E>
  explicit ParametricEvent(const E& event) : functions_(std::make_shared<Typed<E>>(event)) {}

  /// The event as a run with these parameters has it.
  [[nodiscard]] Event<X> event(const P& p) const { return functions_->event(p); }
  [[nodiscard]] bool has_guard() const { return functions_->has_guard(); }
  [[nodiscard]] bool has_action() const { return functions_->has_action(); }
  /// Whether the motion begins again at the event; else it is only noted.
  [[nodiscard]] bool ends_step() const { return functions_->ends_step(); }
  /// g at (t, x, p); its derivatives by x, by p and by t, side by side, become `slopes`.
  Real guard(const Real& t, const X& x, const P& p, std::vector<Real>& slopes) const {
    return functions_->guard(t, x, p, slopes);
  }
  /// x after the action; row i of `rows` has the derivatives of component i by x before, by p and by t. Returns whether
  /// the action stops the run.
  bool act(const Real& t, const X& before, const P& p, X& after, std::vector<Real>& rows) const {
    return functions_->act(t, before, p, after, rows);
  }

 private:
  struct Functions {
    Functions() = default;
    Functions(const Functions&) = delete;
    Functions& operator=(const Functions&) = delete;
    virtual ~Functions() = default;
    virtual Event<X> event(const P& p) const = 0;
    virtual bool has_guard() const = 0;
    virtual bool has_action() const = 0;
    virtual bool ends_step() const = 0;
    virtual Real guard(const Real& t, const X& x, const P& p, std::vector<Real>& slopes) const = 0;
    virtual bool act(const Real& t, const X& before, const P& p, X& after, std::vector<Real>& rows) const = 0;
  };
  /// t, x and p as variables of a trace, in the order x, p, t.
  struct Variables {
    Trace<Real> trace;
    TracedState<X> x{};
    TracedState<P> p{};
    Traced<Real> t;
    std::size_t count;

    Variables(const Real& at, const X& plain_x, const P& plain_p) : count(dimension(plain_x) + dimension(plain_p) + 1) {
      if constexpr (requires { x.resize(dimension(plain_x)); }) x.resize(dimension(plain_x));
      if constexpr (requires { p.resize(dimension(plain_p)); }) p.resize(dimension(plain_p));
      for (std::size_t j = 0; j < dimension(plain_x); ++j) x.data()[j] = trace.variable(plain_x.data()[j]);
      for (std::size_t k = 0; k < dimension(plain_p); ++k) p.data()[k] = trace.variable(plain_p.data()[k]);
      t = trace.variable(at);
    }
  };

  template <class E>
  struct Typed final : Functions {
    using Guard = decltype(E::guard);
    using Action = decltype(E::action);
    static constexpr bool guarded = !std::same_as<Guard, NoFunction>, acts = !std::same_as<Action, NoFunction>;

    explicit Typed(const E& event) : event_(event) {}

    [[nodiscard]] Event<X> event(const P& p) const override {
      Event<X> result{.name = event_.name, .direction = event_.direction};
      if constexpr (guarded)
        result.guard = [g = event_.guard, p](const Real& t, const X& x) mutable {
          return static_cast<Real>(guard_value(g, t, x, p));
        };
      // What moves with p may leave x as it is now: the motion begins again all the same.
      if constexpr (acts) {
        result.action = [action = event_.action, p](EventAction<X>& now) mutable {
          ParametricAction<X, P> data{now.t, now.before, now.x, p};
          action(data);
          now.stop = data.stop;
          now.restart = true;
        };
      } else if (event_.stop_after != 0) {
        result.action = [](EventAction<X>& now) { now.restart = true; };
      }
      for (const auto& time : event_.times) result.times.push_back(static_cast<Real>(time));
      result.period = static_cast<Real>(event_.period);
      result.from = static_cast<Real>(event_.from);
      result.stop_after = event_.stop_after;
      return result;
    }
    [[nodiscard]] bool has_guard() const override { return guarded; }
    [[nodiscard]] bool has_action() const override { return acts; }
    [[nodiscard]] bool ends_step() const override { return acts || event_.stop_after != 0; }

    Real guard(const Real& t, const X& x, const P& p, std::vector<Real>& slopes) const override {
      if constexpr (guarded) {
        Variables variables(t, x, p);
        auto g = event_.guard;
        const Traced<Real> value = guard_value(g, variables.t, variables.x, variables.p);
        const std::span<const Real> found = variables.trace.slopes_of(value);
        slopes.assign(found.begin(), found.end());
        return value.value();
      } else {
        return Real(0);
      }
    }
    bool act(const Real& t, const X& before, const P& p, X& after, std::vector<Real>& rows) const override {
      Variables variables(t, before, p);
      TracedState<X> traced = variables.x;
      bool stop = false;
      if constexpr (acts) {
        auto action = event_.action;
        ParametricAction<TracedState<X>, TracedState<P>> now{variables.t, variables.x, traced, variables.p};
        action(now);
        stop = now.stop;
      }
      rows.clear();
      for (std::size_t i = 0; i < dimension(before); ++i) {
        after.data()[i] = traced.data()[i].value();
        const std::span<const Real> found = variables.trace.slopes_of(traced.data()[i]);
        rows.insert(rows.end(), found.begin(), found.end());
      }
      return stop;
    }

    E event_;
  };

  std::shared_ptr<const Functions> functions_;
};

/// The events of a run, refused at compile time where one has no derivative.
template <State X, State P, class... Events>
[[nodiscard]] std::vector<ParametricEvent<X, P>> parametric_events(const Events&... events) {
  std::vector<ParametricEvent<X, P>> result;
  if constexpr ((check_parametric_event<Events, X, P>() && ...)) (result.emplace_back(events), ...);
  return result;
}

}  // namespace detail
}  // namespace continuo
