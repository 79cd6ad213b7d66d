// continuo/solve/integrator.hpp
// Integration step by step, for `solve`, the live view and co-simulation. A copy of an integrator is a checkpoint.
//
//   Integrator integrator(f, x0, {0.0, 10.0}, Tsitouras5{}, {.rtol = 1e-9});
//   while (integrator.advance()) use(integrator.t(), integrator.x());
#pragma once
#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

#include <continuo/solve/any_method.hpp>
#include <continuo/solve/check_event_source.hpp>
#include <continuo/solve/driver/driver.hpp>
#include <continuo/system/check_system.hpp>
#include <continuo/system/system_reference.hpp>

namespace continuo {

/// A run that is advanced step by step by the method M.
template <class System, State X, class M, class Events = EventList<X>>
  requires RightHandSide<System, X>
class Integrator : public Driver<System, X, Events> {
  using Base = Driver<System, X, Events>;
  static_assert(check_event_source<Events, System, X>());

 public:
  using Real = Scalar<X>;

  /// Begins at interval.from. For invalid input (not finite, wrong sizes, no step for a method without error estimate)
  /// the first advance() ends the run with that outcome.
  Integrator(System f, X x0, Interval<std::type_identity_t<Real>> interval, M method,
             std::type_identity_t<Options<X>> options = {})
    requires std::same_as<Events, EventList<X>>
      : Integrator(std::move(f), std::move(x0), interval, method, options, EventList<X>(options.events)) {}

  /// The same with events of another source.
  Integrator(System f, X x0, Interval<std::type_identity_t<Real>> interval, M method,
             std::type_identity_t<Options<X>> options, Events events)
      : Base(begin(method, std::move(f), x0, interval, options), begin_of(method), x0, interval, options,
             std::move(events)) {}

  /// The last step: dense output in theta = (t - begin) / size.
  [[nodiscard]] const auto& interpolant()
    requires(!std::same_as<M, AnyMethod<System, X>>)
  {
    return static_cast<StepControl<System, X, M>&>(this->steps()).interpolant();
  }

 private:
  [[nodiscard]] static std::unique_ptr<Steps<System, X>> begin(M method, System f, const X& x0, Interval<Real> interval,
                                                               const Options<X>& options) {
    static_cast<void>(check_state<X>());
    check_system<ReferredSystem<System>, X>();
    const Real forward = interval.to < interval.from ? Real(-1) : Real(1);
    return begin_of(method)(std::move(f), x0, interval.from, forward, options);
  }
  [[nodiscard]] static typename Base::Begin begin_of(M method) {
    if constexpr (std::same_as<M, AnyMethod<System, X>>) {
      return method.begin;
    } else {
      return begin_steps<M, System, X>;
    }
  }
};

/// std::ref(f): the run refers to f, which must outlive it.
/// @{
template <class System, State X, class M>
Integrator(std::reference_wrapper<System>, X, Interval<std::type_identity_t<Scalar<X>>>, M)
    -> Integrator<SystemReference<System>, X, M>;
template <class System, State X, class M>
Integrator(std::reference_wrapper<System>, X, Interval<std::type_identity_t<Scalar<X>>>, M,
           std::type_identity_t<Options<X>>) -> Integrator<SystemReference<System>, X, M>;
template <class System, State X, class M, class Events>
Integrator(std::reference_wrapper<System>, X, Interval<std::type_identity_t<Scalar<X>>>, M,
           std::type_identity_t<Options<X>>, Events) -> Integrator<SystemReference<System>, X, M, Events>;
/// @}

}  // namespace continuo
