// continuo/solve/solution.hpp
// The result of a run: states, dense output, events, statistics, outcome.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/state.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo {

/// One event that has occurred, with the state on both sides of it.
template <State X>
struct EventRecord {
  std::size_t event;  // its number; Solution::event_names has the name
  Scalar<X> t;        // its time
  X before;           // the state before its action
  X after;            // the state after it
};

/// A piece of a step's polynomial: x(t) = sum_j coefficients[j] theta^j, theta = (t - origin) / h, from begin to end.
template <State X>
struct DenseSegment {
  Scalar<X> begin;              // the first time of the piece
  Scalar<X> end;                // its last time
  Scalar<X> origin;             // where theta is 0
  Scalar<X> h;                  // the size of the step: theta is 1 at origin + h
  std::vector<X> coefficients;  // of theta^0, theta^1, ...

  /// x = x(t), for t from begin to end; outside, the polynomial is continued.
  void operator()(Scalar<X> t, X& x) const {
    const Scalar<X> theta = (t - origin) / h;
    x = coefficients.back();
    for (std::size_t j = coefficients.size() - 1; j-- > 0;)
      for (std::size_t i = 0; i < dimension(x); ++i) x.data()[i] = x.data()[i] * theta + coefficients[j].data()[i];
  }
};

/// The result of a run.
template <State X>
struct Solution {
  using Real = Scalar<X>;
  std::vector<Real> t;  // the times of the kept states, see Save; where an event changes the state, two of them
  std::vector<X> x;     // the kept states, one for each t
  std::vector<EventRecord<X>> events;     // all that have occurred, in the order of time
  std::vector<std::string> event_names;   // by number
  std::vector<DenseSegment<X>> segments;  // with Save::dense()
  Statistics statistics;                  // what the run has cost
  Outcome<Real> outcome;                  // why it ended
  std::optional<X> last{};                // the last valid state, whatever is saved
  bool dense = false;                     // saved with Save::dense()

  /// The last valid state, at outcome.t. It is known whatever the run saves.
  [[nodiscard]] const X& final_state() const {
    if (last) return *last;
    if (x.empty()) throw std::logic_error("there is no final state: this solution is not that of a run");
    return x.back();
  }

  /// x(t) anywhere in the run; needs Save::dense(). At an event: the state after it. Throws std::out_of_range for a
  /// time outside of the run, std::logic_error without Save::dense().
  X operator()(Real time) const {
    if (!dense && segments.empty()) throw std::logic_error("x(t) needs a solution saved with Save::dense()");
    if (segments.empty()) {  // a run of no length, or one that has failed before the first step
      if (time == outcome.t) return final_state();
      throw std::out_of_range("x(t) is known at the only time of the run, no other");
    }
    const bool forward = segments.back().end >= segments.front().begin;
    check_time(time, forward ? segments.front().begin : segments.back().end,
               forward ? segments.back().end : segments.front().begin);
    const auto after = std::upper_bound(segments.begin(), segments.end(), time, [&](Real value, const auto& segment) {
      return forward ? value < segment.begin : value > segment.begin;
    });
    const DenseSegment<X>& segment = after == segments.begin() ? *after : *std::prev(after);
    X result = segment.coefficients.back();
    segment(time, result);
    return result;
  }

 private:
  // A time that a sum of steps of a table has carried beyond an end by rounding is that end.
  static void check_time(const Real& time, const Real& first, const Real& last_time) {
    using std::abs, std::max;
    const Real slack =
        Real(64) * std::numeric_limits<Real>::epsilon() * max(max(abs(first), abs(last_time)), Real(last_time - first));
    if (!(time >= first - slack) || !(time <= last_time + slack))
      throw std::out_of_range("x(t) is known within the run only: this t lies outside");
  }
};

}  // namespace continuo
