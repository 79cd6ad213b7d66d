// A type-erased method, for one type of system and state. Code that uses it does not compile the method; the method is
// compiled where `any_method` is instantiated for it.
//
//   extern template AnyMethod<MySystem, X> any_method<Rk4, MySystem, X>();
//   Integrator integrator(system, x0, {0, 10}, any_method<Rk4, MySystem, X>(), options);
#pragma once
#include <memory>
#include <utility>

#include <continuo/methods/check_method.hpp>
#include <continuo/solve/steps/step_control.hpp>
#include <continuo/solve/steps/steps.hpp>

namespace continuo {

/// A method that was compiled elsewhere, as a pointer to the function that begins its steps.
template <class System, State X>
struct AnyMethod {
  using Real = Scalar<X>;
  std::unique_ptr<Steps<System, X>> (*begin)(System, X x0, Real t0, Real forward, const Options<X>&);
};

/// The steps of the method M, at the start of a run.
template <class M, class System, State X>
[[nodiscard]] std::unique_ptr<Steps<System, X>> begin_steps(System f, X x0, Scalar<X> t0, Scalar<X> forward,
                                                            const Options<X>& options) {
  if constexpr (check_method<M, X, System>()) {
    return std::make_unique<StepControl<System, X, M>>(std::move(f), std::move(x0), t0, forward, options);
  } else {
    return nullptr;  // refused by the compiler
  }
}

/// The method M for this type of system and state.
template <class M, class System, State X>
[[nodiscard]] AnyMethod<System, X> any_method() {
  return {begin_steps<M, System, X>};
}

}  // namespace continuo
