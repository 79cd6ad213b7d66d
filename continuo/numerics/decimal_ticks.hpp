// Instants at equal distances as people write them: `every 0.1` means 0.1, 0.2, 0.3, and not the multiples of the
// double nearest to 0.1, of which the third is 0.30000000000000004.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

namespace continuo {

namespace detail {

/// number = digits * 10^exponent, by the shortest text that reads back as the number.
struct Decimal {
  std::int64_t digits = 0;
  int exponent = 0;
};

/// Empty where more than fifteen digits are needed: nobody wrote such a number as a decimal (1/3, 0.1 + 0.2).
[[nodiscard]] std::optional<Decimal> shortest_decimal(double number);

/// digits * 10^exponent, rounded once.
[[nodiscard]] double value_of(std::int64_t digits, int exponent);

}  // namespace detail

/// The instants first, first + period, first + 2 period, ...: of two decimals of at most fifteen digits each instant is
/// the number nearest to the decimal sum; else first + k period, computed afresh for each k, so that a million periods
/// do not drift.
template <class Real>
class DecimalTicks {
 public:
  DecimalTicks() = default;
  /// The instants from `first` on, `period` apart. The period must not be zero.
  DecimalTicks(Real first, Real period) : first_(first), period_(period) {
    if constexpr (std::is_same_v<Real, double>) align();
  }

  /// The instant of number 0.
  [[nodiscard]] const Real& first() const { return first_; }
  /// The distance of the instants.
  [[nodiscard]] const Real& period() const { return period_; }

  /// The instant of number k = 0, 1, 2, ...
  Real operator[](Real k) const {
    if constexpr (std::is_same_v<Real, double>) {
      if (decimal_ && k <= most_) {
        return detail::value_of(first_digits_ + static_cast<std::int64_t>(k) * period_digits_, exponent_);
      }
    }
    return first_ + k * period_;
  }

  /// The first instant after t, or at t where `inclusive`. The period must be greater than the spacing of numbers
  /// there, see `advances`.
  [[nodiscard]] Real next(Real t, bool inclusive) const {
    using std::floor;
    Real k = floor((t - first_) / period_) - 1;
    if (!(k > 0)) k = 0;
    for (int tries = 0; tries < 8; ++tries, k += 1) {
      const Real instant = (*this)[k];
      if (inclusive ? instant >= t : instant > t) return instant;
    }
    return std::numeric_limits<Real>::infinity();
  }

  /// Whether the instants up to `to` are different numbers: a period of 1e-17 at 1 leads nowhere.
  [[nodiscard]] bool advances(Real to) const {
    using std::abs, std::fmax;
    const Real largest = abs(to) > abs(first_) ? abs(to) : abs(first_);
    return period_ > 2 * std::numeric_limits<Real>::epsilon() * largest;
  }

 private:
  void align() {
    const auto first = detail::shortest_decimal(first_), period = detail::shortest_decimal(period_);
    if (!first || !period || period->digits == 0) return;
    exponent_ = first->digits == 0 || period->exponent < first->exponent ? period->exponent : first->exponent;
    const auto at_exponent = [&](const detail::Decimal& decimal) -> std::optional<std::int64_t> {
      std::int64_t digits = decimal.digits;
      for (int e = decimal.exponent; digits != 0 && e > exponent_; --e)
        if (__builtin_mul_overflow(digits, std::int64_t{10}, &digits)) return std::nullopt;
      return digits;
    };
    const auto first_digits = at_exponent(*first), period_digits = at_exponent(*period);
    if (!first_digits || !period_digits) return;
    constexpr auto most = static_cast<double>(std::numeric_limits<std::int64_t>::max() / 4);
    if (std::abs(static_cast<double>(*first_digits)) > most) return;
    first_digits_ = *first_digits;
    period_digits_ = *period_digits;
    most_ = std::floor(most / std::abs(static_cast<double>(period_digits_)));
    decimal_ = true;
  }

  Real first_{}, period_{};
  std::int64_t first_digits_ = 0, period_digits_ = 0;  // in units of 10^exponent_
  double most_ = 0;                                    // the last k whose sum the integers hold
  int exponent_ = 0;
  bool decimal_ = false;
};

}  // namespace continuo
