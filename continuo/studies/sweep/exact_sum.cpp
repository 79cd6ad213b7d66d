// Sums of numbers and of their squares as wide integers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <continuo/studies/sweep/exact_sum.hpp>

namespace continuo::studies {
namespace {

constexpr unsigned digit_bits = 32;
constexpr std::int64_t digit_mask = 0xFFFFFFFF;
constexpr std::uint32_t most_additions = std::uint32_t{1} << 29;  // each below 2^33: together below 2^62

/// An integer without a sign, its digits of 32 bits, the lowest first.
using Natural = std::vector<std::uint32_t>;

struct Signed {
  Natural magnitude;
  bool negative = false;
};

template <std::size_t Digits, int LowestBit>
Signed signed_of(const WideNumber<Digits, LowestBit>& number) {
  auto digits = number.carried();
  const bool negative = digits.back() < 0;
  std::int64_t carry = 0;
  Natural magnitude(Digits);
  for (std::size_t i = 0; i < Digits; ++i) {
    const std::int64_t digit = (negative ? -digits[i] : digits[i]) + carry;
    magnitude[i] = static_cast<std::uint32_t>(digit & digit_mask);
    carry = digit >> digit_bits;
  }
  while (!magnitude.empty() && magnitude.back() == 0) magnitude.pop_back();
  return {std::move(magnitude), negative};
}

Natural product(const Natural& a, const Natural& b) {
  Natural result(a.size() + b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::uint64_t carry = 0;
    if (a[i] == 0) continue;
    for (std::size_t j = 0; j < b.size(); ++j) {
      carry += std::uint64_t{a[i]} * b[j] + result[i + j];  // at most 2^64 - 1
      result[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= digit_bits;
    }
    result[i + b.size()] = static_cast<std::uint32_t>(carry);
  }
  return result;
}

/// a - b, which is not below 0.
Natural difference(Natural a, const Natural& b) {
  std::int64_t borrow = 0;
  a.resize(std::max(a.size(), b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::int64_t digit = std::int64_t{a[i]} - (i < b.size() ? std::int64_t{b[i]} : 0) + borrow;
    a[i] = static_cast<std::uint32_t>(digit & digit_mask);
    borrow = digit >> digit_bits;
  }
  return a;
}

/// number * 2^lowest_bit, from its highest three digits, which have 65 bits at least.
long double value_of(const Natural& number, int lowest_bit) {
  std::size_t top = number.size();
  while (top > 0 && number[top - 1] == 0) --top;
  long double value = 0;
  for (std::size_t i = top; i > 0 && i + 3 > top; --i)
    value = value * 4294967296.0L + static_cast<long double>(number[i - 1]);
  const std::size_t left_out = top > 3 ? top - 3 : 0;
  return std::ldexp(value, lowest_bit + static_cast<int>(left_out * digit_bits));
}

Natural natural(std::uint64_t value) {
  return {static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(value >> digit_bits)};
}

/// |value| = integer * 2^bit.
struct Parts {
  std::uint64_t integer;
  int bit;
};
Parts parts_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t fraction = bits & 0xFFFFFFFFFFFFF;
  const int exponent = static_cast<int>(bits >> 52 & 0x7FF);
  return exponent == 0 ? Parts{fraction, -1074} : Parts{fraction | std::uint64_t{1} << 52, exponent - 1075};
}

}  // namespace

template <std::size_t Digits, int LowestBit>
void WideNumber<Digits, LowestBit>::add(std::uint64_t magnitude, int bit, bool negative) {
  const auto offset = static_cast<unsigned>(bit - LowestBit);
  const std::size_t digit = offset / digit_bits;
  const unsigned shift = offset % digit_bits;
  const std::uint64_t low = (magnitude & 0xFFFFFFFF) << shift, high = (magnitude >> digit_bits) << shift;
  const std::uint64_t parts[] = {low & 0xFFFFFFFF, (low >> digit_bits) + (high & 0xFFFFFFFF), high >> digit_bits};
  for (std::size_t i = 0; i < 3 && digit + i < Digits; ++i)
    digits_[digit + i] += negative ? -static_cast<std::int64_t>(parts[i]) : static_cast<std::int64_t>(parts[i]);
  if (++additions_ == most_additions) carry();
}

template <std::size_t Digits, int LowestBit>
void WideNumber<Digits, LowestBit>::add(const WideNumber& other) {
  const auto others = other.carried();
  for (std::size_t i = 0; i < Digits; ++i) digits_[i] += others[i];
  if (++additions_ == most_additions) carry();
}

template <std::size_t Digits, int LowestBit>
void WideNumber<Digits, LowestBit>::carry() {
  for (std::size_t i = 0; i + 1 < Digits; ++i) {
    const std::int64_t up = digits_[i] >> digit_bits;
    digits_[i] &= digit_mask;
    digits_[i + 1] += up;
  }
  additions_ = 0;
}

template <std::size_t Digits, int LowestBit>
std::array<std::int64_t, Digits> WideNumber<Digits, LowestBit>::carried() const {
  WideNumber copy = *this;
  copy.carry();
  return copy.digits_;
}

template class WideNumber<68, lowest_bit_of_sum>;
template class WideNumber<134, lowest_bit_of_squares>;

void ExactSum::add(double value) {
  const auto [integer, bit] = parts_of(value);
  number_.add(integer, bit, std::signbit(value));
}

void ExactSumOfSquares::add(double value) {
  const auto [integer, bit] = parts_of(value);
  constexpr unsigned half = 27;  // bits: of 53, so that no product has more than 64
  const std::uint64_t low = integer & ((std::uint64_t{1} << half) - 1), high = integer >> half;
  number_.add(low * low, 2 * bit, false);
  number_.add(low * high, 2 * bit + static_cast<int>(half) + 1, false);
  number_.add(high * high, 2 * (bit + static_cast<int>(half)), false);
}

double ExactSum::divided_by(std::uint64_t count) const {
  const Signed sum = signed_of(number_);
  const long double value = value_of(sum.magnitude, lowest_bit_of_sum) / static_cast<long double>(count);
  return static_cast<double>(sum.negative ? -value : value);
}

double deviation_of(const ExactSum& sum, const ExactSumOfSquares& squares, std::uint64_t count) {
  if (count < 2) return std::numeric_limits<double>::quiet_NaN();
  // (count * squares - sum^2) / (count * (count - 1)): the subtraction, which would cancel all digits, is one of
  // integers.
  const Natural total = signed_of(sum.number()).magnitude;
  const Natural spread =
      difference(product(natural(count), signed_of(squares.number()).magnitude), product(total, total));
  const auto divisor = static_cast<long double>(count) * static_cast<long double>(count - 1);
  return static_cast<double>(std::sqrt(value_of(spread, lowest_bit_of_squares) / divisor));
}

}  // namespace continuo::studies
