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
constexpr std::size_t few_intervals = 64;   // with three points each a call of f costs little more than with one
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
                                             std::vector<Number> z, KnownSlopes<Number> known)
    : functions_(functions),
      n_(functions.size()),
      k_(functions.parameters()),
      x_(x),
      z_(std::move(z)),
      trial_(z_.size()),
      y_((2 * x.size() - 1) * n_),
      f_(std::move(known.f)),
      equations_(z_.size()),
      correction_(z_.size()),
      matrix_(n_, k_, x.size() - 1) {
  for (std::size_t k = 0; k < intervals(); ++k) {
    points_.push_back(x[k]);
    points_.push_back(x[k] + 0.5 * length(k));
  }
  points_.push_back(x.back());
  f_.resize(y_.size());
  known.is_known.resize(points_.size());
  evaluate_unknown(known.is_known);
}

template <class Number>
void TwoPointEquations<Number>::set_nodes(const std::vector<Number>& z) {
  for (std::size_t k = 0; k < nodes(); ++k) std::ranges::copy(at(z, k), at(y_, 2 * k).begin());
}

/// y in the middles, of the spline.
template <class Number>
void TwoPointEquations<Number>::set_middles() {
  for (std::size_t k = 0; k < intervals(); ++k) {
    const auto first = at(y_, 2 * k), last = at(y_, 2 * k + 2), middle = at(y_, 2 * k + 1);
    const auto f_first = at(f_, 2 * k), f_last = at(f_, 2 * k + 2);
    for (std::size_t i = 0; i < n_; ++i)
      middle[i] = (first[i] + last[i]) * 0.5 - (f_last[i] - f_first[i]) * (0.125 * length(k));
  }
}

/// The points of Lobatto's quadrature with five points that are neither ends nor middles.
template <class Number>
void TwoPointEquations<Number>::set_residual_points() {
  const double from_middle = 0.5 * std::sqrt(3.0 / 7);
  residual_x_.clear();
  residual_y_.resize(2 * intervals() * n_), residual_yp_.resize(residual_y_.size());
  for (std::size_t k = 0; k < intervals(); ++k) {
    for (const double theta : {0.5 - from_middle, 0.5 + from_middle}) {
      const std::size_t point = residual_x_.size();
      residual_x_.push_back(x_[k] + theta * length(k));
      for (std::size_t i = 0; i < n_; ++i)
        std::tie(at(residual_y_, point)[i], at(residual_yp_, point)[i]) =
            value_and_slope(spline(k, i), theta * length(k));
    }
  }
}

template <class Number>
void TwoPointEquations<Number>::add_point(double x, std::span<const Number> y) {
  part_x_.push_back(x);
  part_y_.insert(part_y_.end(), y.begin(), y.end());
}

/// f at the points added.
template <class Number>
void TwoPointEquations<Number>::evaluate_points(std::span<const Number> p) {
  part_f_.resize(part_y_.size());
  if (!part_x_.empty()) functions_.derivative(part_x_, part_y_, p, part_f_);
}

/// Where f is not known already. Two calls: in the middles y follows from the slopes at the nodes.
template <class Number>
void TwoPointEquations<Number>::evaluate_unknown(const std::vector<bool>& is_known) {
  set_nodes(z_);
  for (std::size_t first = 0; first < 2; ++first) {
    if (first == 1) set_middles();
    begin_points();
    for (std::size_t q = first; q < points_.size(); q += 2)
      if (!is_known[q]) add_point(points_[q], at(y_, q));
    evaluate_points(p());
    for (std::size_t q = first, part = 0; q < points_.size(); q += 2)
      if (!is_known[q]) std::ranges::copy(at(part_f_, part++), at(f_, q).begin());
  }
  evaluate_equations(z_);
}

/// f everywhere, for the unknowns z. Where points are few, those of the residual are taken along: that saves a call at
/// the end.
template <class Number>
void TwoPointEquations<Number>::evaluate(const std::vector<Number>& z) {
  const auto p = std::span(z).subspan(nodes() * n_);
  set_nodes(z);
  begin_points();
  for (std::size_t k = 0; k < nodes(); ++k) add_point(x_[k], at(y_, 2 * k));
  evaluate_points(p);
  for (std::size_t k = 0; k < nodes(); ++k) std::ranges::copy(at(part_f_, k), at(f_, 2 * k).begin());
  set_middles();
  has_residuals_ = intervals() <= few_intervals;
  if (has_residuals_) set_residual_points();
  begin_points();
  for (std::size_t k = 0; k < intervals(); ++k) {
    if (has_residuals_) add_point(residual_x_[2 * k], at(residual_y_, 2 * k));
    add_point(points_[2 * k + 1], at(y_, 2 * k + 1));
    if (has_residuals_) add_point(residual_x_[2 * k + 1], at(residual_y_, 2 * k + 1));
  }
  evaluate_points(p);
  residual_f_.resize(2 * intervals() * n_);
  for (std::size_t k = 0, part = 0; k < intervals(); ++k) {
    if (has_residuals_) std::ranges::copy(at(part_f_, part++), at(residual_f_, 2 * k).begin());
    std::ranges::copy(at(part_f_, part++), at(f_, 2 * k + 1).begin());
    if (has_residuals_) std::ranges::copy(at(part_f_, part++), at(residual_f_, 2 * k + 1).begin());
  }
  evaluate_equations(z);
}

