// The events of a run with forward sensitivities, which carry S across the jump of each event.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/numerics/finite.hpp>
#include <continuo/sensitivities/forward/variational_system.hpp>
#include <continuo/sensitivities/parametric_event.hpp>
#include <continuo/solve/event.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// The source of these events, for the states of a VariationalSystem.
template <class F, State X, State P>
class VariationalEvents {
 public:
  using Real = Scalar<X>;
  using Z = std::vector<Real>;
  using System = VariationalSystem<F, X, P>;

  /// The events of a run of this length that begins at `start`.
  VariationalEvents(std::vector<detail::ParametricEvent<X, P>> events, const X& x0, const P& p, Real start, Real length)
      : events_(std::move(events)),
        plain_(plain_events(events_, p)),
        start_(start),
        length_(length),
        instant_(std::numeric_limits<Real>::quiet_NaN()),
        slope_(x0),
        slope_after_(x0),
        after_(x0) {}

  [[nodiscard]] std::size_t size() const { return plain_.size(); }
  [[nodiscard]] std::string_view name(std::size_t i) const { return plain_.name(i); }
  [[nodiscard]] Direction direction(std::size_t i) const { return plain_.direction(i); }
  [[nodiscard]] bool is_guard(std::size_t i) const { return plain_.is_guard(i); }
  [[nodiscard]] bool can_restart(std::size_t i) const { return plain_.can_restart(i); }
  [[nodiscard]] bool can_assign(std::size_t i) const { return plain_.can_assign(i); }
  [[nodiscard]] bool active(const System&, std::size_t) const { return true; }
  [[nodiscard]] Real next_time(std::size_t i, Real t, bool inclusive) const {
    return plain_.next_time(i, t, inclusive);
  }
  void guards(System& system, Real t, const Z& z, std::span<Real> values) const {
    plain_.guards(system, t, system.take(z), values);
  }
  [[nodiscard]] std::string problem(Real from, Real to, const Z& z) const {
    X x = slope_;
    for (std::size_t i = 0; i < dimension(x); ++i) x.data()[i] = z[i];
    return plain_.problem(from, to, x);
  }

  /// Executes the action on x, and carries S across.
  [[nodiscard]] EventResponse fire(System& system, std::size_t i, Real t, const Z& before, Z& z) {
    if (t != instant_) changes_.clear();
    instant_ = t;
    const X x = system.take(before);
    X ignored = x;
    EventResponse response = plain_.fire(system, i, t, x, ignored);
    system.slope(t, before, slope_);
    const std::vector<Real> moves = moves_of(system, i, t, x, before);
    times_.push_back({i, t, moves});
    response.stop = response.stop || !status_;
    if (!events_[i].has_action()) return response;
    static_cast<void>(events_[i].act(t, x, system.parameters(), after_, rows_));
    for (std::size_t k = 0; k < dimension(after_); ++k) z[k] = after_.data()[k];
    system.slope(t, z, slope_after_);
    carry(system, moves, before, z);
    response.restart = z != before;
    if (response.restart) changes_.push_back({x, after_, moves});
    return response;
  }

  /// The events that have happened.
  [[nodiscard]] const std::vector<EventTime<Real>>& times() const { return times_; }
  /// A failure where the motion has no derivative at an event.
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  /// What an event of the present instant has changed.
  struct Change {
    X before, after;
    std::vector<Real> moves;
  };

  [[nodiscard]] static EventList<X> plain_events(const std::vector<detail::ParametricEvent<X, P>>& events, const P& p) {
    std::vector<Event<X>> list;
    for (const auto& event : events) list.push_back(event.event(p));
    return EventList<X>(std::move(list));
  }

  /// dt/dp of the event: none of one at a given time or at the start of the run. Of one that an action of the same
  /// instant has set off it is that of the action's event; else that of the crossing.
  [[nodiscard]] std::vector<Real> moves_of(System& system, std::size_t i, Real t, const X& x, const Z& z) {
    std::vector<Real> moves(system.columns());
    if (!events_[i].has_guard() || t == start_) return moves;
    for (std::size_t c = changes_.size(); c-- > 0;) {
      const Change& change = changes_[c];
      if (events_[i].guard(t, change.before, system.parameters(), by_x_) !=
          events_[i].guard(t, change.after, system.parameters(), by_x_))
        return change.moves;
    }
    using std::abs;
    const std::size_t n = system.size(), m = dimension(system.parameters());
    const Real g = events_[i].guard(t, x, system.parameters(), by_x_);
    Real rate = by_x_[n + m];
    for (std::size_t j = 0; j < n; ++j) rate += by_x_[j] * slope_.data()[j];
    // A guard further from zero than its slope comes in this part of the run has jumped there.
    if (!(abs(g) <= Real(least_jump) * abs(rate) * length_)) return no_derivative(i, g == Real(0), moves);
    for (std::size_t k = 0; k < moves.size(); ++k) {
      Real along = k < m ? by_x_[n + k] : Real(0);
      for (std::size_t j = 0; j < n; ++j) along += by_x_[j] * z[n * (1 + k) + j];
      moves[k] = along == Real(0) ? Real(0) : -along / rate;
      if (!detail::is_finite(moves[k])) return no_derivative(i, true, moves);
    }
    return moves;
  }
  [[nodiscard]] std::vector<Real> no_derivative(std::size_t i, bool without_slope, std::vector<Real> moves) {
    const std::string name = "`" + std::string(plain_.name(i)) + "` ";
    if (status_)
      status_ = {.ending = Ending::cannot_continue,
                 .message = without_slope
                                ? name + "is not crossed with a slope: the motion has no derivative there"
                                : name +
                                      "jumps across its threshold, so that how its time moves is not known: let the "
                                      "event watch what is continuous"};
    moves.assign(moves.size(), Real(0));
    return moves;
  }

  /// S+ = dr/dx (S- + f- dt) + dr/dt dt + dr/dp - f+ dt.
  void carry(System& system, const std::vector<Real>& moves, const Z& before, Z& z) const {
    const std::size_t n = system.size(), m = dimension(system.parameters()), width = n + m + 1;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        Real sum = (k < m ? rows_[i * width + n + k] : Real(0)) +
                   (rows_[i * width + n + m] - slope_after_.data()[i]) * moves[k];
        for (std::size_t j = 0; j < n; ++j)
          sum += rows_[i * width + j] * (before[n * (1 + k) + j] + slope_.data()[j] * moves[k]);
        z[n * (1 + k) + i] = sum;
      }
    }
  }

  static constexpr double least_jump = 1e-6;

  std::vector<detail::ParametricEvent<X, P>> events_;
  EventList<X> plain_;
  Real start_, length_, instant_;
  std::vector<Change> changes_;  // of the present instant
  X slope_, slope_after_, after_;
  std::vector<Real> by_x_, rows_;
  std::vector<EventTime<Real>> times_;
  Status status_;
};

}  // namespace continuo
