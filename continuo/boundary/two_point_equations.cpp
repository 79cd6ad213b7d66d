// Residuals, matrix and Newton's iteration of collocation at nodes and middles.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <continuo/boundary/number_size.hpp>
#include <continuo/boundary/two_point_equations.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t most_iterations = 8, most_jacobians = 4;  // on one mesh: a finer one helps more
constexpr double least_damping =
    1.0 / 16;                           // a correction so damped is made whether it helps or not, where f has a value
constexpr double least_defined = 1e-4;  // so much of a correction is tried to find a place where f has a value
constexpr double part_of_tolerance = 5e-2;  // which the iteration may leave of the residual

template <class Number>
double squared_size_of(std::span<const Number> numbers) {
  double sum = 0;
  for (const Number& number : numbers) sum += squared_size(number);
  return sum;
}

/// y and y' of a cubic at s.
template <class Number>
std::pair<Number, Number> value_and_slope(const std::array<Number, 4>& c, double s) {
  return {((c[0] * s + c[1]) * s + c[2]) * s + c[3], (c[0] * (3 * s) + c[1] * 2) * s + c[2]};
}

}  // namespace

template <class Number>
TwoPointEquations<Number>::TwoPointEquations(TwoPointFunctions<Number>& functions, std::span<const double> x,
                                             std::vector<Number> z)
    : functions_(functions),
      n_(functions.size()),
      k_(functions.parameters()),
      x_(x),
      z_(std::move(z)),
      trial_(z_.size()),
      y_((2 * x.size() - 1) * n_),
      f_(y_.size()),
      equations_(z_.size()),
      correction_(z_.size()),
      matrix_(n_, k_, x.size() - 1) {
  for (std::size_t k = 0; k < intervals(); ++k) {
    middles_.push_back(x[k] + 0.5 * length(k));
    points_.push_back(x[k]);
    points_.push_back(middles_.back());
  }
  points_.push_back(x.back());
  evaluate(z_);
}

/// f and what is left of each equation where the unknowns are z. Two calls of f: in the middles y follows from the
/// slopes at the nodes.
template <class Number>
void TwoPointEquations<Number>::evaluate(const std::vector<Number>& z) {
  const auto z_all = std::span(z);
  const auto y = z_all.first(nodes() * n_), p = z_all.subspan(nodes() * n_);
  part_f_.resize(y.size());
  functions_.derivative(x_, y, p, part_f_);
  for (std::size_t k = 0; k < nodes(); ++k) {
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(k * n_), n_,
                y_.begin() + static_cast<std::ptrdiff_t>(2 * k * n_));
    std::copy_n(part_f_.begin() + static_cast<std::ptrdiff_t>(k * n_), n_,
                f_.begin() + static_cast<std::ptrdiff_t>(2 * k * n_));
  }
  part_y_.resize(intervals() * n_);
  for (std::size_t k = 0; k < intervals(); ++k)
    for (std::size_t i = 0; i < n_; ++i)
      part_y_[k * n_ + i] = y_[(2 * k + 1) * n_ + i] =
          (y[k * n_ + i] + y[(k + 1) * n_ + i]) * 0.5 - (slope(2 * k + 2, i) - slope(2 * k, i)) * (0.125 * length(k));
  part_f_.resize(intervals() * n_);
  functions_.derivative(middles_, part_y_, p, part_f_);
  for (std::size_t k = 0; k < intervals(); ++k) {
    for (std::size_t i = 0; i < n_; ++i) {
      const Number middle = f_[(2 * k + 1) * n_ + i] = part_f_[k * n_ + i];
      equations_[k * n_ + i] =
          y[(k + 1) * n_ + i] - y[k * n_ + i] - (slope(2 * k, i) + slope(2 * k + 2, i) + middle * 4) * (length(k) / 6);
    }
  }
  functions_.conditions(y.first(n_), y.last(n_), p, std::span(equations_).subspan(intervals() * n_));
}

