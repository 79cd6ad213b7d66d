// continuo/methods/implicit/implicit_method.hpp
// What the driver sets in every implicit method and asks of it: tolerance, status and costs of the equations of its
// steps.
#pragma once
#include <continuo/methods/method.hpp>

namespace continuo {

/// Of the equations of implicit steps: how close they must be solved, what that has cost, how the last ones ended. A
/// base of whatever solves them: a StageSolver, DirectEquations, or the workspace of a method that does so itself.
template <class Real>
struct StepEquations {
  Tolerance<Real> tolerance{Real(1e-6), Real(1e-9)};  // until the driver sets one
  EquationCosts costs{};
  StepStatus status = StepStatus::done;
};

/// The workspace is a StepEquations itself.
struct InWorkspace {
  template <class Work>
  Work& operator()(Work& work) const {
    return work;
  }
};

/// The base of implicit methods; Where finds the StepEquations in their workspace.
template <class Where = InWorkspace>
struct ImplicitMethod {
  static constexpr bool implicit = true;

  template <class Work, class Real>
  static void set_tolerance(Work& work, const Tolerance<Real>& tolerance) {
    Where{}(work).tolerance = tolerance;
  }
  template <class Work>
  [[nodiscard]] static StepStatus status(const Work& work) {
    return Where{}(work).status;
  }
  template <class Work>
  [[nodiscard]] static const EquationCosts& costs(const Work& work) {
    return Where{}(work).costs;
  }
};

}  // namespace continuo
