// Elimination of the nodes by reflections, from the first interval to the last, and the solution backwards.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/boundary/almost_block_diagonal.hpp>
#include <continuo/boundary/number_size.hpp>

namespace continuo::boundary {

namespace {

/// The greatest of some numbers, 1 where all are zero.
template <class Number>
double greatest_or_one(std::span<const Number> numbers) {
  double greatest = 0;
  for (const Number& number : numbers) greatest = std::max(greatest, magnitude(number));
  return greatest > 0 ? greatest : 1;
}

}  // namespace

template <class Number>
AlmostBlockDiagonal<Number>::AlmostBlockDiagonal(std::size_t size, std::size_t parameters, std::size_t intervals)
    : n_(size),
      k_(parameters),
      intervals_(intervals),
      left_(intervals * size * size),
      right_(intervals * size * size),
      border_(intervals * size * parameters),
      first_((size + parameters) * size),
      last_((size + parameters) * size),
      parameter_((size + parameters) * parameters),
      row_scales_(intervals * size),
      carried_(size * (2 * size + parameters)),
      stacks_((intervals - 1) * stack_size()),
      diagonals_((intervals - 1) * size),
      reflection_factors_((intervals - 1) * size),
      sums_(width()),
      end_(2 * size + parameters),
      end_rows_(2 * size + parameters),
      end_columns_(2 * size + parameters),
      end_values_(2 * size + parameters),
      pair_(2 * size) {}

/// The equations of a stiff interval may be larger than those of its neighbours by many digits, which reflections
/// would mix.
template <class Number>
void AlmostBlockDiagonal<Number>::scale_rows(std::size_t interval) {
  for (std::size_t i = 0; i < n_; ++i) {
    const std::span<Number> of_left = left(interval).subspan(i * n_, n_),
                            of_right = right(interval).subspan(i * n_, n_);
    const double scale = 1 / std::max(greatest_or_one<Number>(of_left), greatest_or_one<Number>(of_right));
    row_scales_[interval * n_ + i] = scale;
    for (Number& entry : of_left) entry *= scale;
    for (Number& entry : of_right) entry *= scale;
    for (Number& entry : border(interval).subspan(i * k_, k_)) entry *= scale;
  }
}

template <class Number>
void AlmostBlockDiagonal<Number>::begin_elimination() {
  const std::size_t w = 2 * n_ + k_;
  for (std::size_t i = 0; i < n_; ++i) {
    Number* const row = carried_.data() + i * w;
    std::copy_n(right(0).data() + i * n_, n_, row);
    std::copy_n(left(0).data() + i * n_, n_, row + n_);
    std::copy_n(border(0).data() + i * k_, k_, row + 2 * n_);
  }
}

/// What is carried, above the equations of the interval that begins with the node.
template <class Number>
void AlmostBlockDiagonal<Number>::stack(std::size_t interval) {
  const std::size_t w = width(), w_carried = 2 * n_ + k_;
  Number* const rows = stacks_.data() + (interval - 1) * stack_size();
  for (std::size_t i = 0; i < n_; ++i) {
    Number* const upper = rows + i * w;
    const Number* const carried = carried_.data() + i * w_carried;
    std::copy_n(carried, n_, upper);
    std::fill_n(upper + n_, n_, Number{});
    std::copy_n(carried + n_, n_ + k_, upper + 2 * n_);
    Number* const lower = rows + (n_ + i) * w;
    std::copy_n(left(interval).data() + i * n_, n_, lower);
    std::copy_n(right(interval).data() + i * n_, n_, lower + n_);
    std::fill_n(lower + 2 * n_, n_, Number{});
    std::copy_n(border(interval).data() + i * k_, k_, lower + 3 * n_);
  }
}

/// Householder's reflections make the columns of the node zero below its n rows; what is left below is carried on.
template <class Number>
bool AlmostBlockDiagonal<Number>::reflect(std::size_t interval) {
  const std::size_t w = width(), rows = 2 * n_, w_carried = 2 * n_ + k_;
  Number* const a = stacks_.data() + (interval - 1) * stack_size();
  for (std::size_t c = 0; c < n_; ++c) {
    double square = 0;
    for (std::size_t r = c; r < rows; ++r) square += squared_size(a[r * w + c]);
    const double norm = std::sqrt(square), of_pivot = std::sqrt(squared_size(a[c * w + c]));
    if (!(norm > 0) || !std::isfinite(norm)) return false;
    const Number phase = of_pivot > 0 ? a[c * w + c] * (1 / of_pivot) : Number(1);
    a[c * w + c] += phase * norm;
    diagonals_[(interval - 1) * n_ + c] = reciprocal(-(phase * norm));
    const double factor = 1 / (norm * (norm + of_pivot));
    reflection_factors_[(interval - 1) * n_ + c] = factor;
    std::fill(sums_.begin(), sums_.end(), Number{});
    for (std::size_t r = c; r < rows; ++r) {
      const Number v = conjugate(a[r * w + c]);
      const Number* const row = a + r * w;
      for (std::size_t j = c + 1; j < w; ++j) sums_[j] += v * row[j];
    }
    for (std::size_t r = c; r < rows; ++r) {
      const Number v = a[r * w + c] * factor;
      Number* const row = a + r * w;
      for (std::size_t j = c + 1; j < w; ++j) row[j] -= v * sums_[j];
    }
  }
  for (std::size_t i = 0; i < n_; ++i) std::copy_n(a + (n_ + i) * w + n_, w_carried, carried_.data() + i * w_carried);
  return true;
}

/// The equations that are left: in the last node, the first and the parameters.
template <class Number>
bool AlmostBlockDiagonal<Number>::factor_end() {
  const std::size_t size = 2 * n_ + k_, conditions = n_ + k_;
  auto& a = end_.matrix();
  std::ranges::copy(carried_, a.begin());
  for (std::size_t i = 0; i < conditions; ++i) {
    Number* const row = a.data() + (n_ + i) * size;
    std::copy_n(last_.data() + i * n_, n_, row);
    std::copy_n(first_.data() + i * n_, n_, row + n_);
    std::copy_n(parameter_.data() + i * k_, k_, row + 2 * n_);
  }
  std::ranges::fill(end_columns_, 0.0);
  for (std::size_t i = 0; i < size; ++i) {
    const std::span row(a.data() + i * size, size);
    end_rows_[i] = 1 / greatest_or_one<Number>(row);
    for (std::size_t j = 0; j < size; ++j) {
      row[j] *= end_rows_[i];
      end_columns_[j] = std::max(end_columns_[j], magnitude(row[j]));
    }
  }
  for (double& scale : end_columns_) scale = scale > 0 ? 1 / scale : 1;
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) a[i * size + j] *= end_columns_[j];
  if (!end_.factor()) return false;
  // All entries are of size 1 at most, so a pivot of the size of their rounding is none. The diagonal holds inverses.
  const double least = 4 * std::numeric_limits<double>::epsilon() * static_cast<double>(size);
  for (std::size_t i = 0; i < size; ++i)
    if (!(magnitude(a[i * size + i]) * least < 1)) return false;
  return true;
}

