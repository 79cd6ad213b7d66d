// One step of a Runge-Kutta method, computed again and then differentiated backwards (E. Hairer, C. Lubich, G. Wanner,
// "Geometric Numerical Integration", VI.1.3; J. M. Sanz-Serna, SIAM Review 58 (2016) 3-33). With the seed w at the
// result x + h sum_j b_j k_j, the adjoints of the stages and of their arguments Y_j are, from the last to the first,
//   K_j = h b_j w + h sum_{i>=j} a_ij V_i,   V_j = (df/dx)^T K_j,
// and the derivatives by x, p, t and h are
//   w + sum V_j,   sum (df/dp)^T K_j,   sum (df/dt)^T K_j,   sum c_j (df/dt)^T K_j + V_j . (sum_i a_ji k_i) + w . sum
//   b_j k_j.
// An implicit stage has K_j on both sides: a linear system with I - h a_jj (df/dx)^T. An integral along the step has
// the same weights; its integrand adds h b_j dl/dx to V_j.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/sensitivities/adjoint/runge_kutta_table.hpp>
#include <continuo/sensitivities/derivatives/parameter_derivatives.hpp>
#include <continuo/sensitivities/objective.hpp>

namespace continuo::detail {

/// A step that a run has taken, from t, of the size h; its part up to `end` counts.
template <State X>
struct StepTaken {
  Scalar<X> t, h, end;
  X x;             // at t
  bool truncated;  // `end` lies within: the result is that of the interpolant
};

/// The derivatives of a seed times the result of a step.
template <State X>
struct StepSlopes {
  using Real = Scalar<X>;
  X x;
  std::vector<Real> p;
  Real t{}, h{};  // by the start of the step, at its size, and by its size
  Real end{};     // by the time of the result, where it is that of the interpolant
};

template <class F, State X, State P, class Integrand>
class StepAdjoint {
 public:
  using Real = Scalar<X>;
  static constexpr bool integrates = !std::same_as<Integrand, NoTerm>;

  StepAdjoint(const RungeKuttaTable<Real>& table, const ParameterDerivatives<F, X, P>& derivatives, const X& x,
              const P& p, const Integrand& integrand)
      : table_(table),
        p_(p),
        integrand_(integrand),
        argument_(x),
        product_(x),
        seeds_(table.stages, x),
        slopes_(table.stages, x),
        stages_(table.stages, derivatives),
        integrands_(integrates ? table.stages : 0),
        integrand_slopes_(integrates ? table.stages : 0),
        factors_(table.stages, DenseLU<Real>(dimension(x))) {}

  /// Computes the stages of a step again; the result from the interpolant where it is truncated or `by_interpolant`.
  /// `towards` is the state at its end, the first guess of implicit stages. False where their equations cannot be
  /// solved.
  [[nodiscard]] bool take(const StepTaken<X>& step, const X& towards, bool by_interpolant) {
    step_ = &step;
    interpolates_ = (by_interpolant || step.truncated) && step.h != Real(0);
    count_ = interpolates_ ? table_.stages : integrates ? table_.estimate_stages : table_.step_stages;
    theta_ = interpolates_ ? Real((step.end - step.t) / step.h) : Real(1);
    for (std::size_t j = 0; j < count_; ++j)
      if (!stage(j, towards)) return false;
    return true;
  }

  /// The integral over the step.
  [[nodiscard]] Real integral() const {
    Real sum(0);
    if constexpr (integrates)
      for (std::size_t j = 0; j < count_; ++j) sum += step_->h * weight(j) * integrands_[j];
    return sum;
  }

  /// The estimate of its error: the difference to the embedded method, over the whole step. Not a number without one.
  [[nodiscard]] Real error_of_integral() const {
    Real sum(table_.error.empty() ? std::numeric_limits<Real>::quiet_NaN() : Real(0));
    if constexpr (integrates)
      for (std::size_t j = 0; j < table_.error.size(); ++j)
        if (table_.error[j] != Real(0)) sum += step_->h * table_.error[j] * integrands_[j];
    return sum;
  }