/// What is left of each equation.
template <class Number>
void TwoPointEquations<Number>::evaluate_equations(const std::vector<Number>& z) {
  for (std::size_t k = 0; k < intervals(); ++k) {
    const auto first = at(z, k), last = at(z, k + 1);
    const auto left = at(equations_, k);
    const auto f_first = f_at_node(k), middle = f_in_middle(k), f_last = f_at_node(k + 1);
    for (std::size_t i = 0; i < n_; ++i)
      left[i] = last[i] - first[i] - (f_first[i] + f_last[i] + middle[i] * 4) * (length(k) / 6);
  }
  functions_.conditions(at(z, 0), at(z, intervals()), std::span(z).subspan(nodes() * n_),
                        std::span(equations_).subspan(intervals() * n_));
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

/// False where a derivative is not finite.
template <class Number>
bool TwoPointEquations<Number>::fill_matrix() {
  functions_.jacobians(points_, y_, p(), f_, jacobians_);
  const ConditionJacobians<Number>& of_conditions =
      functions_.condition_jacobians(at(z_, 0), at(z_, intervals()), p(), conditions());
  for (std::size_t k = 0; k < intervals(); ++k) fill_interval(k);
  std::ranges::copy(of_conditions.first, matrix_.first_condition().begin());
  std::ranges::copy(of_conditions.last, matrix_.last_condition().begin());
  std::ranges::copy(of_conditions.by_p, matrix_.parameter_condition().begin());
  const auto finite = [](const std::vector<Number>& numbers) {
    return std::ranges::all_of(numbers, [](const Number& number) { return boundary::is_finite(number); });
  };
  return finite(jacobians_.by_y) && finite(jacobians_.by_p) && finite(of_conditions.first) &&
         finite(of_conditions.last) && finite(of_conditions.by_p);
}

/// The residual in the middle of an interval is 3/2 of what is left of its equation, over h.
template <class Number>
bool TwoPointEquations<Number>::is_solved(double tolerance, double condition_tolerance) const {
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double most = 2.0 / 3 * length(k) * part_of_tolerance * tolerance;
    for (std::size_t i = 0; i < n_; ++i)
      if (!(size_of(equations_[k * n_ + i]) < most * (1 + size_of(f_in_middle(k)[i])))) return false;
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
    if (!fill_matrix()) return NewtonEnding::not_finite;
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

/// By Lobatto's quadrature with five points, at three of which the residual is known: zero at the ends.
template <class Number>
std::vector<double> TwoPointEquations<Number>::residuals() {
  if (!has_residuals_) {
    set_residual_points();
    residual_f_.resize(residual_y_.size());
    functions_.derivative(residual_x_, residual_y_, p(), residual_f_);
  }
  std::vector<double> result(intervals());
  for (std::size_t k = 0; k < intervals(); ++k) {
    double middle = 0, others = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double of_middle = 1.5 * size_of(equations_[k * n_ + i]) / (length(k) * (1 + size_of(f_in_middle(k)[i])));
      middle += of_middle * of_middle;
      for (const std::size_t e : {2 * k * n_ + i, (2 * k + 1) * n_ + i}) {
        const double one = size_of(residual_yp_[e] - residual_f_[e]) / (1 + size_of(residual_f_[e]));
        others += one * one;
      }
    }
    result[k] = std::sqrt(0.5 * (32.0 / 45 * middle + 49.0 / 90 * others));
  }
  return result;
}

/// e' = J e + r, where r is the residual: of each equation the integral of (1 + J (middle - x)) r over its interval is
/// left. Its second part is of the order of the first, as r is nearly odd about the middle. The matrix tells what that
/// makes of the solution, to first order.
template <class Number>
double TwoPointEquations<Number>::relative_error(double tolerance) {
  const double from_middle = 0.5 * std::sqrt(3.0 / 7);
  std::vector<Number>& error = simplified_;
  std::ranges::fill(error, Number{});
  std::vector<Number> first(n_), last(n_);
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double h = length(k);
    const Number* const jacobian = &jacobians_.by_y[(2 * k + 1) * n_ * n_];
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t e = 2 * k * n_ + i;
      first[i] = residual_yp_[e] - residual_f_[e];
      last[i] = residual_yp_[e + n_] - residual_f_[e + n_];
    }
    for (std::size_t i = 0; i < n_; ++i) {
      const Number middle = equations_[k * n_ + i] * 1.5;  // times h
      Number& left = error[k * n_ + i];
      left = middle * (16.0 / 45) + (first[i] + last[i]) * (49.0 / 180 * h);
      for (std::size_t j = 0; j < n_; ++j)
        left += jacobian[i * n_ + j] * (first[j] - last[j]) * (49.0 / 180 * h * from_middle * h);
    }
  }
  matrix_.solve(error);
  double greatest = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    double of_error = 0, of_y = 0, of_f = 0;
    for (std::size_t k = 0; k < nodes(); ++k) {
      of_error = std::max(of_error, size_of(error[k * n_ + i]));
      of_y = std::max(of_y, size_of(z_[k * n_ + i]));
      of_f = std::max(of_f, size_of(f_at_node(k)[i]));
    }
    // y may be zero: then what the residual allowed makes over the interval is no error.
    greatest = std::max(greatest, of_error / (of_y + tolerance * (1 + of_f) * (x_.back() - x_.front())));
  }
  return greatest;
}

template <class Number>
bool TwoPointEquations<Number>::is_finite(TwoPointSolution<Number>& note) const {
  for (std::size_t first = 0; first < 2; ++first) {  // the middles follow from the nodes
    for (std::size_t q = first; q < points_.size(); q += 2) {
      for (std::size_t i = 0; i < n_; ++i) {
        if (boundary::is_finite(at(f_, q)[i])) continue;
        note.not_finite = TwoPointQuantity::derivative, note.component = i, note.where = points_[q];
        return false;
      }
    }
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
