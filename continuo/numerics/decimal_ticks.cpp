// Converts numbers to the decimals that people write, and back.
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <continuo/numerics/decimal_ticks.hpp>

namespace continuo::detail {

std::optional<Decimal> shortest_decimal(double number) {
  if (!std::isfinite(number)) return std::nullopt;
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, number, std::chars_format::scientific);
  Decimal decimal;
  int count = 0, behind_point = 0;
  bool negative = false, point = false;
  const char* c = text;
  for (; c != written.ptr && *c != 'e'; ++c) {
    if (*c == '-') {
      negative = true;
    } else if (*c == '.') {
      point = true;
    } else {
      decimal.digits = 10 * decimal.digits + (*c - '0');
      count += decimal.digits != 0 ? 1 : 0;
      behind_point += point ? 1 : 0;
    }
  }
  if (count > 15) return std::nullopt;
  if (c != written.ptr) {
    c += c[1] == '+' ? 2 : 1;
    std::from_chars(c, written.ptr, decimal.exponent);
  }
  decimal.exponent -= behind_point;
  if (negative) decimal.digits = -decimal.digits;
  return decimal;
}

double value_of(std::int64_t digits, int exponent) {
  // Both whole numbers are doubles: a single division or multiplication rounds once.
  constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  if (std::llabs(digits) <= (std::int64_t{1} << 53) && std::abs(exponent) <= 22) {
    const auto whole = static_cast<double>(digits);
    return exponent < 0 ? whole / powers[-exponent] : whole * powers[exponent];
  }
  char text[48];
  char* end = std::to_chars(text, text + 24, digits).ptr;
  *end++ = 'e';
  end = std::to_chars(end, text + sizeof text, exponent).ptr;
  double value = 0;
  std::from_chars(text, end, value);
  return value;
}

}  // namespace continuo::detail
