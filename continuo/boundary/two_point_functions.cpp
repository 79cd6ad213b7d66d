// Calls with as many points as there are, and differences of all components in one call.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/boundary/number_size.hpp>
#include <continuo/boundary/singular_values.hpp>
#include <continuo/boundary/two_point_functions.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t most_numbers_at_once = 1 << 18;  // of y in one call for differences: 2 MB

/// The displacement of a forward difference.
template <class Number>
Number displaced(const Number& value) {
  return value + Number(std::sqrt(std::numeric_limits<double>::epsilon()) * (1 + size_of(value)));
}

/// to(j, i) = from(i, j).
template <class Number>
void transpose(std::span<const Number> from, std::size_t rows, std::span<Number> to) {
  const std::size_t columns = from.size() / rows;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) to[j * rows + i] = from[i * columns + j];
}

/// x = M x, for a small square M.
template <class Number>
void multiply(const std::vector<Number>& matrix, std::span<Number> x, std::size_t stride = 1) {
  const std::size_t n = (x.size() + stride - 1) / stride;
  std::vector<Number> product(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) product[i] += matrix[i * n + j] * x[j * stride];
  for (std::size_t i = 0; i < n; ++i) x[i * stride] = product[i];
}

}  // namespace

template <class Number>
TwoPointFunctions<Number>::TwoPointFunctions(const TwoPointProblem<Number>& problem, double start)
    : problem_(problem), start_(start) {
  const std::vector<Number>& term = problem.singular_term;
  if (term.empty()) return;
  first_value_ = SingularValues<Number>(term, size()).null_projector();
  std::vector<Number> rest(term.size());
  for (std::size_t e = 0; e < term.size(); ++e) rest[e] = Number(e % (size() + 1) == 0 ? 1.0 : 0.0) - term[e];
  first_derivative_ = SingularValues<Number>(rest, size()).pseudo_inverse();
}

/// S y / (x - a) is added, in the order of the components; at a the slope is (I - S)^+ f.
template <class Number>
void TwoPointFunctions<Number>::add_singular_term(std::span<const double> x, Numbers y, std::span<Number> f) const {
  const std::size_t n = size(), count = x.size();
  for (std::size_t q = 0; q < count; ++q) {
    if (x[q] == start_) {
      multiply(first_derivative_, f.subspan(q, (n - 1) * count + 1), count);
      continue;
    }
    const double factor = 1 / (x[q] - start_);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        f[i * count + q] += problem_.singular_term[i * n + j] * y[j * count + q] * factor;
  }
}

template <class Number>
void TwoPointFunctions<Number>::derivative(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f) {
  problem_.derivative(x, y, p, f);
  if (!problem_.singular_term.empty()) add_singular_term(x, y, f);
}

/// At the nodes and at the middles, by a call for each.
template <class Number>
void TwoPointFunctions<Number>::derivative_on_mesh(std::span<const double> x, Numbers y, Numbers p,
                                                   std::span<Number> f) {
  const std::size_t n = size(), count = x.size();
  for (std::size_t first = 0; first < 2; ++first) {
    const std::size_t some = (count - first + 1) / 2;
    std::vector<double> some_x(some);
    std::vector<Number> some_y(n * some), some_f(n * some);
    for (std::size_t q = 0; q < some; ++q) some_x[q] = x[2 * q + first];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t q = 0; q < some; ++q) some_y[i * some + q] = y[i * count + 2 * q + first];
    derivative(some_x, some_y, p, some_f);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t q = 0; q < some; ++q) f[i * count + 2 * q + first] = some_f[i * some + q];
  }
}

