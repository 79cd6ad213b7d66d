// continuo/methods/check_method.hpp
// The check of a method of your own, at compile time. It refuses, with a sentence, a method that lacks a member, and
// one with an optional member that would be ignored because of its signature. `solve` makes this check of every method
// for the system of the run; beside the declaration of a method it needs no system:
//
//   static_assert(check_method<MyMethod, std::array<double, 2>>());
#pragma once
#include <concepts>
#include <type_traits>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>  // for the error norm of a method of your own
#include <continuo/system/second_order.hpp>

namespace continuo {

namespace detail {

// A class that derives from M and from a class with a member `status` finds that name ambiguous exactly if M has a
// member of this name too, whatever its type, its arguments and its access.
struct NamesOfMethods {
  int unsupported_reason, error_square, implicit, set_tolerance, status, costs, failure, automatic, error_order_of,
      starting_order, order_of_fixed_steps, next_factor, rejected, retaken, stability_limits, moved, fault;
};
template <class M>
struct WithNamesOfMethods : M, NamesOfMethods {};
/// A type with one of these members is a method that may lack others.
template <class M>
concept ResemblesMethod = HasName<M> || HasOrder<M> || HasErrorOrder<M> || HasDenseOrder<M> || HasSecondOrder<M>;
/// Only of these classes the names of members can be looked up.
template <class M>
concept DerivableMethod = std::is_class_v<M> && !std::is_final_v<M>;

// An argument that binds to a reference of a deduced type, and to nothing else: it cannot be copied.
struct Pinned {
  Pinned(const Pinned&) = delete;
};

/// A method whose `step` gets x_new as a copy or as a constant, so that the result is lost.
template <class M, class X, class System, class Work>
concept StepLosesResult = requires(System& system, const Scalar<X>& t, const X& x, Work& work, X& x_new) {
  M::step(system, t, x, t, true, work, std::move(x_new));
} && !requires(System& system, const Scalar<X>& t, const X& x, Work& work, Pinned& x_new) {
  M::step(system, t, x, t, true, work, x_new);
};
/// The same of the polynomial that `interpolate` gets.
template <class M, class X, class System, class Work, class Polynomial>
concept InterpolateLosesResult =
    requires(System& system, const Scalar<X>& t, const X& x, Work& work, Polynomial& interpolant) {
      M::interpolate(system, t, x, t, x, work, std::move(interpolant));
    } && !requires(System& system, const Scalar<X>& t, const X& x, Work& work, Pinned& interpolant) {
      M::interpolate(system, t, x, t, x, work, interpolant);
    };
/// A method whose `step` copies the system, with everything that the system keeps from one evaluation to the next.
template <class M, class X, class Work>
concept StepCopiesSystem = HasStep<M, X, AnySystem<X, true>, Work> && !HasStep<M, X, AnySystem<X, false>, Work>;

// A workspace that a function gets as a copy, found by the type of the function: a constant reference would accept the
// same arguments. R is the type of its result, Real either a number or a reference to a constant one.
template <class M, class R, class System, class Real, class X, class Work>
concept StepCopiesWork = requires { static_cast<R (*)(System, Real, const X&, Real, bool, Work, X&)>(&M::step); };
template <class M, class X, class System, class Work>
[[nodiscard]] consteval bool step_copies_work() {
  using R = decltype(M::step(std::declval<System&>(), std::declval<const Scalar<X>&>(), std::declval<const X&>(),
                             std::declval<const Scalar<X>&>(), true, std::declval<Work&>(), std::declval<X&>()));
  return StepCopiesWork<M, R, System&, Scalar<X>, X, Work> ||
         StepCopiesWork<M, R, System&, const Scalar<X>&, X, Work> ||
         StepCopiesWork<M, R, const System&, Scalar<X>, X, Work> ||
         StepCopiesWork<M, R, const System&, const Scalar<X>&, X, Work>;
}
template <class M, class Work>
[[nodiscard]] consteval bool accept_copies_work() {
  using R = decltype(M::accept(std::declval<Work&>()));
  return requires { static_cast<R (*)(Work)>(&M::accept); };
}
template <class M, class Work>
[[nodiscard]] consteval bool retaken_copies_work() {
  using R = decltype(M::retaken(std::declval<Work&>()));
  return requires { static_cast<R (*)(Work)>(&M::retaken); };
}
template <class M, class X, class Work>
[[nodiscard]] consteval bool moved_copies_work() {
  using R = decltype(M::moved(std::declval<Work&>(), std::declval<const X&>(), std::declval<const X&>()));
  return requires { static_cast<R (*)(Work, const X&, const X&)>(&M::moved); };
}
template <class M, class X, class Work>
[[nodiscard]] consteval bool rejected_copies_work() {
  using Real = Scalar<X>;
  using R = decltype(M::rejected(std::declval<Work&>(), std::declval<const Real&>()));
  return requires { static_cast<R (*)(Work, Real)>(&M::rejected); } ||
         requires { static_cast<R (*)(Work, const Real&)>(&M::rejected); };
}
template <class M, class R, class Real, class X, class Work>
concept NextFactorCopiesWork = requires {
  static_cast<R (*)(Work, Real, Real, const X&, const X&, const Tolerance<Scalar<X>>&)>(&M::next_factor);
};
template <class M, class X, class Work>
[[nodiscard]] consteval bool next_factor_copies_work() {
  using Real = Scalar<X>;
  using R = decltype(M::next_factor(std::declval<Work&>(), std::declval<const Real&>(), std::declval<const Real&>(),
                                    std::declval<const X&>(), std::declval<const X&>(),
                                    std::declval<const Tolerance<Real>&>()));
  return NextFactorCopiesWork<M, R, Real, X, Work> || NextFactorCopiesWork<M, R, const Real&, X, Work>;
}
template <class M, class X, class Work>
[[nodiscard]] consteval bool set_tolerance_copies_work() {
  using Weights = Tolerance<Scalar<X>>;
  using R = decltype(M::set_tolerance(std::declval<Work&>(), std::declval<const Weights&>()));
  return requires { static_cast<R (*)(Work, Weights)>(&M::set_tolerance); } ||
         requires { static_cast<R (*)(Work, const Weights&)>(&M::set_tolerance); };
}

/// The members that every method has. The checks that need the workspace wait until there is one.
template <class M, State X, class System>
consteval void check_required_members() {
  constexpr bool has_name = HasName<M>;
  static_assert(has_name,
                "the method lacks a public member `name`: static constexpr std::string_view name = \"my_method\"");
  constexpr bool has_order = HasOrder<M>;
  static_assert(has_order, "the method lacks a public member `order`, at least 1: static constexpr int order = 2");
  constexpr bool has_error_order = HasErrorOrder<M>;
  static_assert(
      has_error_order,
      "the method lacks a public member `error_order`, the order of the solution whose distance from x_new is "
      "the error estimate, 0 if there is no estimate: static constexpr int error_order = 1");
  constexpr bool has_dense_order = HasDenseOrder<M>;
  static_assert(has_dense_order,
                "the method lacks a public member `dense_order`, the order of its interpolant: static constexpr int "
                "dense_order = 2");
  constexpr bool has_dense_degree = HasDenseDegree<M>;
  static_assert(has_dense_degree,
                "the method lacks a public member `dense_degree`, at least 1, the degree of its interpolant: static "
                "constexpr int dense_degree = 3");
  constexpr bool has_second_order = HasSecondOrder<M>;
  static_assert(
      has_second_order,
      "the method lacks a public member `second_order`, true if it is for x'' = a(t, x) only: static constexpr "
      "bool second_order = false");
  constexpr bool has_workspace = HasWorkspace<M, X>;
  static_assert(
      has_workspace,
      "the method lacks its workspace, a public template of a struct that can be copied, and the function that "
      "makes it: template <State X> struct Workspace; static Workspace<X> workspace(const X& x)");
  if constexpr (has_workspace) {
    using Work = typename M::template Workspace<X>;
    constexpr bool refers_to_system = !StepCopiesSystem<M, X, Work>;
    static_assert(
        refers_to_system,
        "the method copies the system in each step, with what the system keeps from one evaluation to the next: "
        "the first parameter of `step` is System& system");
    constexpr bool has_step = HasStep<M, X, System, Work> || StepCopiesSystem<M, X, Work>;
    static_assert(
        has_step,
        "the method lacks a public and static member `step` that returns its number of evaluations of f: static "
        "int step(System& system, Real t, const X& x, Real h, bool discontinuity, Workspace<X>& work, X& "
        "x_new), for every type System");
    constexpr bool has_accept = HasAccept<M, Work>;
    static_assert(
        has_accept,
        "the method lacks a public and static member `accept`, after which the end of the step is the start of "
        "the next: static void accept(Workspace<X>& work)");
    if constexpr (HasStep<M, X, System, Work>) {
      constexpr bool step_writes = !StepLosesResult<M, X, System, Work>;
      static_assert(step_writes,
                    "`step` gets x_new by value or as a constant, so that the result of the step is lost: declare X& "
                    "x_new");
      constexpr bool step_keeps_stages = !step_copies_work<M, X, System, Work>();
      static_assert(
          step_keeps_stages,
          "`step` gets the workspace by value, so that the stages of the step are lost: declare Workspace<X>& "
          "work");
    }
    if constexpr (has_accept) {
      constexpr bool accept_writes = !accept_copies_work<M, Work>();
      static_assert(accept_writes,
                    "`accept` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
    }
    if constexpr (has_dense_degree) {
      using Polynomial = Interpolant<X, M::dense_degree>;
      constexpr bool has_interpolate = HasInterpolate<M, X, System, Work, Polynomial>;
      static_assert(
          has_interpolate,
          "the method lacks a public and static member `interpolate` that returns its number of evaluations of "
          "f: static int interpolate(System& system, Real t, const X& x, Real h, const X& x_new, Workspace<X>& "
          "work, Interpolant<X, dense_degree>& interpolant), for every type System");
      if constexpr (has_interpolate) {
        constexpr bool interpolate_writes = !InterpolateLosesResult<M, X, System, Work, Polynomial>;
        static_assert(
            interpolate_writes,
            "`interpolate` gets the interpolant by value or as a constant, so that its result is lost: declare "
            "Interpolant<X, dense_degree>& interpolant");
      }
    }
    if constexpr (estimates_error<M>()) {
      constexpr bool has_error_norm = HasErrorNorm<M, X, Work>;
      static_assert(
          has_error_norm,
          "the method has an error_order above 0 and lacks a public and static member `error_norm`: static Real "
          "error_norm(const Workspace<X>& work, Real h, const X& x, const X& x_new, const Tolerance<Real>& "
          "tolerance)");
      constexpr bool has_error_of = HasErrorOf<M, X, Work>;
      static_assert(
          has_error_of,
          "the method has an error_order above 0 and lacks a public and static member `error_of`: static Real "
          "error_of(const Workspace<X>& work, Real h, std::size_t i)");
      constexpr bool has_derivative = is_implicit<M>() || HasDerivative<M, X, Work>;
      static_assert(
          has_derivative,
          "the method has an error_order above 0 and lacks a public and static member `derivative`, x' at the "
          "start of the last step: static const X& derivative(const Workspace<X>& work)");
    }
  }
}

/// The optional members: one that has the name and not the signature would be ignored.
template <class M, State X, class System>
  requires DerivableMethod<M>
consteval void check_optional_members() {
  using Work = typename M::template Workspace<X>;
  using With = WithNamesOfMethods<M>;
  constexpr bool keeps_implicit = HasImplicit<M> || requires { &With::implicit; };
  static_assert(
      keeps_implicit,
      "the member `implicit` of the method would be ignored: it must be public: static constexpr bool implicit "
      "= true");
  constexpr bool keeps_automatic = HasAutomatic<M> || requires { &With::automatic; };
  static_assert(keeps_automatic,
                "the member `automatic` of the method would be ignored: it must be public: static constexpr bool "
                "automatic = true");
  constexpr bool keeps_starting_order = HasStartingOrder<M> || requires { &With::starting_order; };
  static_assert(keeps_starting_order,
                "the member `starting_order` of the method would be ignored: it must be public and at least 1: static "
                "constexpr int starting_order = 1");
  constexpr bool keeps_order_of_fixed_steps = HasOrderOfFixedSteps<M> || requires { &With::order_of_fixed_steps; };
  static_assert(keeps_order_of_fixed_steps,
                "the member `order_of_fixed_steps` of the method would be ignored: it must be public and at least 1: "
                "static constexpr int order_of_fixed_steps = 1");
  constexpr bool keeps_unsupported_reason =
      HasUnsupportedReason<M, X, System> || requires { &With::unsupported_reason; };
  static_assert(keeps_unsupported_reason,
                "the member `unsupported_reason` of the method would be ignored: it must be public: static "
                "std::string_view unsupported_reason(const System& system, const X& x)");
  constexpr bool keeps_error_square = HasErrorSquare<M, X, Work> || requires { &With::error_square; };
  static_assert(keeps_error_square,
                "the member `error_square` of the method would be ignored: it must be public: static Real "
                "error_square(const Workspace<X>& work, Real h, const X& x, const X& x_new, const Tolerance<Real>& "
                "tolerance)");
  constexpr bool keeps_set_tolerance = HasSetTolerance<M, X, Work> || requires { &With::set_tolerance; };
  static_assert(keeps_set_tolerance,
                "the member `set_tolerance` of the method would be ignored: it must be public: static void "
                "set_tolerance(Workspace<X>& work, const Tolerance<Real>& tolerance)");
  constexpr bool keeps_status = HasStatus<M, Work> || requires { &With::status; };
  static_assert(keeps_status,
                "the member `status` of the method would be ignored: it must be public: static StepStatus status(const "
                "Workspace<X>& work)");
  constexpr bool keeps_costs = HasCosts<M, Work> || requires { &With::costs; };
  static_assert(
      keeps_costs,
      "the member `costs` of the method would be ignored: it must be public: static EquationCosts costs(const "
      "Workspace<X>& work)");
  constexpr bool keeps_failure = HasFailure<M, Work> || requires { &With::failure; };
  static_assert(keeps_failure,
                "the member `failure` of the method would be ignored: it must be public: static std::string_view "
                "failure(const Workspace<X>& work)");
  constexpr bool keeps_error_order_of = HasErrorOrderOf<M, Work> || requires { &With::error_order_of; };
  static_assert(keeps_error_order_of,
                "the member `error_order_of` of the method would be ignored: it must be public: static int "
                "error_order_of(const Workspace<X>& work)");
  constexpr bool keeps_next_factor = HasNextFactor<M, X, Work> || requires { &With::next_factor; };
  static_assert(
      keeps_next_factor,
      "the member `next_factor` of the method would be ignored: it must be public: static Real "
      "next_factor(Workspace<X>& work, Real factor, Real h, const X& x, const X& x_new, const Tolerance<Real>& "
      "tolerance)");
  constexpr bool keeps_rejected = HasRejected<M, X, Work> || requires { &With::rejected; };
  static_assert(keeps_rejected,
                "the member `rejected` of the method would be ignored: it must be public: static void "
                "rejected(Workspace<X>& work, Real h_next)");
  constexpr bool keeps_stability_limits = HasStabilityLimits<M, Work> || requires { &With::stability_limits; };
  static_assert(keeps_stability_limits,
                "the member `stability_limits` of the method would be ignored: it must be public: static bool "
                "stability_limits(const Workspace<X>& work)");
  constexpr bool keeps_retaken = HasRetaken<M, Work> || requires { &With::retaken; };
  static_assert(keeps_retaken,
                "the member `retaken` of the method would be ignored: it must be public: static void "
                "retaken(Workspace<X>& work)");
  constexpr bool keeps_moved = HasMoved<M, X, Work> || requires { &With::moved; };
  static_assert(keeps_moved,
                "the member `moved` of the method would be ignored: it must be public: static void "
                "moved(Workspace<X>& work, const X& from, const X& to)");
  constexpr bool keeps_fault = HasFault<M, Work> || requires { &With::fault; };
  static_assert(keeps_fault,
                "the member `fault` of the method would be ignored: it must be public: static std::string_view "
                "fault(const Workspace<X>& work)");
  if constexpr (HasSetTolerance<M, X, Work>) {
    constexpr bool set_tolerance_writes = !set_tolerance_copies_work<M, X, Work>();
    static_assert(
        set_tolerance_writes,
        "`set_tolerance` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
  }
  if constexpr (HasNextFactor<M, X, Work>) {
    constexpr bool next_factor_writes = !next_factor_copies_work<M, X, Work>();
    static_assert(next_factor_writes,
                  "`next_factor` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
  }
  if constexpr (HasRejected<M, X, Work>) {
    constexpr bool rejected_writes = !rejected_copies_work<M, X, Work>();
    static_assert(rejected_writes,
                  "`rejected` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
  }
  if constexpr (HasMoved<M, X, Work>) {
    constexpr bool moved_writes = !moved_copies_work<M, X, Work>();
    static_assert(moved_writes,
                  "`moved` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
  }
  if constexpr (HasRetaken<M, Work>) {
    constexpr bool retaken_writes = !retaken_copies_work<M, Work>();
    static_assert(retaken_writes,
                  "`retaken` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work");
  }
}
template <class M, State X, class System>
consteval void check_optional_members() {
  constexpr bool derivable = !std::is_final_v<M>;
  static_assert(derivable, "the method is final: remove `final`, so that its optional members can be checked");
}

}  // namespace detail

/// Refuses, at compile time, a type M that is no method for states X and systems System, or of which a part would be
/// ignored. Without a System: for any system. A call of it costs nothing; it returns true where it refuses nothing.
template <class M, State X, class System = detail::AnySystem<X, false>>
consteval bool check_method() {
  constexpr bool is_method = detail::ResemblesMethod<M>;
  static_assert(is_method,
                "the type is no method: see the concept Method, or name one of the library, such as Dop853{}");
  // A method that is made of others knows more about which go together.
  if constexpr (requires { M::template check_for_states<X>(); }) (void)M::template check_for_states<X>();
  if constexpr (is_method) detail::check_required_members<M, X, System>();
  if constexpr (Method<M, X, System>) {
    detail::check_optional_members<M, X, System>();
    constexpr bool has_pairs = !M::second_order || SecondOrder<System>;
    static_assert(has_pairs,
                  "the method is one for q'' = a(t, q): the system must say which components are positions and which "
                  "velocities, see second_order.hpp");
  }
  return Method<M, X, System>;
}

}  // namespace continuo
