// The functions of a two-point problem at many points, with the singular term and with derivatives by differences.
// Internal to two_point.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/boundary/two_point.hpp>

namespace continuo::boundary {

/// df/dy of each point, row by row, and df/dp likewise.
template <class Number>
struct PointJacobians {
  std::vector<Number> by_y, by_p;
};

/// Derivatives of the conditions, row by row, and where they were taken.
template <class Number>
struct ConditionJacobians {
  std::vector<Number> first, last, by_p;
  std::vector<Number> arguments;  // y at both ends and p
  std::vector<Number> residuals;  // there
};

/// y and f are given component by component, as the problem's functions take them: y_i of point q at i * count + q.
template <class Number>
class TwoPointFunctions {
 public:
  /// `start` is a, where the singular term is.
  TwoPointFunctions(const TwoPointProblem<Number>& problem, double start);

  /// The number of equations.
  [[nodiscard]] std::size_t size() const { return problem_.size; }
  /// The number of unknown parameters.
  [[nodiscard]] std::size_t parameters() const { return problem_.parameters; }
  /// f, with the singular term, at the points x.
  void derivative(std::span<const double> x, std::span<const Number> y, std::span<const Number> p, std::span<Number> f);
  /// The same at those points alone where f is missing.
  void derivative_where(const std::vector<char>& is_missing, std::span<const double> x, std::span<const Number> y,
                        std::span<const Number> p, std::span<Number> f);
  /// Its derivatives at the points x, where it is f. The points are those of a mesh and the middles between them, or
  /// some of them where points do not depend on each other. f is written where it is missing: differences come with it
  /// in one call. `is_missing` is empty where it is at no point.
  void jacobians(std::span<const double> x, std::span<const Number> y, std::span<const Number> p, std::span<Number> f,
                 const std::vector<char>& is_missing, PointJacobians<Number>& result);
  /// Whether derivatives are differences that are taken at all points in one call.
  [[nodiscard]] bool takes_differences() const { return !problem_.derivative_jacobian && points_are_independent_; }
  /// The residuals of the conditions.
  void conditions(std::span<const Number> y_first, std::span<const Number> y_last, std::span<const Number> p,
                  std::span<Number> residuals) const {
    problem_.conditions(y_first, y_last, p, residuals);
  }
  /// Their derivatives, where they are `residuals`.
  const ConditionJacobians<Number>& condition_jacobians(std::span<const Number> y_first, std::span<const Number> y_last,
                                                        std::span<const Number> p, std::span<const Number> residuals);
  /// Whether what f is at a point does not depend on the other ones, as far as seen.
  [[nodiscard]] bool points_are_independent() const { return points_are_independent_; }
  /// Makes y(a) one that the singular term allows.
  void restrict_first(std::span<Number> y_first) const;

 private:
  using Numbers = std::span<const Number>;
  void add_singular_term(std::span<const double> x, Numbers y, std::span<Number> f) const;
  void given_jacobians(std::span<const double> x, Numbers y, Numbers p, PointJacobians<Number>& result);
  bool jacobians_at_once(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f,
                         const std::vector<char>& is_missing, std::vector<Number>& by_y);
  void jacobians_by_component(std::span<const double> x, Numbers y, Numbers p, Numbers f, std::vector<Number>& by_y);
  void derivative_on_mesh(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f);
  [[nodiscard]] bool foretold(Numbers arguments, Numbers residuals) const;
  void condition_differences(Numbers arguments, Numbers residuals);
  void parameter_jacobians(std::span<const double> x, Numbers y, Numbers p, Numbers f, std::vector<Number>& by_p);

  const TwoPointProblem<Number>& problem_;
  double start_;
  std::vector<Number> first_value_, first_derivative_;  // I - S^+ S and (I - S)^+; empty without S
  bool points_are_independent_ = true, points_were_compared_ = false;
  ConditionJacobians<Number> condition_jacobians_;
  struct {
    std::vector<std::size_t> begin;  // of the copies of each point
    std::vector<double> x;
    std::vector<Number> y, f;
  } displaced_;  // the points of differences, kept as memory for the next ones
};

extern template class TwoPointFunctions<double>;
extern template class TwoPointFunctions<ComplexNumber<double>>;

}  // namespace continuo::boundary
