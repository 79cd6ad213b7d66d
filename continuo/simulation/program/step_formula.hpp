// The numbers of an explicit Runge-Kutta method, for steps in machine code.
//
//   const CStepFormula formula = step_formula_of<Dop853>();
#pragma once
#include <cstddef>
#include <type_traits>
#include <vector>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/numerics/coefficient.hpp>
#include <continuo/solve/steps/controller.hpp>
#include <continuo/symbolic/native/c_step.hpp>

namespace continuo::model {

/// The weights that `weight` gives for the stages before `end`, as doubles.
template <class Weight>
[[nodiscard]] std::vector<double> weights_of(std::size_t end, const Weight& weight) {
  std::vector<double> weights;
  for (std::size_t j = 0; j < end; ++j) weights.push_back(Coefficient(weight(j)).template as<double>());
  return weights;
}

/// The numbers of M.
template <class M>
[[nodiscard]] CStepFormula step_formula_of() {
  constexpr auto& tableau = M::tableau;
  constexpr std::size_t stages = tableau.stages;
  CStepFormula made;
  made.c = weights_of(stages, [](std::size_t j) { return M::tableau.c[j]; });
  made.b = weights_of(stages, [](std::size_t j) { return M::tableau.b[j]; });
  for (std::size_t s = 0; s < stages; ++s)
    made.a.push_back(weights_of(s, [s](std::size_t j) { return M::tableau.a[s][j]; }));
  if constexpr (std::is_base_of_v<Dop853, M>) {
    made.error = weights_of(stages, [](std::size_t j) { return dop853::error5[j]; });
    made.second_error = weights_of(stages, [](std::size_t j) { return M::tableau.b[j] - dop853::third_order[j]; });
  } else if constexpr (M::error_order > 0) {
    made.error = weights_of(stages, [](std::size_t j) { return M::tableau.b[j] - M::tableau.embedded[j]; });
  }
  made.ends_with_f = tableau.first_same_as_last();
  return made;
}

/// How the sizes of many steps are chosen, as ErrorHistoryOf::accept does, and their errors measured: by numbers that
/// the tolerance has.
template <class Real>
[[nodiscard]] LaneSteps steps_by(const Controller& controller, int error_order, const Tolerance<Real>& tolerance) {
  const auto numbers = [](const Real* first) { return reinterpret_cast<const double*>(first); };
  const float order = ErrorHistory::exponent_of(error_order);
  LaneSteps steps{};
  steps.rtol = numbers(tolerance.rtol_each ? tolerance.rtol_each : &tolerance.rtol);
  steps.atol = numbers(tolerance.atol_each ? tolerance.atol_each : &tolerance.atol);
  steps.rtol_each = tolerance.rtol_each ? 1 : 0;
  steps.atol_each = tolerance.atol_each ? 1 : 0;
  steps.beta2 = static_cast<float>(controller.beta2);
  steps.beta3 = static_cast<float>(controller.beta3);
  steps.minus_order = -order;
  steps.order_beta1 = order * static_cast<float>(controller.beta1);
  steps.safety = static_cast<float>(controller.safety);
  steps.least_factor = static_cast<float>(controller.least_factor);
  steps.greatest_factor = static_cast<float>(controller.greatest_factor);
  return steps;
}

}  // namespace continuo::model
