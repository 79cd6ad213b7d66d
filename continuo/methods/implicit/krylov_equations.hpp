// The equations of an implicit step of a large system, solved without a matrix: GMRES asks for products J v only. They
// are given by the system (`jacobian_action`), else each is a difference of f. P. N. Brown, A. C. Hindmarsh, "Reduced
// storage matrix methods in stiff ODE systems", Appl. Math. Comp. 31 (1989); tolerances as in CVODE.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <continuo/methods/implicit/constant_mass.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/numerics/gmres.hpp>

namespace continuo {

/// As DirectEquations; J is always that of the iterate.
template <State X>
class KrylovEquations : public StepEquations<Scalar<X>> {
 public:
  using Real = Scalar<X>;
  using StepEquations<Real>::tolerance, StepEquations<Real>::costs, StepEquations<Real>::status;

  explicit KrylovEquations(const X& x) : point_(x), weights_(x), argument_(x), product_(x), moved_(x) {}

  [[nodiscard]] bool prepared() const { return gmres_.has_value(); }
  template <class System>
  void prepare(System& system, const X& x) {
    mass_.read(system, dimension(x));
    gmres_.emplace(x, most_vectors);
  }
  template <class System>
  [[nodiscard]] static constexpr bool is_always_current(const System&) {
    return !HasPreconditioner<System, X>;
  }

  [[nodiscard]] bool has_mass() const { return !mass_.is_identity(); }
  void multiply_mass(const X& v, X& product) const { mass_.multiply(v, product); }

  template <class System>
  [[nodiscard]] int linearize(System&, const Real& t, const X& x, const Real&, X&) {
    t_ = t;
    point_ = x;
    return 0;
  }
  template <class System>
  [[nodiscard]] bool decompose(System& system, const Real& c) {
    c_ = c;
    if constexpr (HasPreconditioner<System, X>) {
      ++costs.factorizations;
      system.set_up_preconditioner(t_, point_, c);
    }
    status = StepStatus::done;
    return true;
  }

  /// GMRES works in components measured by the tolerance, where lengths are comparable, on the equations multiplied
  /// from the left by the preconditioner, or by 1/(c M): the residual is then like the error of y itself.
  template <class System>
  [[nodiscard]] int solve(System& system, const Real& t, const X& x, const X& f, const Real& target, X& b) {
    using std::sqrt;
    const std::size_t n = dimension(x);
    const Real root = sqrt(Real(static_cast<double>(n)));
    for (std::size_t i = 0; i < n; ++i) weights_.data()[i] = 1 / tolerance.scale(i, x.data()[i], x.data()[i]);
    int evaluations = 0;
    precondition(system, b);
    scale(b);
    gmres_->solve(
        [&](const X& v, X& image) {
          for (std::size_t i = 0; i < n; ++i) argument_.data()[i] = v.data()[i] / weights_.data()[i];
          evaluations += multiply_jacobian(system, t, x, f, relative_as_number(tolerance), root);
          mass_.multiply(argument_, image);
          for (std::size_t i = 0; i < n; ++i) image.data()[i] = c_ * image.data()[i] - product_.data()[i];
          precondition(system, image);
          scale(image);
        },
        b, Real(part_of_target) * target * root, most_products);
    for (std::size_t i = 0; i < n; ++i) b.data()[i] /= weights_.data()[i];
    ++costs.linear_solves;
    return evaluations;
  }

 private:
  // Directions before a restart, products before the step is better made shorter.
  static constexpr std::size_t most_vectors = 30, most_products = 300;
  static constexpr double part_of_target = 0.05;  // of what Newton's iteration is asked for

  // product_ = J argument_, where argument_ times the weights has length 1. A difference moves x by about its tolerance
  // in every component, and never by so little that rounding shows.
  template <class System>
  [[nodiscard]] int multiply_jacobian(System& system, const Real& t, const X& x, const X& f, const Real& rtol,
                                      const Real& root) {
    if constexpr (HasJacobianAction<System, X>) {
      system.jacobian_action(t, x, argument_, product_);
      detail::keep_size(x, product_);
      return 0;
    } else {
      using std::max, std::sqrt;
      const Real increment = root * max(Real(1), sqrt(std::numeric_limits<Real>::epsilon()) / rtol);
      const std::size_t n = dimension(x);
      for (std::size_t i = 0; i < n; ++i) moved_.data()[i] = x.data()[i] + increment * argument_.data()[i];
      evaluate(system, t, moved_, product_);
      for (std::size_t i = 0; i < n; ++i) product_.data()[i] = (product_.data()[i] - f.data()[i]) / increment;
      return 1;
    }
  }

  template <class System>
  void precondition(System& system, X& r) {
    if constexpr (HasPreconditioner<System, X>) {
      system.precondition(r);
      detail::keep_size(point_, r);
    } else {
      for (std::size_t i = 0; i < dimension(r); ++i) r.data()[i] /= weight_of_row(i);
    }
  }
  // c M without what is beside the diagonal. An algebraic equation stands as it is written: where its unknown has
  // another size there, or stands in other equations mostly, the system should have a preconditioner.
  [[nodiscard]] Real weight_of_row(std::size_t i) const {
    if (mass_.is_identity() || mass_.is_matrix()) return c_;
    return mass_[i] == Real(0) ? Real(1) : c_ * mass_[i];
  }
  void scale(X& v) const {
    for (std::size_t i = 0; i < dimension(v); ++i) v.data()[i] *= weights_.data()[i];
  }

  X point_, weights_, argument_, product_, moved_;
  Real t_{}, c_{1};
  ConstantMass<X> mass_;
  std::optional<Gmres<X>> gmres_;
};

}  // namespace continuo
