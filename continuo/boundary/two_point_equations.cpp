// Residuals, matrix and Newton's iteration of collocation at nodes and middles.
#include <algorithm>
#include <cmath>
#include <numeric>
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
constexpr std::size_t few_intervals = 128;  // with three points each a call of f costs little more than with one
constexpr double quadratic = 1e4;  // times what the iteration may leave: one correction mostly leaves less than that
constexpr double part_of_tolerance = 5e-2;  // which the iteration may leave of the residual

template <class Number>
double squared_size_of(std::span<const Number> numbers) {
  double sum = 0;
  for (const Number& number : numbers) sum += squared_size(number);
  return sum;
}

/// Of the residual y' - f, relative to 1 + |f|, of a component at a point.
template <class Number>
double squared_residual(const SplineSamples<Number>& samples, std::size_t e) {
  const double residual = size_of(samples.yp[e] - samples.f[e]) / (1 + size_of(samples.f[e]));
  return residual * residual;
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
      middles_(intervals()),
      node_y_(nodes() * n_),
      node_f_(std::move(known.nodes.f)),
      middle_y_(intervals() * n_),
      middle_f_(std::move(known.middles.f)),
      equations_(z_.size()),
      correction_(z_.size()),
      jacobians_(std::move(known.jacobians)),
      jacobian_is_known_(std::move(known.jacobian_is_known)),
      matrix_(n_, k_, intervals()) {
  for (std::size_t k = 0; k < intervals(); ++k) middles_[k] = x[k] + 0.5 * length(k);
  node_f_.resize(node_y_.size()), middle_f_.resize(middle_y_.size());
  set_nodes(z_);
  if (known.nodes.is_missing.empty()) {
    known.nodes.is_missing.assign(nodes(), true), known.middles.is_missing.assign(intervals(), true);
  }
  functions_.derivative_where(known.nodes.is_missing, x_, node_y_, p(), node_f_);
  set_middles();
  has_jacobians_ = functions_.takes_differences();
  if (has_jacobians_) {
    take_jacobians(known.middles.is_missing);
  } else {
    functions_.derivative_where(known.middles.is_missing, middles_, middle_y_, p(), middle_f_);
  }
  evaluate_equations(z_);
}

template <class Number>
void TwoPointEquations<Number>::set_nodes(const std::vector<Number>& z) {
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t k = 0; k < nodes(); ++k) node_y_[i * nodes() + k] = z[k * n_ + i];
}

/// y in the middles, of the spline.
template <class Number>
void TwoPointEquations<Number>::set_middles() {
  for (std::size_t i = 0; i < n_; ++i) {
    const Number* const y = &node_y_[i * nodes()];
    const Number* const f = &node_f_[i * nodes()];
    Number* const middle = &middle_y_[i * intervals()];
    for (std::size_t k = 0; k < intervals(); ++k)
      middle[k] = (y[k] + y[k + 1]) * 0.5 - (f[k + 1] - f[k]) * (0.125 * length(k));
  }
}

/// At these parts of some intervals; f is not evaluated yet.
template <class Number>
template <std::size_t count>
SplineSamples<Number> TwoPointEquations<Number>::sampled(const std::array<double, count>& thetas,
                                                         std::span<const std::size_t> intervals) const {
  const std::size_t points = count * intervals.size();
  SplineSamples<Number> samples{std::vector<double>(points), std::vector<Number>(points * n_),
                                std::vector<Number>(points * n_), std::vector<Number>(points * n_)};
  double* x = samples.x.data();
  for (const std::size_t k : intervals)
    for (const double theta : thetas) *x++ = x_[k] + theta * length(k);
  for (std::size_t i = 0; i < n_; ++i) {
    Number* y = &samples.y[i * points];
    Number* yp = &samples.yp[i * points];
    for (const std::size_t k : intervals) {
      const std::array<Number, 4> c = spline(k, i);
      for (const double theta : thetas) std::tie(*y++, *yp++) = value_and_slope(c, theta * length(k));
    }
  }
  return samples;
}