template <class Number>
bool AlmostBlockDiagonal<Number>::factor() {
  for (std::size_t i = 0; i < intervals_; ++i) scale_rows(i);
  begin_elimination();
  for (std::size_t i = 1; i < intervals_; ++i) {
    stack(i);
    if (!reflect(i)) return false;
  }
  return factor_end();
}

template <class Number>
void AlmostBlockDiagonal<Number>::solve(std::span<Number> b) {
  const std::size_t w = width();
  for (std::size_t i = 0; i < row_scales_.size(); ++i) b[i] *= row_scales_[i];
  // The right-hand sides carried are kept in the rows of the interval that they have been carried over.
  for (std::size_t node = 1; node < intervals_; ++node) {
    const Number* const a = stacks_.data() + (node - 1) * stack_size();
    Number* const rows = b.data() + (node - 1) * n_;  // of this interval and the next: 2n numbers
    for (std::size_t c = 0; c < n_; ++c) {
      Number sum{};
      for (std::size_t r = c; r < 2 * n_; ++r) sum += conjugate(a[r * w + c]) * rows[r];
      sum *= reflection_factors_[(node - 1) * n_ + c];
      for (std::size_t r = c; r < 2 * n_; ++r) rows[r] -= a[r * w + c] * sum;
    }
  }
  const std::size_t end = (intervals_ - 1) * n_, size = 2 * n_ + k_;
  for (std::size_t i = 0; i < size; ++i) end_values_[i] = b[end + i] * end_rows_[i];
  end_.solve(end_values_.data());
  for (std::size_t i = 0; i < size; ++i) end_values_[i] *= end_columns_[i];
  const Number* const at_first = end_values_.data() + n_;
  std::copy_n(end_values_.data(), n_, b.data() + intervals_ * n_);
  for (std::size_t node = intervals_; node-- > 1;) {
    const Number* const a = stacks_.data() + (node - 1) * stack_size();
    Number* const right_side = b.data() + (node - 1) * n_;
    Number* const y = b.data() + node * n_;
    const Number* const next = y + n_;
    for (std::size_t i = n_; i-- > 0;) {
      const Number* const row = a + i * w;
      Number sum = right_side[i];
      for (std::size_t j = i + 1; j < n_; ++j) sum -= row[j] * y[j];
      for (std::size_t j = 0; j < n_; ++j) sum -= row[n_ + j] * next[j];
      for (std::size_t j = 0; j < n_ + k_; ++j) sum -= row[2 * n_ + j] * at_first[j];
      y[i] = sum * diagonals_[(node - 1) * n_ + i];
    }
  }
  std::copy_n(at_first, n_, b.data());
  std::copy_n(end_values_.data() + 2 * n_, k_, b.data() + (intervals_ + 1) * n_);
}

template class AlmostBlockDiagonal<double>;
template class AlmostBlockDiagonal<ComplexNumber<double>>;

}  // namespace continuo::boundary
