// continuo/methods/support/compensated_sum.hpp
// Sums of very many terms: what an addition loses is kept beside the sum and added with the next term. W. Kahan,
// "Further remarks on reducing truncation errors", Comm. ACM 8 (1965).
#pragma once

namespace continuo::detail {

/// sum + rest is what the sum would be without rounding, to twice the digits.
template <class Number>
void add_compensated(const Number& term, Number& sum, Number& rest) {
  const Number whole = term + rest, last = sum;
  sum = last + whole;
  rest = (last - sum) + whole;
}

}  // namespace continuo::detail
