// Where the end of a step is no stage, unknowns of algebraic equations are carried over from its start by a factor of
// modulus 1, with all errors they ever had, or by one above, and grow without bound. They are solved for from the rest
// of the state there (E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", VI.1, the state space form).
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>

namespace continuo::detail {

template <class Linear>
[[nodiscard]] bool has_unknowns(const Linear& linear, std::size_t size) {
  for (std::size_t i = 0; i < size && linear.has_mass(); ++i)
    if (linear.is_without_mass(i)) return true;
  return false;
}

/// The c of c M - J, so large that nothing but the unknowns moves.
template <class Real>
[[nodiscard]] Real shift_for_unknowns(const Real& h) {
  using std::sqrt;
  return Real(1 / (h * sqrt(std::numeric_limits<Real>::epsilon())));
}

/// Newton's iteration for the unknowns in x_new at time t, with c M - J decomposed in `factors` for the c above; the
/// tolerances are relative to x. Returns the number of evaluations; `status` says where it failed. f is scratch.
template <class System, State X, class Linear, class Factors>
[[nodiscard]] int settle_unknowns(System& system, const Scalar<X>& t, const X& x, const Linear& linear,
                                  Factors& factors, const Tolerance<Scalar<X>>& tolerance, const Scalar<X>& target,
                                  X& f, X& x_new, StepStatus& status) {
  using Real = Scalar<X>;
  constexpr int most_iterations = 20;
  NewtonMemory<Real> memory{};
  memory.measure_anew(tolerance);
  const auto mask = [&] {
    for (std::size_t i = 0; i < dimension(f); ++i)
      if (!linear.is_without_mass(i)) f.data()[i] = Real(0);
  };
  const bool settled = newton(memory, target, most_iterations, [&] {
    evaluate(system, t, x_new, f);
    mask();
    factors.solve(linear, f.data());
    mask();
    for (std::size_t i = 0; i < dimension(f); ++i) x_new.data()[i] += f.data()[i];
    return weighted_norm(f, x, x, tolerance);
  });
  if (!settled) status = memory.status(settled);
  return memory.iterations;
}

}  // namespace continuo::detail
