// continuo/solve/solution.hpp
// The result of a run: states, dense output, events, statistics, outcome.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
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
  Scalar<X> t;
  X before, after;
};

/// A piece of a step's polynomial: x(t) = sum_j coefficients[j] theta^j, theta = (t - origin) / h, from begin to end.
template <State X>
struct DenseSegment {
  Scalar<X> begin, end, origin, h;
  std::vector<X> coefficients;

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
  std::vector<Real> t;  // the times of kept states; an event that changes the state has two, before and after it
  std::vector<X> x;
  std::vector<EventRecord<X>> events;
  std::vector<std::string> event_names;
  std::vector<DenseSegment<X>> segments;  // with Save::dense()
  Statistics statistics;
  Outcome<Real> outcome;

  /// The last valid state.
  [[nodiscard]] const X& final_state() const { return x.back(); }

  /// x(t) anywhere in the run; needs Save::dense(). At an event: the state after it.
  X operator()(Real time) const {
    if (segments.empty()) throw std::logic_error("x(t) needs a solution saved with Save::dense()");
    const bool forward = segments.back().end >= segments.front().begin;
    const auto after = std::upper_bound(segments.begin(), segments.end(), time, [&](Real value, const auto& segment) {
      return forward ? value < segment.begin : value > segment.begin;
    });
    X result = x.front();
    (after == segments.begin() ? *after : *std::prev(after))(time, result);
    return result;
  }
};

}  // namespace continuo
