// The equations of an implicit step, solved by decomposing their matrix: what a method asks of `Equations`. The same
// without a matrix is in krylov_equations.hpp.
//
//   equations.prepare(system, x)                                   once; allocates
//   equations.is_always_current(system)                            no old Jacobian is ever used: a retry is no use
//   equations.linearize(system, t, x, h, f) -> evaluations         J is that of (t, x) from here on; f is scratch
//   equations.decompose(system, c) -> whether that could be done   the equations are those of c M - J from here on
//   equations.solve(system, t, x, f, target, b) -> evaluations     b becomes the solution of (c M - J) y = b, near an
//       iterate (t, x) where f(t, x) = f, to `target` in the norm of the tolerance
#pragma once
#include <cstddef>

#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>

namespace continuo {

template <State X>
class DirectEquations : public StepEquations<Scalar<X>> {
 public:
  using Real = Scalar<X>;
  using StepEquations<Real>::tolerance, StepEquations<Real>::costs, StepEquations<Real>::status;

  explicit DirectEquations(const X& x) : linear_(x), lu_(x) {}

  /// For checkpoints: what the next step depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(costs, status, linear_);
    lu_.transfer(archive, linear_);
  }

  [[nodiscard]] bool prepared() const { return linear_.prepared(); }
  template <class System>
  void prepare(System& system, const X& x) {
    linear_.prepare(system, x);
  }
  template <class System>
  [[nodiscard]] static constexpr bool is_always_current(const System&) {
    return false;
  }

  [[nodiscard]] bool has_mass() const { return linear_.has_mass(); }
  void multiply_mass(const X& v, X& product) const { linear_.multiply_mass(v, product); }

  template <class System>
  [[nodiscard]] int linearize(System& system, const Real& t, const X& x, const Real& h, X& f) {
    evaluate(system, t, x, f);
    ++costs.jacobians;
    return 1 + linear_.evaluate(system, t, x, f, LeastIncrements(tolerance, h, x, f, has_mass()));
  }
  template <class System>
  [[nodiscard]] bool decompose(System& system, const Real& c) {
    linear_.bind(system);
    ++costs.factorizations;
    const bool done = lu_.factor(linear_, c);
    status = done ? StepStatus::done : linear_.status_of_failure();
    return done;
  }
  template <class System>
  [[nodiscard]] int solve(System& system, const Real&, const X&, const X&, const Real&, X& b) {
    linear_.bind(system);
    lu_.solve(linear_, b.data());
    ++costs.linear_solves;
    return 0;
  }

 private:
  Linearization<X> linear_;
  Factorization<X> lu_;
};

/// Of a workspace that has `equations`: see ImplicitMethod.
struct InEquations {
  template <class Work>
  auto& operator()(Work& work) const {
    return work.equations;
  }
};

}  // namespace continuo
