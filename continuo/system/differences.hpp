// Derivatives by differences that know how far they can be trusted: central ones at ever smaller increments,
// extrapolated to none (C. Ridders, Adv. Eng. Software 4 (1982) 75), with the error that the extrapolation shows and
// what rounding may add to it. Dear, unlike the differences of jacobian.hpp: for checking, not for solving.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/numerics/finite.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// The derivative of one component of f by one variable.
template <class Real>
struct Difference {
  Real slope{};                                        // the estimate of the derivative
  Real doubt = std::numeric_limits<Real>::infinity();  // |slope - the derivative| is not above it
  Real below{};                                        // the slope to the smaller side, where the two differ
  Real above{};                                        // the slope to the greater side
  bool found = false;                                  // f is finite around
  bool kinked = false;                                 // the slopes to either side stay apart: no derivative here
};

/// Central differences at twelve increments, extrapolated, with a bound of their error.
template <State X>
class Differences {
 public:
  using Real = Scalar<X>;
  using Column = std::vector<Difference<Real>>;

  /// Allocates for states like x; nothing is allocated afterwards except the results.
  explicit Differences(const X& x) : moved_(x), above_(levels, x), below_(levels, x) {}

  /// d f / d x[j]; fx = f(t, x), size > 0 says how large x[j] is, terms[i] what the terms of f[i] amount to, of which
  /// rounding is a part.
  template <class F>
  [[nodiscard]] Column by_component(F& f, const Real& t, const X& x, const X& fx, std::size_t j, const Real& size,
                                    const std::vector<Real>& terms) {
    moved_ = x;
    return measure(x.data()[j], size, fx, terms, [&](const Real& value, X& result) {
      moved_.data()[j] = value;
      evaluate(f, t, moved_, result);
    });
  }

  /// df/dt.
  template <class F>
  [[nodiscard]] Column by_time(F& f, const Real& t, const X& x, const X& fx, const Real& size,
                               const std::vector<Real>& terms) {
    return measure(t, size, fx, terms, [&](const Real& value, X& result) { evaluate(f, value, x, result); });
  }

 private:
  // From a sixteenth of the variable down to 1e-8 of it: features of f far below its variable's size are found, and
  // where f is smooth the first few are enough.
  static constexpr int levels = 12, first_exponent = -4, exponents_a_level = 2;
  static constexpr int most_eliminations = 6;
  // Two increments, a factor 16 apart, at which the slopes to either side are compared. They close in on each other by
  // that factor where f is smooth.
  static constexpr int kink_level = 5, second_kink_level = 7;
  static constexpr double least_gap = 1e-6;  // of the slopes
  static constexpr int safety = 10;          // the shown error is an estimate, and rounding comes several times

  template <class Value>
  [[nodiscard]] Column measure(const Real& at, const Real& size, const X& fx, const std::vector<Real>& terms,
                               Value&& value) {
    using std::ilogb, std::ldexp;
    const int exponent = static_cast<int>(ilogb(size)) + first_exponent;
    for (int k = 0; k < levels; ++k) {
      // Powers of two: the sums with the variable are all but exact.
      const Real increment = ldexp(Real(1), exponent - exponents_a_level * k);
      const Real high = at + increment, low = at - increment;
      increments_[k] = {high - at, at - low};
      value(high, above_[static_cast<std::size_t>(k)]);
      value(low, below_[static_cast<std::size_t>(k)]);
    }
    Column column(dimension(fx));
    for (std::size_t i = 0; i < column.size(); ++i) {
      column[i] = extrapolated(i, terms[i]);
      look_for_kink(i, fx.data()[i], terms[i], column[i]);
    }
    return column;
  }

  struct Increments {
    Real above, below;
    [[nodiscard]] Real both() const { return above + below; }
  };

  [[nodiscard]] const Real& high(int k, std::size_t i) const { return above_[static_cast<std::size_t>(k)].data()[i]; }
  [[nodiscard]] const Real& low(int k, std::size_t i) const { return below_[static_cast<std::size_t>(k)].data()[i]; }

  [[nodiscard]] Real rounding(int k, const Real& terms) const {
    return std::numeric_limits<Real>::epsilon() * terms / increments_[k].both();
  }

  /// The table of extrapolations, of which the entry with the least error is taken. Its errors go with the square of
  /// the increment, so the m-th elimination weighs with 16^m.
  [[nodiscard]] Difference<Real> extrapolated(std::size_t i, const Real& terms) const {
    using std::abs, std::max, std::min;
    Difference<Real> best;
    Real before[most_eliminations + 1] = {}, now[most_eliminations + 1] = {};
    int usable = 0;
    for (int k = 0; k < levels; ++k) {
      now[0] = (high(k, i) - low(k, i)) / increments_[k].both();
      if (!detail::is_finite(now[0])) {
        usable = 0;
        continue;
      }
      // What f is made of changes with the variable.
      const Real noise = rounding(k, max(terms, max(abs(high(k, i)), abs(low(k, i)))));
      Real weight(1);
      for (int m = 1; m <= min(usable, most_eliminations); ++m) {
        weight *= Real(1 << (2 * exponents_a_level));
        now[m] = now[m - 1] + (now[m - 1] - before[m - 1]) / (weight - Real(1));
        const Real shown = max(abs(now[m] - now[m - 1]), abs(now[m] - before[m - 1]));
        const Real doubt = Real(safety) * (shown + noise);
        if (doubt < best.doubt) best = {.slope = now[m], .doubt = doubt, .found = true};
      }
      ++usable;
      std::copy(now, now + most_eliminations + 1, before);
    }
    return best;
  }

  void look_for_kink(std::size_t i, const Real& fx, const Real& terms, Difference<Real>& difference) const {
    using std::abs, std::max;
    const auto slopes = [&](int k) {
      return std::pair((fx - low(k, i)) / increments_[k].below, (high(k, i) - fx) / increments_[k].above);
    };
    const auto [far_below, far_above] = slopes(kink_level);
    const auto [below, above] = slopes(second_kink_level);
    difference.below = below;
    difference.above = above;
    const Real gap = abs(above - below), far_gap = abs(far_above - far_below);
    const Real greatest = max(abs(high(second_kink_level, i)), abs(low(second_kink_level, i)));
    const Real noise = Real(2 * safety) * rounding(second_kink_level, max(terms, max(abs(fx), greatest)));
    const bool beyond_rounding = gap > noise && gap > Real(least_gap) * max(abs(below), abs(above));
    difference.kinked =
        detail::is_finite(gap) && detail::is_finite(far_gap) && gap > far_gap / Real(2) && beyond_rounding;
  }

  X moved_;
  std::vector<X> above_, below_;
  Increments increments_[levels] = {};
};

}  // namespace continuo
