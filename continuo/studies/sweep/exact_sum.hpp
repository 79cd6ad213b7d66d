// Sums without rounding: integers that are wide enough for every number of type double. Addition of integers is
// associative, so that sums are the same to the bit in whatever order, by however many threads and machines they are
// made. U. Kulisch, W. L. Miranker, "The arithmetic of the digital computer: a new approach", SIAM Review 28 (1986).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace continuo::studies {

/// An integer times 2^lowest_bit in digits of 32 bits, the lowest first. Digits may be negative and larger than 32 bits
/// until they are carried.
template <std::size_t Digits, int LowestBit>
class WideNumber {
 public:
  /// Adds (or subtracts) magnitude * 2^bit. The number must be wide enough for the result.
  void add(std::uint64_t magnitude, int bit, bool negative);
  /// Adds another number.
  void add(const WideNumber& other);
  /// The digits, each from 0 to 2^32 - 1 but the highest, which has the sign.
  [[nodiscard]] std::array<std::int64_t, Digits> carried() const;

 private:
  void carry();

  std::array<std::int64_t, Digits> digits_{};
  std::uint32_t additions_ = 0;  // since digits were carried; each adds less than 2^32 to a digit
};

inline constexpr int lowest_bit_of_sum = -1074,
                     lowest_bit_of_squares = 2 * lowest_bit_of_sum;  // of 2^-1074, and its square

/// The sum of up to 2^63 finite numbers.
class ExactSum {
 public:
  /// Adds a finite number.
  void add(double value);
  /// Adds another sum.
  void add(const ExactSum& other) { number_.add(other.number_); }
  /// The sum divided by a count, to the last bit but one.
  [[nodiscard]] double divided_by(std::uint64_t count) const;

  using Number = WideNumber<68, lowest_bit_of_sum>;  // 1074 + 1024 + 63 bits and the sign
  /// All digits.
  [[nodiscard]] const Number& number() const { return number_; }

 private:
  Number number_;
};

/// The sum of the squares of up to 2^63 finite numbers.
class ExactSumOfSquares {
 public:
  /// Adds the square of a finite number.
  void add(double value);
  /// Adds another sum.
  void add(const ExactSumOfSquares& other) { number_.add(other.number_); }

  using Number = WideNumber<134, lowest_bit_of_squares>;  // 2148 + 2048 + 63 bits and the sign
  /// All digits.
  [[nodiscard]] const Number& number() const { return number_; }

 private:
  Number number_;
};

/// The standard deviation of `count` >= 2 numbers with these sums, with the divisor count - 1, to the last bit but one.
[[nodiscard]] double deviation_of(const ExactSum& sum, const ExactSumOfSquares& squares, std::uint64_t count);

}  // namespace continuo::studies