/// Each point once for each component, displaced; and before these as it is, where f is not known there, and elsewhere
/// where that costs little and at first: where f then differs from what it was in other company, its points depend on
/// each other, and only calls as those for the equations will do. False then.
template <class Number>
bool TwoPointFunctions<Number>::jacobians_at_once(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f,
                                                  const std::vector<char>& is_missing_at, std::vector<Number>& by_y) {
  constexpr double rounding = 1e-10;
  constexpr std::size_t few_points = 128;
  const std::size_t n = size(), points = x.size();
  const bool compares = !points_were_compared_ || points <= few_points;
  const auto is_missing = [&](std::size_t q) { return !is_missing_at.empty() && is_missing_at[q]; };
  const std::size_t chunk = std::max<std::size_t>(1, most_numbers_at_once / (n * (n + 1)));
  double greatest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t q = 0; q < points; ++q)
      if (!is_missing(q)) greatest = std::max(greatest, size_of(f[i * points + q]));
  auto& [first, all_x, all_y, all_f] = displaced_;
  for (std::size_t begin = 0; begin < points; begin += chunk) {
    const std::size_t count = std::min(chunk, points - begin);
    first.resize(count + 1);
    for (std::size_t q = 0; q < count; ++q) first[q + 1] = first[q] + n + (compares || is_missing(begin + q) ? 1 : 0);
    const std::size_t all = first[count];
    all_x.resize(all), all_y.resize(all * n), all_f.resize(all * n);
    for (std::size_t q = 0; q < count; ++q)
      for (std::size_t c = first[q]; c < first[q + 1]; ++c) all_x[c] = x[begin + q];
    for (std::size_t i = 0; i < n; ++i) {
      const Number* const from = &y[i * points + begin];
      Number* const to = &all_y[i * all];
      for (std::size_t q = 0; q < count; ++q) {
        for (std::size_t c = first[q]; c < first[q + 1]; ++c) to[c] = from[q];
        to[first[q + 1] - n + i] = displaced(from[q]);
      }
    }
    derivative(all_x, all_y, p, all_f);
    for (std::size_t i = 0; i < n; ++i) {
      Number* const before = &f[i * points + begin];
      const Number* const found = &all_f[i * all];
      for (std::size_t q = 0; q < count; ++q) {
        if (is_missing(begin + q)) {
          before[q] = found[first[q]];
        } else if (compares && !(size_of(found[first[q]] - before[q]) <= rounding * greatest)) {
          return false;
        }
      }
      for (std::size_t j = 0; j < n; ++j) {
        const Number* const moved = &all_y[j * all];
        const Number* const unmoved = &y[j * points + begin];
        Number* const to = &by_y[begin * n * n + i * n + j];
        bool finite = true;
        for (std::size_t q = 0; q < count; ++q) {
          const std::size_t copy = first[q + 1] - n + j;
          const Number slope = (found[copy] - before[q]) * reciprocal(moved[copy] - unmoved[q]);
          finite = finite && is_finite(slope);
          to[q * n * n] = slope;
        }
        if (!finite) return false;
      }
    }
  }
  points_were_compared_ = true;
  return true;
}

template <class Number>
void TwoPointFunctions<Number>::derivative_where(const std::vector<char>& is_missing_at, std::span<const double> x,
                                                 Numbers y, Numbers p, std::span<Number> f) {
  std::vector<std::size_t> unknown;
  std::vector<double> some_x;
  for (std::size_t q = 0; q < is_missing_at.size(); ++q)
    if (is_missing_at[q]) unknown.push_back(q), some_x.push_back(x[q]);
  if (unknown.empty()) return;
  std::vector<Number> some_y, some_f(size() * unknown.size());
  for (std::size_t i = 0; i < size(); ++i)
    for (const std::size_t q : unknown) some_y.push_back(y[i * x.size() + q]);
  derivative(some_x, some_y, p, some_f);
  for (std::size_t i = 0, part = 0; i < size(); ++i)
    for (const std::size_t q : unknown) f[i * x.size() + q] = some_f[part++];
}

template <class Number>
void TwoPointFunctions<Number>::jacobians_by_component(std::span<const double> x, Numbers y, Numbers p, Numbers f,
                                                       std::vector<Number>& by_y) {
  const std::size_t n = size(), count = x.size();
  std::vector<Number> moved(y.begin(), y.end()), moved_f(f.size());
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t q = 0; q < count; ++q) moved[j * count + q] = displaced(y[j * count + q]);
    derivative_on_mesh(x, moved, p, moved_f);
    for (std::size_t q = 0; q < count; ++q) {
      const Number inverse = reciprocal(moved[j * count + q] - y[j * count + q]);
      for (std::size_t i = 0; i < n; ++i)
        by_y[(q * n + i) * n + j] = (moved_f[i * count + q] - f[i * count + q]) * inverse;
      moved[j * count + q] = y[j * count + q];
    }
  }
}

template <class Number>
void TwoPointFunctions<Number>::parameter_jacobians(std::span<const double> x, Numbers y, Numbers p, Numbers f,
                                                    std::vector<Number>& by_p) {
  const std::size_t n = size(), k = parameters();
  std::vector<Number> moved(p.begin(), p.end()), moved_f(f.size());
  for (std::size_t l = 0; l < k; ++l) {
    moved[l] = displaced(p[l]);
    if (points_are_independent_) {
      derivative(x, y, moved, moved_f);
    } else {
      derivative_on_mesh(x, y, moved, moved_f);
    }
    const Number inverse = reciprocal(moved[l] - p[l]);
    moved[l] = p[l];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t q = 0; q < x.size(); ++q)
        by_p[(q * n + i) * k + l] = (moved_f[i * x.size() + q] - f[i * x.size() + q]) * inverse;
  }
}

