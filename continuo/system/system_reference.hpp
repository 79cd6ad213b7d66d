// continuo/system/system_reference.hpp
// A system by reference: solve(std::ref(f), ...) integrates f itself and not a copy, with all its optional members.
#pragma once
#include <concepts>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {
template <class F>
struct AutonomousOf {
  explicit AutonomousOf(const F&) {}
};
template <KnowsAutonomous F>
struct AutonomousOf<F> {
  bool autonomous;
  explicit AutonomousOf(const F& f) : autonomous(f.autonomous) {}
};
}  // namespace detail

/// Refers to a system that outlives the run. It has exactly the optional members that the system has.
template <class F>
class SystemReference : public detail::AutonomousOf<F> {
 public:
  /// Refers to the system of std::ref.
  explicit(false) SystemReference(std::reference_wrapper<F> f) : detail::AutonomousOf<F>(f.get()), f_(&f.get()) {}

  /// The system itself.
  [[nodiscard]] F& get() const { return *f_; }

  /// Evaluates the right-hand side of the system.
  template <class... Arguments>
    requires std::invocable<F&, Arguments...>
  decltype(auto) operator()(Arguments&&... arguments) const {
    return std::invoke(*f_, std::forward<Arguments>(arguments)...);
  }

  /// The member of this name of the system; it is there exactly if the system has it.
  /// @{
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.component_name(std::forward<Arguments>(arguments)...); }
  decltype(auto) component_name(Arguments&&... arguments) const {
    return f_->component_name(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.pair_count(std::forward<Arguments>(arguments)...); }
  decltype(auto) pair_count(Arguments&&... arguments) const {
    return f_->pair_count(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.pair(std::forward<Arguments>(arguments)...); }
  decltype(auto) pair(Arguments&&... arguments) const {
    return f_->pair(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.ignores_velocity(std::forward<Arguments>(arguments)...); }
  decltype(auto) ignores_velocity(Arguments&&... arguments) const {
    return f_->ignores_velocity(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.jacobian(std::forward<Arguments>(arguments)...); }
  decltype(auto) jacobian(Arguments&&... arguments) const {
    return f_->jacobian(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.jacobian_pattern(std::forward<Arguments>(arguments)...); }
  decltype(auto) jacobian_pattern(Arguments&&... arguments) const {
    return f_->jacobian_pattern(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.jacobian_values(std::forward<Arguments>(arguments)...); }
  decltype(auto) jacobian_values(Arguments&&... arguments) const {
    return f_->jacobian_values(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.jacobian_band(std::forward<Arguments>(arguments)...); }
  decltype(auto) jacobian_band(Arguments&&... arguments) const {
    return f_->jacobian_band(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.jacobian_action(std::forward<Arguments>(arguments)...); }
  decltype(auto) jacobian_action(Arguments&&... arguments) const {
    return f_->jacobian_action(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.time_derivative(std::forward<Arguments>(arguments)...); }
  decltype(auto) time_derivative(Arguments&&... arguments) const {
    return f_->time_derivative(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) {
      f.set_up_preconditioner(std::forward<Arguments>(arguments)...);
    }
  decltype(auto) set_up_preconditioner(Arguments&&... arguments) const {
    return f_->set_up_preconditioner(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.precondition(std::forward<Arguments>(arguments)...); }
  decltype(auto) precondition(Arguments&&... arguments) const {
    return f_->precondition(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.spectral_radius(std::forward<Arguments>(arguments)...); }
  decltype(auto) spectral_radius(Arguments&&... arguments) const {
    return f_->spectral_radius(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.mass_matrix(std::forward<Arguments>(arguments)...); }
  decltype(auto) mass_matrix(Arguments&&... arguments) const {
    return f_->mass_matrix(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.mass(std::forward<Arguments>(arguments)...); }
  decltype(auto) mass(Arguments&&... arguments) const {
    return f_->mass(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.has_mass(std::forward<Arguments>(arguments)...); }
  decltype(auto) has_mass(Arguments&&... arguments) const {
    return f_->has_mass(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.stiff(std::forward<Arguments>(arguments)...); }
  decltype(auto) stiff(Arguments&&... arguments) const {
    return f_->stiff(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.stiff_jacobian(std::forward<Arguments>(arguments)...); }
  decltype(auto) stiff_jacobian(Arguments&&... arguments) const {
    return f_->stiff_jacobian(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.size_problem(std::forward<Arguments>(arguments)...); }
  decltype(auto) size_problem(Arguments&&... arguments) const {
    return f_->size_problem(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.start_problem(std::forward<Arguments>(arguments)...); }
  decltype(auto) start_problem(Arguments&&... arguments) const {
    return f_->start_problem(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
    requires requires(F& f, Arguments&&... arguments) { f.nonstiff(std::forward<Arguments>(arguments)...); }
  decltype(auto) nonstiff(Arguments&&... arguments) const {
    return f_->nonstiff(std::forward<Arguments>(arguments)...);
  }
  /// @}

 private:
  F* f_;
};

namespace detail {
template <class F>
struct HeldSystemOf {
  using Type = F;
};
template <class F>
struct HeldSystemOf<std::reference_wrapper<F>> {
  using Type = SystemReference<F>;
};
template <class F>
struct ReferredSystemOf {
  using Type = F;
};
template <class F>
struct ReferredSystemOf<SystemReference<F>> {
  using Type = F;
};
}  // namespace detail

/// The type by which a run holds a system that is given as F.
template <class F>
using HeldSystem = typename detail::HeldSystemOf<F>::Type;

/// The type of the system itself, where a run holds it by reference.
template <class F>
using ReferredSystem = typename detail::ReferredSystemOf<F>::Type;

}  // namespace continuo
