// continuo/solve/steps/consistent.hpp
// Consistent values for the unknowns of algebraic equations: of M x' = f(t, x) with a diagonal M the rows without mass
// read 0 = g(t, x, z), and a run can only begin where they hold.
//
//   const Consistency found = make_consistent(system, t, x, tolerance);
//   if (!found) report(found.equation);
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

struct Consistency {
  enum class Result { consistent, singular, not_found };
  Result result = Result::consistent;
  std::size_t equation = 0;  // the component whose equation is farthest from holding
  int evaluations = 0;

  explicit operator bool() const { return result == Result::consistent; }
};

/// The hint where there are no consistent values.
[[nodiscard]] constexpr const char* hint_of(const Consistency& found) {
  return found.result == Consistency::Result::singular
             ? "the algebraic equations do not determine their unknowns here: an unknown appears in no equation, two "
               "equations say the same, or the index is above 1"
             : "no values of the unknowns satisfy the algebraic equations: begin nearer to them, or look for a "
               "contradiction in the equations";
}

/// How accurately unknowns are solved for. For guards, which are evaluated at many places of a step, they are solved
/// for to rounding, so that guards have no other noise.
enum class SolvedTo { tolerance, rounding };

/// Solves for the unknowns without mass, the other components stay. Newton's iteration; a correction is halved until
/// the next one, with the same matrix, is shorter (P. Deuflhard, "Newton Methods for Nonlinear Problems", 3.3: natural
/// monotonicity, which does not depend on how the equations are scaled).
template <class F, State X>
Consistency make_consistent(F& system, const Scalar<X>& t, X& x, const Tolerance<Scalar<X>>& tolerance,
                            SolvedTo solved_to = SolvedTo::tolerance) {
  using Real = Scalar<X>;
  using std::abs, std::max, std::sqrt;
  constexpr int most_iterations = 50, most_halvings = 20, most_further = 4;
  Consistency found;
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < dimension(x); ++i)
    if (is_algebraic<X>(system, i)) unknown.push_back(i);
  const std::size_t n = dimension(x), m = unknown.size();
  if (m == 0) return found;

  X f = x, moved = x, slope = x;
  std::vector<Real> rows(n * n), correction(m), next(m), scale(m);
  DenseLU<Real> lu(m);
  const auto residual = [&](std::span<Real> g) {
    evaluate(system, t, x, f);
    ++found.evaluations;
    for (std::size_t k = 0; k < m; ++k) g[k] = f.data()[unknown[k]];
  };
  // The scale is that of the iterate. A scale that changed with the result of a correction would make a correction
  // towards zero seem longer than it is.
  const auto take_scale = [&] {
    for (std::size_t k = 0; k < m; ++k) {
      const Real& value = x.data()[unknown[k]];
      scale[k] = max(tolerance.scale(unknown[k], value, value), std::numeric_limits<Real>::min());
    }
  };
  const auto size_of = [&](std::span<const Real> step) {
    return root_mean_square<Real>(m, [&](std::size_t k) { return Real(step[k] / scale[k]); });
  };
  const auto name_worst = [&] {
    Real worst(-1);
    for (const std::size_t i : unknown) {
      const Real here = abs(f.data()[i]);
      if (!(here <= worst)) worst = here, found.equation = i;
    }
  };

  const auto add = [&](std::span<const Real> step) {
    for (std::size_t k = 0; k < m; ++k) x.data()[unknown[k]] += step[k];
  };

  // A hundredth of the tolerance, so that the errors of the run itself are larger.
  const Real target = Real(1) / Real(100);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    residual(correction);
    found.evaluations += evaluate_jacobian(
        system, t, x, f, moved, slope,
        // The magnitude of an unknown with the guess 0 is not known: the increment is that of Hairer & Wanner's RADAU5.
        [](std::size_t) { return Real(sqrt(std::numeric_limits<Real>::epsilon() / Real(100000))); },
        std::span<Real>(rows));
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) lu.matrix()[i * m + j] = -rows[unknown[i] * n + unknown[j]];
    if (!lu.factor()) {
      name_worst();
      found.result = Consistency::Result::singular;
      return found;
    }
    lu.solve(correction.data());
    take_scale();
    const Real size = size_of(correction);
    if (!(size < std::numeric_limits<Real>::infinity())) break;
    if (size <= target) {
      add(correction);
      Real last = size;
      for (int more = 0; solved_to == SolvedTo::rounding && more < most_further; ++more) {
        residual(correction);
        lu.solve(correction.data());
        const Real left = size_of(correction);
        if (!(left < last / 2)) break;
        add(correction);
        last = left;
      }
      return found;
    }
    bool shorter = false;
    Real part(1);
    for (int halving = 0; halving < most_halvings && !shorter; ++halving) {
      for (std::size_t k = 0; k < m; ++k) x.data()[unknown[k]] += part * correction[k];
      residual(next);
      lu.solve(next.data());
      shorter = size_of(next) < size;
      if (shorter) break;
      for (std::size_t k = 0; k < m; ++k) x.data()[unknown[k]] -= part * correction[k];
      part /= Real(2);
    }
    if (!shorter) break;
  }
  evaluate(system, t, x, f);
  name_worst();
  found.result = Consistency::Result::not_found;
  return found;
}

}  // namespace continuo
