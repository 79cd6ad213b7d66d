// continuo/numerics/banded_lu.cpp
// Written out for every width, therefore compiled once: what starts it is here, and not inline, as inline functions are
// compiled by each of their callers.
#include <continuo/numerics/banded_lu.hpp>

namespace continuo {

template <class Number>
BandedLU<Number>::BandedLU(const BandLayout& layout)
    : layout_(layout), size_(layout.size), lower_(layout.lower), upper_(layout.upper) {
  if (layout.is_narrow()) {
    const std::size_t right = lower_ + upper_, left_over = right + size_ % 2, columns = (size_ - left_over) / 2;
    ends_ = {End(columns + lower_ + size_ % 2, columns, lower_, right), End(columns + lower_, columns, lower_, right)};
    straight_ = detail::StraightFactors<Number>(columns, lower_);
    middle_ = DenseLU<Number>(left_over);
  } else {
    ends_[0] = End(size_, size_, lower_, lower_ + upper_);
    window_.resize((lower_ + 2) * (lower_ + upper_ + 1));
  }
}

template <class Number>
bool BandedLU<Number>::factor(std::span<const Real> jacobian, const Number& c, std::span<const Real> mass) {
  const auto stride = static_cast<std::ptrdiff_t>(layout_.stride);
  const std::size_t last = size_ - 1;
  const bool is_identity = mass.empty();
  const FromTop top{jacobian.data(), stride, c, is_identity ? nullptr : mass.data()};
  if (is_wide()) return factor_wide(top);
  const FromBottom bottom{jacobian.data() + layout_.place(last, last + upper_), stride, c,
                          is_identity ? nullptr : mass.data() + last};
  return with_width([&]<std::size_t B>() { return factor_narrow<B>(top, bottom); });
}

template <class Number>
void BandedLU<Number>::solve(Number* b) {
  if (is_wide()) return solve_wide(b);
  with_width([&]<std::size_t B>() {
    solve_narrow<B>(b);
    return true;
  });
}

template class BandedLU<double>;
template class BandedLU<ComplexNumber<double>>;

}  // namespace continuo