/// The points of Lobatto's quadrature with five points that are neither ends nor middles.
template <class Number>
void TwoPointEquations<Number>::set_residual_points() {
  const double from_middle = 0.5 * std::sqrt(3.0 / 7);
  std::vector<std::size_t> all(intervals());
  std::iota(all.begin(), all.end(), std::size_t{0});
  at_residuals_ = sampled(std::array{0.5 - from_middle, 0.5 + from_middle}, all);
}

/// f in the middles and at the points of the residual, in one call.
template <class Number>
void TwoPointEquations<Number>::evaluate_with_residual_points(std::span<const Number> p) {
  set_residual_points();
  const std::size_t points = 3 * intervals();
  std::vector<double> x(points);
  std::vector<Number> y(n_ * points), f(n_ * points);
  auto& [x_others, y_others, yp_others, f_others] = at_residuals_;
  for (std::size_t k = 0; k < intervals(); ++k)
    x[3 * k] = x_others[2 * k], x[3 * k + 1] = middles_[k], x[3 * k + 2] = x_others[2 * k + 1];
  for (std::size_t k = 0; k < n_ * intervals(); ++k)  // of one component after the other
    y[3 * k] = y_others[2 * k], y[3 * k + 1] = middle_y_[k], y[3 * k + 2] = y_others[2 * k + 1];
  functions_.derivative(x, y, p, f);
  for (std::size_t k = 0; k < n_ * intervals(); ++k)
    f_others[2 * k] = f[3 * k], middle_f_[k] = f[3 * k + 1], f_others[2 * k + 1] = f[3 * k + 2];
}

/// f everywhere, for the unknowns z. Two calls: in the middles y follows from the slopes at the nodes. Where points are
/// few, or the equations will be solved, those of the residual are taken along: that saves a call at the end.
template <class Number>
void TwoPointEquations<Number>::evaluate(const std::vector<Number>& z, bool expects_solution) {
  const auto p = std::span(z).subspan(nodes() * n_);
  set_nodes(z);
  functions_.derivative(x_, node_y_, p, node_f_);
  set_middles();
  has_residuals_ = expects_solution || intervals() <= few_intervals;
  if (has_residuals_) {
    evaluate_with_residual_points(p);
  } else {
    functions_.derivative(middles_, middle_y_, p, middle_f_);
  }
  evaluate_equations(z);
}

/// What is left of each equation.
template <class Number>
void TwoPointEquations<Number>::evaluate_equations(const std::vector<Number>& z) {
  for (std::size_t i = 0; i < n_; ++i) {
    const Number* const y = &node_y_[i * nodes()];
    const Number* const f = &node_f_[i * nodes()];
    const Number* const middle = &middle_f_[i * intervals()];
    for (std::size_t k = 0; k < intervals(); ++k)
      equations_[k * n_ + i] = y[k + 1] - y[k] - (f[k] + f[k + 1] + middle[k] * 4) * (length(k) / 6);
  }
  const auto unknowns = std::span(z);
  functions_.conditions(unknowns.first(n_), unknowns.subspan(intervals() * n_, n_), unknowns.subspan(nodes() * n_),
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

/// The derivatives of f at those of the nodes and middles where they are not known; and f in the middles where it is
/// missing, empty for nowhere: there its derivatives are not known either.
template <class Number>
void TwoPointEquations<Number>::take_jacobians(const std::vector<char>& middle_is_missing) {
  const std::size_t points = nodes() + intervals();
  std::vector<std::size_t> unknown;
  for (std::size_t q = 0; q < points; ++q)
    if (jacobian_is_known_.empty() || !jacobian_is_known_[q]) unknown.push_back(q);
  if (unknown.empty()) return;
  const std::size_t count = unknown.size();
  std::vector<double> x(count);
  std::vector<Number> y(count * n_), f(count * n_);
  for (std::size_t u = 0; u < count; ++u) x[u] = unknown[u] % 2 == 0 ? x_[unknown[u] / 2] : middles_[unknown[u] / 2];
  const auto gather = [&](const std::vector<Number>& at_nodes, const std::vector<Number>& in_middles,
                          std::vector<Number>& some) {
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t u = 0; u < count; ++u) {
        const std::size_t k = unknown[u] / 2;
        some[i * count + u] = unknown[u] % 2 == 0 ? at_nodes[i * nodes() + k] : in_middles[i * intervals() + k];
      }
  };
  gather(node_y_, middle_y_, y);
  gather(node_f_, middle_f_, f);
  std::vector<char> is_missing;
  if (!middle_is_missing.empty())
    for (const std::size_t q : unknown) is_missing.push_back(q % 2 == 1 && middle_is_missing[q / 2]);
  PointJacobians<Number> some;
  functions_.jacobians(x, y, p(), f, is_missing, count == points ? jacobians_ : some);
  for (std::size_t u = 0; u < is_missing.size(); ++u)
    for (std::size_t i = 0; is_missing[u] && i < n_; ++i)
      middle_f_[i * intervals() + unknown[u] / 2] = f[i * count + u];
  if (count == points) return;
  const std::size_t block = n_ * n_, border = n_ * k_;
  for (std::size_t u = 0; u < count; ++u) {
    std::copy_n(&some.by_y[u * block], block, &jacobians_.by_y[unknown[u] * block]);
    std::copy_n(some.by_p.data() + u * border, border, jacobians_.by_p.data() + unknown[u] * border);
  }
}

/// False where a derivative is not finite.
template <class Number>
bool TwoPointEquations<Number>::fill_matrix() {
  if (!std::exchange(has_jacobians_, false)) take_jacobians({});
  const auto at_nodes = this->y();
  const ConditionJacobians<Number>& of_conditions =
      functions_.condition_jacobians(at_nodes.first(n_), at_nodes.last(n_), p(), conditions());
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
      if (!(size_of(equations_[k * n_ + i]) < most * (1 + size_of(middle_f_[i * intervals() + k])))) return false;
  }
  return std::ranges::all_of(conditions(), [&](const Number& g) { return size_of(g) < condition_tolerance; });
}

