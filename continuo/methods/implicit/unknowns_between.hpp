// How far the unknowns of algebraic equations are off between the ends of a step. A stiffly accurate method has them
// exact at its end, and so has its embedded solution: their difference says nothing of them, h grows without bound
// beside a state that hardly moves, and the peak of a rectifier is jumped over. What remains of their equations on the
// dense output, inside of the step, says how well the step has seen them move; a Newton correction gives it the size of
// an error. (Of collocation and multistep methods the predictor does that; W. H. Enright, "A new error control for
// initial value solvers", Appl. Math. Comput. 31 (1989), controls the whole defect so.)
#pragma once
#include <cmath>
#include <cstddef>
#include <optional>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>

namespace continuo {

/// For the method M.
template <class M, State X>
class UnknownsBetween {
 public:
  using Real = Scalar<X>;

  /// With decomposed c M - J in `lu`, and what `interpolate(interpolant)` says of the step from t to t + h. Returns the
  /// number of evaluations, 0 where the system has no algebraic equation.
  template <class System, class Linear, class Factors, class Interpolate>
  [[nodiscard]] int measure(System& system, const Real& t, const Real& h, const X& x, const Linear& linear, Factors& lu,
                            const Interpolate& interpolate) {
    if (!linear.has_mass()) return 0;
    if (!known_) known_.emplace(x, linear);
    if (!known_->any) return 0;
    interpolate(known_->interpolant);
    known_->interpolant(inside<Real>(), known_->point);
    evaluate(system, Real(t + inside<Real>() * h), known_->point, known_->error);
    mask(known_->error, linear);
    lu.solve(linear, known_->error.data());
    mask(known_->error, linear);
    return 1;
  }

  /// In tolerances, as an error estimate has them.
  [[nodiscard]] Real norm(const X& x, const X& x_new, const Tolerance<Real>& tolerance) const {
    return known_ && known_->any ? weighted_norm(known_->error, x, x_new, tolerance) / looseness(tolerance) : Real(0);
  }
  [[nodiscard]] Real error_of(std::size_t i) const {
    using std::abs;
    return known_ && known_->any ? Real(abs(known_->error.data()[i])) : Real(0);
  }

 private:
  /// No stage of a method is there, and none near: where one is, what is between it and the next counts.
  template <class R>
  [[nodiscard]] static constexpr R inside() {
    return R(0.2);
  }
  // Between the ends the unknowns are solved for from the state, and what counts is that the step has seen them move:
  // where the error of the method is that of order p, a dense output of order d is off by the power (d + 1) / (p + 1)
  // of it.
  [[nodiscard]] static Real looseness(const Tolerance<Real>& tolerance) {
    using std::pow;
    constexpr double dense = M::dense_order + 1, end = M::order + 1;
    return Real(10) * pow(tolerance_as_number(tolerance), Real(dense / end - 1));
  }

  template <class Linear>
  static void mask(X& v, const Linear& linear) {
    for (std::size_t i = 0; i < dimension(v); ++i)
      if (!linear.is_without_mass(i)) v.data()[i] = Real(0);
  }
  struct Known {
    template <class Linear>
    Known(const X& x, const Linear& linear) : interpolant(x), point(x), error(x) {
      for (std::size_t i = 0; i < dimension(x); ++i) any = any || linear.is_without_mass(i);
      for (std::size_t i = 0; i < dimension(x); ++i) error.data()[i] = Real(0);
    }
    Interpolant<X, M::dense_degree> interpolant;
    X point, error;
    bool any = false;
  };
  std::optional<Known> known_;
};

}  // namespace continuo