  /// The derivatives of w . x(end), and of the integral over the step where `with_integral`.
  void multiply_left(const X& w, bool with_integral, bool with_time, StepSlopes<X>& result) {
    const std::size_t n = dimension(w);
    result.x = w;
    result.p.assign(dimension(p_), Real(0));
    result.t = result.h = result.end = Real(0);
    for (std::size_t j = 0; j < count_; ++j) {
      const Real b = weight(j), slope = dot(w, slopes_[j]) + (with_integral ? integrand(j) : Real(0));
      result.h += b * slope;
      if (interpolates_) result.end += table_.interpolant_slope(j, theta_) * slope;
      for (std::size_t i = 0; i < n; ++i) seeds_[j].data()[i] = step_->h * b * w.data()[i];
    }
    for (std::size_t j = count_; j-- > 0;) stage_back(j, with_integral, with_time, result);
  }

  [[nodiscard]] DerivativeCosts costs() const {
    DerivativeCosts sum;
    for (const auto& stage : stages_) {
      sum.evaluations += stage.costs().evaluations;
      sum.jacobians += stage.costs().jacobians;
      sum.vector_jacobian_products += stage.costs().vector_jacobian_products;
    }
    return sum;
  }

 private:
  [[nodiscard]] Real weight(std::size_t j) const {
    return interpolates_ ? table_.interpolant_weight(j, theta_) : table_.b[j];
  }
  [[nodiscard]] Real integrand(std::size_t j) const {
    if constexpr (integrates) {
      return integrands_[j];
    } else {
      return Real(0);
    }
  }
  [[nodiscard]] const Real& a(std::size_t i, std::size_t j) const { return table_.a[i * table_.stages + j]; }
  [[nodiscard]] static Real dot(const X& u, const X& v) {
    Real sum(0);
    for (std::size_t i = 0; i < dimension(u); ++i) sum += u.data()[i] * v.data()[i];
    return sum;
  }

  [[nodiscard]] bool stage(std::size_t j, const X& towards) {
    const Real t = step_->t + table_.c[j] * step_->h;
    argument_ = step_->x;
    for (std::size_t l = 0; l < j; ++l)
      if (a(j, l) != Real(0))
        for (std::size_t i = 0; i < dimension(argument_); ++i)
          argument_.data()[i] += step_->h * a(j, l) * slopes_[l].data()[i];
    if (table_.is_implicit(j)) {
      if (!solve_stage(j, t, towards)) return false;
    } else {
      stages_[j].go_to(t, argument_, p_);
    }
    slopes_[j] = stages_[j].slope();
    if constexpr (integrates) integrands_[j] = term_(integrand_, t, argument_, p_, integrand_slopes_[j]);
    return true;
  }