/// A full step by derivatives that were taken, in part, on the mesh before: there is little to correct. Where it does
/// not solve the equations the iteration begins where it was, or where this is better.
template <class Number>
bool TwoPointEquations<Number>::is_solved_by_known(double tolerance, double condition_tolerance) {
  const bool has_correction = fill_matrix() && matrix_.factor();
  jacobian_is_known_.clear();
  if (!has_correction) return false;
  correction_ = equations_;
  matrix_.solve(correction_);
  for (std::size_t i = 0; i < z_.size(); ++i) trial_[i] = z_[i] - correction_[i];
  functions_.restrict_first(std::span(trial_).first(n_));
  evaluate(trial_, true);
  const bool is_solution = is_solved(tolerance, condition_tolerance);
  if (!is_solution) {
    simplified_ = equations_;
    matrix_.solve(simplified_);
    if (!(squared_size_of<Number>(simplified_) < squared_size_of<Number>(correction_))) {
      evaluate(z_);
      return false;
    }
  }
  z_.swap(trial_);
  return is_solution;
}

/// Damped by the natural monotonicity test; after a full step the matrix serves once more. U. Ascher, R. Mattheij,
/// R. Russell, "Numerical Solution of Boundary Value Problems for Ordinary Differential Equations" (1995), 8.1.
template <class Number>
NewtonEnding TwoPointEquations<Number>::iterate(double tolerance, double condition_tolerance) {
  if (!jacobian_is_known_.empty() && is_solved_by_known(tolerance, condition_tolerance)) return NewtonEnding::converged;
  constexpr double descent = 0.2;
  bool expects_solution = is_solved(quadratic * tolerance, quadratic * condition_tolerance);
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
    evaluate(trial_, std::exchange(expects_solution, false));
    if (part == 1 && jacobians < most_jacobians && is_solved(tolerance, condition_tolerance)) {
      z_.swap(trial_);
      return NewtonAttempt::solved;
    }
    simplified_ = equations_;
    matrix_.solve(simplified_);
    const double next = squared_size_of<Number>(simplified_);
    const bool descends = next < (1 - 2 * part * descent) * cost;
    if (!descends && (part > least_damping || !std::isfinite(next))) return NewtonAttempt::refused;
    z_.swap(trial_);
    if (part < 1 && jacobians < most_jacobians && is_solved(tolerance, condition_tolerance))
      return NewtonAttempt::solved;
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
    functions_.derivative(at_residuals_.x, at_residuals_.y, p(), at_residuals_.f);
  }
  middle_squares_.assign(intervals(), 0), other_squares_.assign(intervals(), 0);
  for (std::size_t i = 0; i < n_; ++i) {
    const std::size_t first = i * intervals();
    for (std::size_t k = 0; k < intervals(); ++k) {
      const double one = 1.5 * size_of(equations_[k * n_ + i]) / (length(k) * (1 + size_of(middle_f_[first + k])));
      middle_squares_[k] += one * one;
      for (const std::size_t e : {2 * (first + k), 2 * (first + k) + 1})
        other_squares_[k] += squared_residual(at_residuals_, e);
    }
  }
  std::vector<double> result(intervals());
  for (std::size_t k = 0; k < intervals(); ++k)
    result[k] = std::sqrt(0.5 * (32.0 / 45 * middle_squares_[k] + 49.0 / 90 * other_squares_[k]));
  return result;
}

