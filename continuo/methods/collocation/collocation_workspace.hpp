// What a collocation method keeps within a step and from one step to the next.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>

namespace continuo::collocation {

/// Count copies of a state, or of anything made from one.
template <class T, std::size_t Count, class From>
[[nodiscard]] std::array<T, Count> copies(const From& from) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<T, Count>{((void)i, T(from))...};
  }(std::make_index_sequence<Count>{});
}

template <State X, std::size_t most>
struct Workspace : StepEquations<Scalar<X>> {
  using Real = Scalar<X>;
  static constexpr std::size_t pairs = most / 2;
  using ComplexRow = BlockOf<ComplexNumber<Real>, fixed_size<X>(), fixed_size<X>()>;

  Workspace(const X& x, std::size_t stages_)
      : Z(copies<X, most>(x)),
        F(Z),
        W(Z),
        MW(Z),
        ahead(Z),
        f(x),
        f_end(x),
        guess(x),
        dense_error(x),
        error(x),
        slope(x),
        slope_end(x),
        point(x),
        weight(x),
        right(x),
        linear(x),
        lu(x),
        pair_lu(copies<Factorization<X, ComplexNumber<Real>>, pairs>(x)),
        stages(stages_),
        next_stages(stages_) {
    // Until a tolerance is set, the equations are solved down to rounding.
    this->tolerance = {10 * std::numeric_limits<Real>::epsilon(), 10 * std::numeric_limits<Real>::epsilon()};
    if constexpr (fixed_size<X>() == run_time_size) pair_right.fill(ComplexRow(dimension(x)));
  }

  std::array<X, most> Z, F, W, MW;  // increments of the stages, their slopes, their transforms, M times these
  std::array<X, most> ahead;        // the polynomial of the last accepted step, about its end
  X f, f_end;                       // at the start of the step; at its end, where the method needs it
  X guess, dense_error;             // of Z at the last node; the greatest error of the dense output
  X error, slope, slope_end;        // of the last step; q' at its start and its end
  X point, weight, right;           // scratch: an argument of f; 1 / scale; the right-hand side of the real system
  std::array<ComplexRow, pairs> pair_right{};
  Linearization<X> linear;
  Factorization<X> lu;
  std::array<Factorization<X, ComplexNumber<Real>>, pairs> pair_lu;
  NewtonMemory<Real> memory{};
  Real rtol = -1, looseness = 1, target = 1;  // derived from the tolerance; rtol < 0: to be derived again
  Real h{}, ahead_h{};                        // of the last step; of `ahead`
  Real decomposed_for{};                      // the h of the factorizations, 0 for none
  Real last_h{}, last_error{};                // of the last accepted step, last_h = 0 for none
  std::size_t decomposed_stages = 0;
  std::size_t stages, next_stages;
  std::size_t ahead_degree = 0;  // 0: there is none
  std::size_t steps_of_order = 0;
  std::size_t jacobian_age = 0;  // accepted steps since it was evaluated
  bool has_jacobian = false, has_f = false, was_rejected = false, oscillates = false;

  /// For checkpoints: what the next step depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(this->costs, this->status, Z, W, ahead, f, f_end, error, slope, slope_end, linear);
    lu.transfer(archive, linear);
    for (auto& factors : pair_lu) factors.transfer(archive, linear);
    archive(memory, rtol, looseness, target, h, ahead_h, decomposed_for, last_h, last_error);
    archive.index(decomposed_stages, most);
    archive.index(stages, most);
    archive.index(next_stages, most);
    archive.index(ahead_degree, most);
    archive(steps_of_order, jacobian_age, has_jacobian, has_f, was_rejected, oscillates);
  }

  void restart(std::size_t first_stages) {
    if (stages != first_stages) rtol = Real(-1);
    stages = next_stages = first_stages;
    steps_of_order = ahead_degree = 0;
    has_jacobian = has_f = was_rejected = false;
    last_h = 0;
    memory = {};
  }

  /// The elementary factor, corrected by how the error changed with the last h (K. Gustafsson, ACM TOMS 20 (1994)), and
  /// less where Newton's iteration was slow: Hairer & Wanner II, eq. 8.21 and 8.25.
  [[nodiscard]] Real wanted_factor(const Real& step, const Real& step_error, int most_iterations, int error_order) {
    using std::clamp, std::max, std::min, std::pow;
    const Real exponent = Real(1) / Real(error_order + 1), safe = max(step_error, Real(1e-10));
    const Real patience = Real(2 * most_iterations + 1) / Real(2 * most_iterations + memory.iterations);
    Real factor = Real(0.9) * patience * pow(safe, -exponent);
    if (last_h != 0) {
      const Real predicted = Real(0.9) * step / last_h * pow(last_error / (safe * safe), exponent);
      factor = min(factor, predicted);
    }
    last_h = step;
    last_error = max(safe, Real(1e-2));
    return clamp(factor, Real(0.2), Real(8));
  }
};

}  // namespace continuo::collocation