  /// Newton's iteration for Y = base + h a_jj f(t, Y) to rounding, where a step of the run stops earlier. Its matrix is
  /// decomposed transposed at the end.
  [[nodiscard]] bool solve_stage(std::size_t j, const Real& t, const X& towards) {
    using std::abs, std::max;
    constexpr int most_iterations = 30;
    const std::size_t n = dimension(argument_);
    const Real factor = step_->h * a(j, j), small = 8 * std::numeric_limits<Real>::epsilon();
    const X base = argument_;
    for (std::size_t i = 0; i < n; ++i)
      argument_.data()[i] = step_->x.data()[i] + table_.c[j] * (towards.data()[i] - step_->x.data()[i]);
    DenseLU<Real> lu(n);
    jacobian_.resize(n * n);
    Real last = std::numeric_limits<Real>::infinity();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      stages_[j].go_to(t, argument_, p_);
      stages_[j].rows_by_x(jacobian_);
      for (std::size_t k = 0; k < n * n; ++k) lu.matrix()[k] = Real(k % (n + 1) == 0 ? 1 : 0) - factor * jacobian_[k];
      if (!lu.factor()) return false;
      for (std::size_t i = 0; i < n; ++i)
        product_.data()[i] = base.data()[i] - argument_.data()[i] + factor * stages_[j].slope().data()[i];
      lu.solve(product_.data());
      Real size(0), change(0), greatest(0);
      for (std::size_t i = 0; i < n; ++i) {
        const Real moved = abs(product_.data()[i]);
        const Real scale = max(abs(argument_.data()[i]), abs(step_->x.data()[i]));
        if (moved != Real(0)) size = max(size, Real(moved / scale));
        change = max(change, moved);
        greatest = max(greatest, scale);
      }
      if (!(size == size)) return false;
      // A small change that does not become smaller is rounding: of a component near zero, perhaps all of it.
      const bool stays = iteration >= 3 && size >= last / 2 && change <= Real(1e-9) * greatest;
      if (size <= small || stays) return transpose(j, factor);
      last = size;
      for (std::size_t i = 0; i < n; ++i) argument_.data()[i] += product_.data()[i];
    }
    return false;
  }
  [[nodiscard]] bool transpose(std::size_t j, const Real& factor) {
    const std::size_t n = dimension(argument_);
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t s = 0; s < n; ++s)
        factors_[j].matrix()[r * n + s] = Real(r == s ? 1 : 0) - factor * jacobian_[s * n + r];
    return factors_[j].factor();
  }

  void stage_back(std::size_t j, bool with_integral, bool with_time, StepSlopes<X>& result) {
    const std::size_t n = dimension(argument_), m = dimension(p_);
    X& seed = seeds_[j];
    const Real own = step_->h * a(j, j), along = with_integral ? step_->h * weight(j) : Real(0);
    Real by_time(0);
    if constexpr (integrates) {
      if (own != Real(0))
        for (std::size_t i = 0; i < n; ++i) seed.data()[i] += own * along * integrand_slopes_[j][i];
    }
    bool any = false;
    for (std::size_t i = 0; i < n; ++i) any = any || seed.data()[i] != Real(0);
    for (std::size_t i = 0; i < n; ++i) product_.data()[i] = Real(0);
    if (any) {
      if (own != Real(0)) factors_[j].solve(seed.data());
      by_time = stages_[j].multiply_left(seed, product_, result.p, with_time);
    }
    if constexpr (integrates) {
      if (along != Real(0)) {
        for (std::size_t i = 0; i < n; ++i) product_.data()[i] += along * integrand_slopes_[j][i];
        for (std::size_t k = 0; k < m; ++k) result.p[k] += along * integrand_slopes_[j][n + k];
        by_time += along * integrand_slopes_[j][n + m];
      }
    }
    for (std::size_t i = 0; i < n; ++i) result.x.data()[i] += product_.data()[i];
    for (std::size_t l = 0; l <= j; ++l) {
      if (a(j, l) == Real(0)) continue;
      result.h += a(j, l) * dot(product_, slopes_[l]);
      if (l < j)
        for (std::size_t i = 0; i < n; ++i) seeds_[l].data()[i] += step_->h * a(j, l) * product_.data()[i];
    }
    result.t += by_time;
    result.h += table_.c[j] * by_time;
  }

  const RungeKuttaTable<Real>& table_;
  const P& p_;
  const Integrand& integrand_;
  const StepTaken<X>* step_ = nullptr;
  bool interpolates_ = false;
  std::size_t count_ = 0;
  Real theta_{};
  X argument_, product_;
  std::vector<X> seeds_, slopes_;
  std::vector<ParameterDerivatives<F, X, P>> stages_;  // each at its argument
  std::vector<Real> integrands_;
  std::vector<std::vector<Real>> integrand_slopes_;  // by x, p and t
  std::vector<DenseLU<Real>> factors_;               // of implicit stages, transposed
  TracedTerm<X, P> term_;
  std::vector<Real> jacobian_;
};

}  // namespace continuo::detail