/// Four points more, such that with the five, which do not know what is between them, polynomials are integrated up to
/// degree 13 (A. S. Kronrod's way, "Nodes and weights of quadrature formulas" (1965)): the nodes and the weights of
/// [-1, 1] solve the equations of the even powers.
template <class Number>
void TwoPointEquations<Number>::refine_residuals(std::vector<double>& residuals, double least) {
  constexpr double inner = 0.5 * 0.34098226591099297, outer = 0.5 * 0.89040552751266879;
  constexpr double of_middle = 0.34376208721036307, of_others = 0.28397877804812111, of_inner = 0.33423373981641768,
                   of_outer = 0.17926269955320736;
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < intervals(); ++k)
    if (residuals[k] > least) some.push_back(k);
  if (some.empty()) return;
  SplineSamples<Number> samples = sampled(std::array{0.5 - outer, 0.5 - inner, 0.5 + inner, 0.5 + outer}, some);
  functions_.derivative(samples.x, samples.y, p(), samples.f);
  const std::size_t points = samples.x.size();
  for (std::size_t s = 0; s < some.size(); ++s) {
    double of_new = 0;
    for (std::size_t e = 4 * s; e < n_ * points; e += points)
      of_new += of_outer * (squared_residual(samples, e) + squared_residual(samples, e + 3)) +
                of_inner * (squared_residual(samples, e + 1) + squared_residual(samples, e + 2));
    const std::size_t k = some[s];
    residuals[k] = std::sqrt(0.5 * (of_middle * middle_squares_[k] + of_others * other_squares_[k] + of_new));
  }
}

/// e' = J e + r, where r is the residual: of each equation the integral of (1 + J (middle - x)) r over its interval is
/// left. Its second part is of the order of the first, as r is nearly odd about the middle. The matrix tells what that
/// makes of the solution, to first order.
template <class Number>
double TwoPointEquations<Number>::relative_error(double tolerance) {
  const double from_middle = 0.5 * std::sqrt(3.0 / 7);
  std::vector<Number>& error = simplified_;
  error.assign(z_.size(), Number{});
  std::vector<Number> first(n_), last(n_);
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double h = length(k);
    const Number* const jacobian = &jacobians_.by_y[(2 * k + 1) * n_ * n_];
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t e = 2 * (i * intervals() + k);
      first[i] = at_residuals_.yp[e] - at_residuals_.f[e];
      last[i] = at_residuals_.yp[e + 1] - at_residuals_.f[e + 1];
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
      of_f = std::max(of_f, size_of(node_f_[i * nodes() + k]));
    }
    // y may be zero: then what the residual allowed makes over the interval is no error.
    greatest = std::max(greatest, of_error / (of_y + tolerance * (1 + of_f) * (x_.back() - x_.front())));
  }
  return greatest;
}

template <class Number>
bool TwoPointEquations<Number>::is_finite(TwoPointSolution<Number>& note) const {
  const auto find = [&](std::span<const double> x, const std::vector<Number>& f) {
    const auto strange = std::ranges::find_if_not(f, [](const Number& one) { return boundary::is_finite(one); });
    if (strange == f.end()) return true;
    const auto where = static_cast<std::size_t>(strange - f.begin());
    note.not_finite = TwoPointQuantity::derivative, note.component = where / x.size(), note.where = x[where % x.size()];
    return false;
  };
  if (!find(x_, node_f_) || !find(middles_, middle_f_)) return false;  // the middles follow from the nodes
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