/// Of y_(i+1) - y_i - h/6 (f_i + 4 f_m + f_(i+1)) with y_m = (y_i + y_(i+1)) / 2 + h/8 (f_i - f_(i+1)).
template <class Number>
void TwoPointEquations<Number>::fill_interval(std::size_t k) {
  const double h = length(k);
  const std::size_t block = n_ * n_, wide = n_ * k_;
  const Number* const first = jacobians_.by_y.data() + 2 * k * block;
  const Number* const middle = first + block;
  const Number* const last = middle + block;
  const auto left = matrix_.left(k), right = matrix_.right(k), border = matrix_.border(k);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) {
      Number by_first{}, by_last{};
      for (std::size_t l = 0; l < n_; ++l) {
        by_first += middle[i * n_ + l] * first[l * n_ + j];
        by_last += middle[i * n_ + l] * last[l * n_ + j];
      }
      const Number twice = middle[i * n_ + j] * 2;
      left[i * n_ + j] = (first[i * n_ + j] + twice) * (-h / 6) - by_first * (h * h / 12);
      right[i * n_ + j] = (last[i * n_ + j] + twice) * (-h / 6) + by_last * (h * h / 12);
    }
    left[i * n_ + i] -= 1;
    right[i * n_ + i] += 1;
  }
  if (k_ == 0) return;
  const Number* const p_first = jacobians_.by_p.data() + 2 * k * wide;
  const Number* const p_middle = p_first + wide;
  const Number* const p_last = p_middle + wide;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < k_; ++j) {
      Number of_middle{};
      for (std::size_t l = 0; l < n_; ++l) of_middle += middle[i * n_ + l] * (p_first[l * k_ + j] - p_last[l * k_ + j]);
      const std::size_t e = i * k_ + j;
      border[e] = (p_first[e] + p_last[e] + (p_middle[e] + of_middle * (h / 8)) * 4) * (-h / 6);
    }
  }
}

template <class Number>
void TwoPointEquations<Number>::fill_matrix() {
  functions_.jacobians(points_, y_, p(), f_, jacobians_);
  functions_.condition_jacobians(y().first(n_), y().last(n_), p(), conditions(), condition_jacobians_);
  for (std::size_t k = 0; k < intervals(); ++k) fill_interval(k);
  std::ranges::copy(condition_jacobians_.first, matrix_.first_condition().begin());
  std::ranges::copy(condition_jacobians_.last, matrix_.last_condition().begin());
  std::ranges::copy(condition_jacobians_.by_p, matrix_.parameter_condition().begin());
}

/// The residual in the middle of an interval is 3/2 of what is left of its equation, over h.
template <class Number>
bool TwoPointEquations<Number>::is_solved(double tolerance, double condition_tolerance) const {
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double most = 2.0 / 3 * length(k) * part_of_tolerance * tolerance;
    for (std::size_t i = 0; i < n_; ++i)
      if (!(size_of(equations_[k * n_ + i]) < most * (1 + size_of(slope(2 * k + 1, i))))) return false;
  }
  return std::ranges::all_of(conditions(), [&](const Number& g) { return size_of(g) < condition_tolerance; });
}