/// From (i, j, q) to point by point; the singular term is added.
template <class Number>
void TwoPointFunctions<Number>::given_jacobians(std::span<const double> x, Numbers y, Numbers p,
                                                PointJacobians<Number>& result) {
  const std::size_t n = size(), k = parameters();
  std::vector<Number> by_y(result.by_y.size()), by_p(result.by_p.size());
  problem_.derivative_jacobian(x, y, p, by_y, by_p);
  transpose<Number>(by_y, n * n, result.by_y);
  if (k > 0) transpose<Number>(by_p, n * k, result.by_p);
  if (problem_.singular_term.empty()) return;
  for (std::size_t q = 0; q < x.size(); ++q) {
    const auto block = std::span(result.by_y).subspan(q * n * n, n * n);
    const auto border = std::span(result.by_p).subspan(q * n * k, n * k);
    if (x[q] == start_) {
      for (std::size_t j = 0; j < n; ++j) multiply(first_derivative_, block.subspan(j, n * n - n + 1), n);
      for (std::size_t l = 0; l < k; ++l) multiply(first_derivative_, border.subspan(l, n * k - k + 1), k);
      continue;
    }
    const double factor = 1 / (x[q] - start_);
    for (std::size_t e = 0; e < n * n; ++e) block[e] += problem_.singular_term[e] * factor;
  }
}

template <class Number>
void TwoPointFunctions<Number>::jacobians(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f,
                                          const std::vector<char>& is_missing_at, PointJacobians<Number>& result) {
  result.by_y.resize(y.size() * size());
  result.by_p.resize(y.size() * parameters());
  if (takes_differences()) points_are_independent_ = jacobians_at_once(x, y, p, f, is_missing_at, result.by_y);
  if (!takes_differences()) derivative_where(is_missing_at, x, y, p, f);
  if (problem_.derivative_jacobian) return given_jacobians(x, y, p, result);
  if (!points_are_independent_) jacobians_by_component(x, y, p, f, result.by_y);
  parameter_jacobians(x, y, p, f, result.by_p);
}

/// Whether the derivatives that are there foretell these residuals: then the conditions are linear as far as seen, as
/// they mostly are, and need not be differenced again.
template <class Number>
bool TwoPointFunctions<Number>::foretold(Numbers arguments, Numbers residuals) const {
  constexpr double enough = 1e-7;
  const ConditionJacobians<Number>& known = condition_jacobians_;
  if (known.arguments.empty()) return false;
  const std::size_t n = size(), k = parameters();
  for (std::size_t i = 0; i < n + k; ++i) {
    Number sum = known.residuals[i];
    double sizes = size_of(sum);
    for (std::size_t j = 0; j < 2 * n + k; ++j) {
      const Number slope = j < n       ? known.first[i * n + j]
                           : j < 2 * n ? known.last[i * n + j - n]
                                       : known.by_p[i * k + j - 2 * n];
      const Number part = slope * (arguments[j] - known.arguments[j]);
      sum += part;
      sizes += size_of(part);
    }
    if (!(size_of(sum - residuals[i]) <= enough * sizes)) return false;
  }
  return true;
}

template <class Number>
void TwoPointFunctions<Number>::condition_differences(Numbers arguments, Numbers residuals) {
  const std::size_t n = size(), k = parameters();
  std::vector<Number> moved(arguments.begin(), arguments.end()), moved_residuals(n + k);
  const auto all = std::span<const Number>(moved);
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const Number before = moved[j];
    moved[j] = displaced(before);
    conditions(all.first(n), all.subspan(n, n), all.subspan(2 * n), moved_residuals);
    const Number inverse = reciprocal(moved[j] - before);
    moved[j] = before;
    for (std::size_t i = 0; i < n + k; ++i) {
      const Number slope = (moved_residuals[i] - residuals[i]) * inverse;
      if (j < n) {
        condition_jacobians_.first[i * n + j] = slope;
      } else if (j < 2 * n) {
        condition_jacobians_.last[i * n + j - n] = slope;
      } else {
        condition_jacobians_.by_p[i * k + j - 2 * n] = slope;
      }
    }
  }
}

template <class Number>
const ConditionJacobians<Number>& TwoPointFunctions<Number>::condition_jacobians(Numbers y_first, Numbers y_last,
                                                                                 Numbers p, Numbers residuals) {
  const std::size_t n = size(), k = parameters(), rows = n + k;
  ConditionJacobians<Number>& result = condition_jacobians_;
  result.first.resize(rows * n), result.last.resize(rows * n), result.by_p.resize(rows * k);
  if (problem_.condition_jacobian) {
    problem_.condition_jacobian(y_first, y_last, p, result.first, result.last, result.by_p);
    return result;
  }
  std::vector<Number> arguments(y_first.begin(), y_first.end());
  arguments.insert(arguments.end(), y_last.begin(), y_last.end());
  arguments.insert(arguments.end(), p.begin(), p.end());
  if (!foretold(arguments, residuals)) {
    condition_differences(arguments, residuals);
    result.arguments = std::move(arguments);
    result.residuals.assign(residuals.begin(), residuals.end());
  }
  return result;
}

template <class Number>
void TwoPointFunctions<Number>::restrict_first(std::span<Number> y_first) const {
  if (!first_value_.empty()) multiply(first_value_, y_first);
}

template class TwoPointFunctions<double>;
template class TwoPointFunctions<ComplexNumber<double>>;

}  // namespace continuo::boundary
