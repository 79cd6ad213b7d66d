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

/// z / |z|, 1 for 0.
/// @{
double phase_of(double x, double) {
  return std::copysign(1.0, x);
}
ComplexNumber<double> phase_of(const ComplexNumber<double>& z, double size) {
  return size > 0 ? z * (1 / size) : ComplexNumber<double>(1);
}
/// @}

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

/// Calls `visit` with the numbers of components and parameters where these are common ones, so that the compiler knows
/// how long the loops are: those of a system of two or three equations are too short to be counted.
template <class Number>
template <class Visit>
decltype(auto) AlmostBlockDiagonal<Number>::with_size(const Visit& visit) {
  switch (n_) {
    case 2:
      if (k_ == 0) return visit.template operator()<2, 0>();
      if (k_ == 1) return visit.template operator()<2, 1>();
      return visit.template operator()<2, run_time_size>();
    case 3:
      return visit.template operator()<3, run_time_size>();
    case 4:
      return visit.template operator()<4, run_time_size>();
    default:
      return visit.template operator()<run_time_size, run_time_size>();
  }
}

/// The equations of a stiff interval may be larger than those of its neighbours by many digits, which reflections
/// would mix.
template <class Number>
template <std::size_t N, std::size_t K>
void AlmostBlockDiagonal<Number>::scale_rows(std::size_t interval) {
  const std::size_t n = size<N>(), k = parameters<K>();
  for (std::size_t i = interval * n; i < (interval + 1) * n; ++i) {
    Number* const of_left = left_.data() + i * n;
    Number* const of_right = right_.data() + i * n;
    double greatest = 0;
    for (std::size_t j = 0; j < n; ++j) greatest = std::max({greatest, magnitude(of_left[j]), magnitude(of_right[j])});
    const double scale = greatest > 0 ? 1 / greatest : 1;
    row_scales_[i] = scale;
    for (std::size_t j = 0; j < n; ++j) of_left[j] *= scale, of_right[j] *= scale;
    for (std::size_t j = 0; j < k; ++j) border_[i * k + j] *= scale;
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
template <std::size_t N, std::size_t K>
void AlmostBlockDiagonal<Number>::stack(std::size_t interval) {
  const std::size_t n = size<N>(), k = parameters<K>(), w = 3 * n + k, w_carried = w - n;
  Number* const rows = stacks_.data() + (interval - 1) * 2 * n * w;
  for (std::size_t i = 0; i < n; ++i) {
    Number* const upper = rows + i * w;
    const Number* const carried = carried_.data() + i * w_carried;
    std::copy_n(carried, n, upper);
    std::fill_n(upper + n, n, Number{});
    std::copy_n(carried + n, n + k, upper + 2 * n);
    Number* const lower = rows + (n + i) * w;
    std::copy_n(left_.data() + (interval * n + i) * n, n, lower);
    std::copy_n(right_.data() + (interval * n + i) * n, n, lower + n);
    std::fill_n(lower + 2 * n, n, Number{});
    std::copy_n(border_.data() + (interval * n + i) * k, k, lower + 3 * n);
  }
}

/// (I - factor v v^H) of the columns beyond c, of which v is what is on and below the diagonal.
template <class Number>
template <std::size_t N, std::size_t K>
void AlmostBlockDiagonal<Number>::reflect_columns(Number* a, std::size_t c, double factor) {
  const std::size_t rows = 2 * size<N>(), w = 3 * size<N>() + parameters<K>();
  if constexpr (N == 2) {  // so few rows that a column stays in registers
    for (std::size_t j = c + 1; j < w; ++j) {
      Number sum{};
      for (std::size_t r = c; r < rows; ++r) sum += conjugate(a[r * w + c]) * a[r * w + j];
      sum *= factor;
      for (std::size_t r = c; r < rows; ++r) a[r * w + j] -= a[r * w + c] * sum;
    }
    return;
  }
  Number* const sums = sums_.data();
  for (std::size_t j = c + 1; j < w; ++j) sums[j] = Number{};
  for (std::size_t r = c; r < rows; ++r) {
    const Number v = conjugate(a[r * w + c]);
    const Number* const row = a + r * w;
    for (std::size_t j = c + 1; j < w; ++j) sums[j] += v * row[j];
  }
  for (std::size_t r = c; r < rows; ++r) {
    const Number v = a[r * w + c] * factor;
    Number* const row = a + r * w;
    for (std::size_t j = c + 1; j < w; ++j) row[j] -= v * sums[j];
  }
}

/// Householder's reflections make the columns of the node zero below its n rows; what is left below is carried on.
template <class Number>
template <std::size_t N, std::size_t K>
bool AlmostBlockDiagonal<Number>::reflect(std::size_t interval) {
  const std::size_t n = size<N>(), rows = 2 * n, w = 3 * n + parameters<K>(), w_carried = w - n;
  Number* const a = stacks_.data() + (interval - 1) * rows * w;
#pragma GCC unroll 4
  for (std::size_t c = 0; c < n; ++c) {
    double square = 0;
    for (std::size_t r = c; r < rows; ++r) square += squared_size(a[r * w + c]);
    const double norm = std::sqrt(square), of_pivot = size_of(a[c * w + c]);
    if (!(norm > 0) || !std::isfinite(norm)) return false;
    const Number shift = phase_of(a[c * w + c], of_pivot) * norm;
    a[c * w + c] += shift;
    diagonals_[(interval - 1) * n + c] = reciprocal(-shift);
    const double factor = 1 / (norm * (norm + of_pivot));
    reflection_factors_[(interval - 1) * n + c] = factor;
    reflect_columns<N, K>(a, c, factor);
  }
  for (std::size_t i = 0; i < n; ++i) std::copy_n(a + (n + i) * w + n, w_carried, carried_.data() + i * w_carried);
  return true;
}

template <class Number>
template <std::size_t N, std::size_t K>
bool AlmostBlockDiagonal<Number>::eliminate() {
  for (std::size_t i = 0; i < intervals_; ++i) scale_rows<N, K>(i);
  begin_elimination();
  for (std::size_t i = 1; i < intervals_; ++i) {
    stack<N, K>(i);
    if (!reflect<N, K>(i)) return false;
  }
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
  return with_size([this]<std::size_t N, std::size_t K>() { return this->template eliminate<N, K>(); }) && factor_end();
}

/// The right-hand sides carried are kept in the rows of the interval that they have been carried over.
template <class Number>
template <std::size_t N, std::size_t K>
void AlmostBlockDiagonal<Number>::carry_right_side(std::span<Number> b) const {
  const std::size_t n = size<N>(), w = 3 * n + parameters<K>();
  for (std::size_t node = 1; node < intervals_; ++node) {
    const Number* const a = stacks_.data() + (node - 1) * 2 * n * w;
    Number* const rows = b.data() + (node - 1) * n;  // of this interval and the next: 2n numbers
    for (std::size_t c = 0; c < n; ++c) {
      Number sum{};
      for (std::size_t r = c; r < 2 * n; ++r) sum += conjugate(a[r * w + c]) * rows[r];
      sum *= reflection_factors_[(node - 1) * n + c];
      for (std::size_t r = c; r < 2 * n; ++r) rows[r] -= a[r * w + c] * sum;
    }
  }
}

/// Backwards from the last node, whose numbers b holds, with those of the first and the parameters.
template <class Number>
template <std::size_t N, std::size_t K>
void AlmostBlockDiagonal<Number>::substitute(std::span<Number> b) const {
  const std::size_t n = size<N>(), k = parameters<K>(), w = 3 * n + k;
  const Number* const at_first = end_values_.data() + n;
  for (std::size_t node = intervals_; node-- > 1;) {
    const Number* const a = stacks_.data() + (node - 1) * 2 * n * w;
    const Number* const right_side = b.data() + (node - 1) * n;
    Number* const y = b.data() + node * n;
    const Number* const next = y + n;
    for (std::size_t i = n; i-- > 0;) {
      const Number* const row = a + i * w;
      Number sum = right_side[i];
      for (std::size_t j = i + 1; j < n; ++j) sum -= row[j] * y[j];
      for (std::size_t j = 0; j < n; ++j) sum -= row[n + j] * next[j];
      for (std::size_t j = 0; j < n + k; ++j) sum -= row[2 * n + j] * at_first[j];
      y[i] = sum * diagonals_[(node - 1) * n + i];
    }
  }
}

template <class Number>
void AlmostBlockDiagonal<Number>::solve(std::span<Number> b) {
  for (std::size_t i = 0; i < row_scales_.size(); ++i) b[i] *= row_scales_[i];
  with_size([this, b]<std::size_t N, std::size_t K>() { this->template carry_right_side<N, K>(b); });
  const std::size_t end = (intervals_ - 1) * n_, size = 2 * n_ + k_;
  for (std::size_t i = 0; i < size; ++i) end_values_[i] = b[end + i] * end_rows_[i];
  end_.solve(end_values_.data());
  for (std::size_t i = 0; i < size; ++i) end_values_[i] *= end_columns_[i];
  std::copy_n(end_values_.data(), n_, b.data() + intervals_ * n_);
  with_size([this, b]<std::size_t N, std::size_t K>() { this->template substitute<N, K>(b); });
  std::copy_n(end_values_.data() + n_, n_, b.data());
  std::copy_n(end_values_.data() + 2 * n_, k_, b.data() + (intervals_ + 1) * n_);
}

template class AlmostBlockDiagonal<double>;
template class AlmostBlockDiagonal<ComplexNumber<double>>;

}  // namespace continuo::boundary