/// Damped by the natural monotonicity test; after a full step the matrix serves once more. U. Ascher, R. Mattheij,
/// R. Russell, "Numerical Solution of Boundary Value Problems for Ordinary Differential Equations" (1995), 8.1.
template <class Number>
NewtonEnding TwoPointEquations<Number>::iterate(double tolerance, double condition_tolerance) {
  constexpr double descent = 0.2;
  std::size_t jacobians = 0;
  bool matrix_serves = false;
  const auto correct = [&]() -> NewtonCorrection {
    if (matrix_serves) {
      correction_.swap(simplified_);
      return squared_size_of<Number>(correction_);
    }
    if (jacobians++ == most_jacobians) return NewtonEnding::too_many;
    fill_matrix();
    const auto finite = [](const std::vector<Number>& numbers) {
      return std::ranges::all_of(numbers, [](const Number& number) { return boundary::is_finite(number); });
    };
    if (!finite(jacobians_.by_y) || !finite(jacobians_.by_p) || !finite(condition_jacobians_.first) ||
        !finite(condition_jacobians_.last) || !finite(condition_jacobians_.by_p))
      return NewtonEnding::not_finite;
    if (!matrix_.factor()) return NewtonEnding::singular;
    correction_ = equations_;
    matrix_.solve(correction_);
    return squared_size_of<Number>(correction_);
  };
  const auto attempt = [&](double part, double cost) {
    for (std::size_t i = 0; i < z_.size(); ++i) trial_[i] = z_[i] - correction_[i] * part;
    functions_.restrict_first(std::span(trial_).first(n_));
    evaluate(trial_);
    simplified_ = equations_;
    matrix_.solve(simplified_);
    const double next = squared_size_of<Number>(simplified_);
    const bool descends = next < (1 - 2 * part * descent) * cost;
    if (!descends && (part > least_damping || !std::isfinite(next))) return NewtonAttempt::refused;
    z_.swap(trial_);
    if (jacobians < most_jacobians && is_solved(tolerance, condition_tolerance)) return NewtonAttempt::solved;
    matrix_serves = part == 1 && jacobians < most_jacobians;
    return NewtonAttempt::taken;
  };
  const NewtonEnding ending =
      damped_newton({.most_iterations = most_iterations, .least_damping = least_defined}, correct, attempt).ending;
  if (ending == NewtonEnding::no_descent) evaluate(z_);
  return ending;
}

template <class Number>
std::vector<Number> TwoPointEquations<Number>::f() const {
  std::vector<Number> result;
  for (std::size_t k = 0; k < nodes(); ++k)
    for (std::size_t i = 0; i < n_; ++i) result.push_back(slope(2 * k, i));
  return result;
}

template <class Number>
std::array<Number, 4> TwoPointEquations<Number>::spline(std::size_t k, std::size_t i) const {
  return cubic(length(k), z_[k * n_ + i], z_[(k + 1) * n_ + i], slope(2 * k, i), slope(2 * k + 2, i));
}

/// By Lobatto's quadrature with five points, at three of which the residual is known: zero at the ends.
template <class Number>
std::vector<double> TwoPointEquations<Number>::residuals() {
  const double from_middle = 0.5 * std::sqrt(3.0 / 7);
  std::vector<double> x;
  std::vector<Number> y(2 * intervals() * n_), slopes(y.size()), f(y.size());
  for (std::size_t k = 0; k < intervals(); ++k) {
    for (const double theta : {0.5 - from_middle, 0.5 + from_middle}) {
      const std::size_t point = x.size() * n_;
      x.push_back(x_[k] + theta * length(k));
      for (std::size_t i = 0; i < n_; ++i)
        std::tie(y[point + i], slopes[point + i]) = value_and_slope(spline(k, i), theta * length(k));
    }
  }
  functions_.derivative(x, y, p(), f);
  std::vector<double> result(intervals());
  for (std::size_t k = 0; k < intervals(); ++k) {
    double middle = 0, others = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double of_middle = 1.5 * size_of(equations_[k * n_ + i]) / (length(k) * (1 + size_of(slope(2 * k + 1, i))));
      middle += of_middle * of_middle;
      for (const std::size_t point : {2 * k, 2 * k + 1}) {
        const double one = size_of(slopes[point * n_ + i] - f[point * n_ + i]) / (1 + size_of(f[point * n_ + i]));
        others += one * one;
      }
    }
    result[k] = std::sqrt(0.5 * (32.0 / 45 * middle + 49.0 / 90 * others));
  }
  return result;
}

template <class Number>
bool TwoPointEquations<Number>::is_finite(TwoPointSolution<Number>& note) const {
  for (std::size_t at = 0; at < f_.size(); ++at) {
    if (boundary::is_finite(f_[at])) continue;
    note.not_finite = TwoPointQuantity::derivative, note.component = at % n_, note.where = points_[at / n_];
    return false;
  }
  for (std::size_t i = 0; i < n_ + k_; ++i) {
    if (boundary::is_finite(conditions()[i])) continue;
    note.not_finite = TwoPointQuantity::conditions, note.component = i;
    return false;
  }
  return true;
}

template class TwoPointEquations<double>;
template class TwoPointEquations<ComplexNumber<double>>;

}  // namespace continuo::boundary
