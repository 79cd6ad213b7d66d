// continuo/system/check_system.hpp
// Checks of a system at compile time. A system has optional members (a Jacobian, a mass matrix, ...), which are found
// by name. A member that has the name and not the signature would be ignored, and the run would be that of another
// system: the compiler refuses it here. The same holds for a right-hand side whose result is lost.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>
#include <continuo/system/second_order.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {

template <class F>
concept Inspectable = std::is_class_v<F> && !std::is_final_v<F>;

// A class that derives from F and from a class with a member `jacobian` finds that name ambiguous exactly if F has a
// member of this name too, whatever its type, its arguments and its access.
template <class F, class Named>
struct WithName : F, Named {};

struct NameComponentName {
  int component_name;
};
template <class F>
concept MentionsComponentName = Inspectable<F> && !requires { &WithName<F, NameComponentName>::component_name; };
struct NamePairCount {
  int pair_count;
};
template <class F>
concept MentionsPairCount = Inspectable<F> && !requires { &WithName<F, NamePairCount>::pair_count; };
struct NameIgnoresVelocity {
  int ignores_velocity;
};
template <class F>
concept MentionsIgnoresVelocity = Inspectable<F> && !requires { &WithName<F, NameIgnoresVelocity>::ignores_velocity; };
struct NameJacobian {
  int jacobian;
};
template <class F>
concept MentionsJacobian = Inspectable<F> && !requires { &WithName<F, NameJacobian>::jacobian; };
struct NameJacobianPattern {
  int jacobian_pattern;
};
template <class F>
concept MentionsJacobianPattern = Inspectable<F> && !requires { &WithName<F, NameJacobianPattern>::jacobian_pattern; };
struct NameJacobianValues {
  int jacobian_values;
};
template <class F>
concept MentionsJacobianValues = Inspectable<F> && !requires { &WithName<F, NameJacobianValues>::jacobian_values; };
struct NameJacobianBand {
  int jacobian_band;
};
template <class F>
concept MentionsJacobianBand = Inspectable<F> && !requires { &WithName<F, NameJacobianBand>::jacobian_band; };
struct NameJacobianAction {
  int jacobian_action;
};
template <class F>
concept MentionsJacobianAction = Inspectable<F> && !requires { &WithName<F, NameJacobianAction>::jacobian_action; };
struct NameTimeDerivative {
  int time_derivative;
};
template <class F>
concept MentionsTimeDerivative = Inspectable<F> && !requires { &WithName<F, NameTimeDerivative>::time_derivative; };
struct NameSetUpPreconditioner {
  int set_up_preconditioner;
};
template <class F>
concept MentionsSetUpPreconditioner =
    Inspectable<F> && !requires { &WithName<F, NameSetUpPreconditioner>::set_up_preconditioner; };
struct NamePrecondition {
  int precondition;
};
template <class F>
concept MentionsPrecondition = Inspectable<F> && !requires { &WithName<F, NamePrecondition>::precondition; };
struct NameAutonomous {
  int autonomous;
};
template <class F>
concept MentionsAutonomous = Inspectable<F> && !requires { &WithName<F, NameAutonomous>::autonomous; };
struct NameSpectralRadius {
  int spectral_radius;
};
template <class F>
concept MentionsSpectralRadius = Inspectable<F> && !requires { &WithName<F, NameSpectralRadius>::spectral_radius; };
struct NameMassMatrix {
  int mass_matrix;
};
template <class F>
concept MentionsMassMatrix = Inspectable<F> && !requires { &WithName<F, NameMassMatrix>::mass_matrix; };
struct NameStiffJacobian {
  int stiff_jacobian;
};
template <class F>
concept MentionsStiffJacobian = Inspectable<F> && !requires { &WithName<F, NameStiffJacobian>::stiff_jacobian; };
struct NameHasMass {
  int has_mass;
};
template <class F>
concept MentionsHasMass = Inspectable<F> && !requires { &WithName<F, NameHasMass>::has_mass; };
struct NameNonstiff {
  int nonstiff;
};
template <class F>
concept MentionsNonstiff = Inspectable<F> && !requires { &WithName<F, NameNonstiff>::nonstiff; };

// `mass`, `stiff` and `pair` are also names of numbers (a mass in kilograms) and of functions without arguments. So
// only a public function with arguments counts.
template <class F>
concept MentionsMass =
    requires { requires std::is_member_function_pointer_v<decltype(&F::mass)>; } && !requires(F& f) { f.mass(); };
template <class F>
concept MentionsStiff =
    requires { requires std::is_member_function_pointer_v<decltype(&F::stiff)>; } && !requires(F& f) { f.stiff(); };
template <class F>
concept MentionsPair =
    requires { requires std::is_member_function_pointer_v<decltype(&F::pair)>; } && !requires(F& f) { f.pair(); };

/// A system that says nothing but its right-hand side. A final class may say more, which is not seen.
template <class F>
concept IsOnlyRightHandSide =
    (Inspectable<F> || !std::is_class_v<F>) &&
    !(MentionsComponentName<F> || MentionsPairCount<F> || MentionsPair<F> || MentionsIgnoresVelocity<F> ||
      MentionsJacobian<F> || MentionsJacobianPattern<F> || MentionsJacobianValues<F> || MentionsJacobianBand<F> ||
      MentionsJacobianAction<F> || MentionsTimeDerivative<F> || MentionsSetUpPreconditioner<F> ||
      MentionsPrecondition<F> || MentionsAutonomous<F> || MentionsSpectralRadius<F> || MentionsMassMatrix<F> ||
      MentionsStiffJacobian<F> || MentionsHasMass<F> || MentionsNonstiff<F> || MentionsStiff<F> || MentionsMass<F>);

// The third parameter of a function with three, as declared; void where there is none, or more than one to choose from.
template <class Function>
struct ThirdParameter {
  using Type = void;
};
template <class R, class A, class B, class C>
struct ThirdParameter<R (*)(A, B, C)> {
  using Type = C;
};
template <class R, class A, class B, class C>
struct ThirdParameter<R (*)(A, B, C) noexcept> {
  using Type = C;
};
template <class R, class F, class A, class B, class C>
struct ThirdParameter<R (F::*)(A, B, C)> {
  using Type = C;
};
template <class R, class F, class A, class B, class C>
struct ThirdParameter<R (F::*)(A, B, C) const> {
  using Type = C;
};
template <class R, class F, class A, class B, class C>
struct ThirdParameter<R (F::*)(A, B, C) noexcept> {
  using Type = C;
};
template <class R, class F, class A, class B, class C>
struct ThirdParameter<R (F::*)(A, B, C) const noexcept> {
  using Type = C;
};

template <class F, class X>
[[nodiscard]] consteval auto third_parameter() {
  if constexpr (requires { &F::operator(); }) {
    return ThirdParameter<decltype(&F::operator())>{};
  } else if constexpr (requires { &F::template operator()<Scalar<X>, X, X>; }) {
    return ThirdParameter<decltype(&F::template operator()<Scalar<X>, X, X>)> {};
  } else if constexpr (requires { &F::template operator()<X, X>; }) {
    return ThirdParameter<decltype(&F::template operator()<X, X>)> {};
  } else if constexpr (requires { &F::template operator()<X>; }) {
    return ThirdParameter<decltype(&F::template operator()<X>)> {};
  } else {
    return ThirdParameter<F>{};
  }
}

/// Whether a right-hand side f(t, x, dxdt) writes into a copy of dxdt.
template <class F, class X>
[[nodiscard]] consteval bool writes_into_copy() {
  if constexpr (!WritesDerivative<F, X>) {
    return false;
  } else {
    using Third = typename decltype(third_parameter<F, X>())::Type;
    return std::is_same_v<std::remove_cv_t<Third>, X>;
  }
}
/// Whether the acceleration a(t, q, out) of a second-order system writes into a copy of `out`.
template <class F, class X>
inline constexpr bool acceleration_writes_into_copy = false;
template <class Acceleration, class Real, std::size_t Size>
inline constexpr bool acceleration_writes_into_copy<SecondOrderSystem<Acceleration>, std::array<Real, Size>> = [] {
  using Half = std::array<Real, Size / 2>;
  if constexpr (writes_into_copy<Acceleration, Half>())
    return std::is_void_v<std::invoke_result_t<Acceleration&, Real, const Half&, Half&>>;
  else
    return false;
}();
/// Whether the acceleration of a second-order system can be called.
template <class F, class X>
[[nodiscard]] consteval bool acceleration_is_callable() {
  if constexpr (requires { F::template is_callable<X>(); }) {
    return F::template is_callable<X>();
  } else {
    return true;
  }
}
/// Whether it takes dxdt as a constant, so that it cannot write it.
template <class F, class X>
[[nodiscard]] consteval bool cannot_write() {
  if constexpr (!WritesDerivative<F, X>) {
    return false;
  } else {
    return std::is_same_v<typename decltype(third_parameter<F, X>())::Type, const X&>;
  }
}

}  // namespace detail

namespace detail {
template <class Real>
[[nodiscard]] consteval bool has_expression_templates() {
  if constexpr (requires(const Real& a, const Real& b) { a* b; } && std::is_class_v<Real>) {
    return !std::same_as<std::remove_cvref_t<decltype(std::declval<const Real&>() * std::declval<const Real&>())>,
                         Real>;
  } else {
    return false;
  }
}
}  // namespace detail

/// Refuses, at compile time, a type of x0 that is no state; true where it is one.
template <class X>
[[nodiscard]] consteval bool check_state() {
  // Concepts are not the conditions of the assertions: a compiler would list all that they consist of.
  constexpr bool state = State<X>, has_components = requires(X& x) {
    typename X::value_type;
    x.data();
    x.size();
  };
  if constexpr (has_components) {
    using Real = typename X::value_type;
    constexpr bool whole = std::is_integral_v<Real>, expressions = detail::has_expression_templates<Real>(),
                   complex = !std::numeric_limits<Real>::is_specialized && requires(const Real& z) {
                     z.real();
                     z.imag();
                   };
    static_assert(
        !whole,
        "the state has whole numbers as components: write them as 1.0, or name the type, std::array<double, 2>{1, "
        "0}");
    static_assert(
        !expressions,
        "the numbers of the state have expression templates, so that a product is no number: turn them off, as in "
        "boost::multiprecision::number<boost::multiprecision::cpp_dec_float<50>, boost::multiprecision::et_off>");
    static_assert(!complex,
                  "the state has complex components: give a real and an imaginary part for each, since the error norm "
                  "and the Jacobian are those of real numbers");
    static_assert(whole || expressions || complex || state,
                  "the state must be copyable and have its components side by side: data() points to them");
    return state && !whole && !expressions && !complex;
  } else {
    static_assert(has_components,
                  "the state must be a std::array<double, n>, a std::vector<double>, or another type with data() and "
                  "size(): one number is std::array{1.0}");
    return false;
  }
}

/// Refuses, at compile time, a system F that cannot be called with states X; true where it can.
template <class F, State X>
[[nodiscard]] consteval bool check_right_hand_side() {
  using Real = Scalar<X>;
  if constexpr (!RightHandSide<F, X>) {
    constexpr bool changes_state = std::invocable<F&, Real, X&> || std::invocable<F&, Real, X&, X&>;
    constexpr bool time_last = std::invocable<F&, const X&, X&, Real> || std::invocable<F&, const X&, Real>;
    constexpr bool without_time = std::invocable<F&, const X&> || std::invocable<F&, const X&, X&>;
    constexpr bool returns_other = std::invocable<F&, Real, const X&>;
    static_assert(!changes_state || returns_other, "f takes the state x as X&: it must take it as const X&");
    static_assert(!time_last || changes_state,
                  "f has the time as its last argument: it comes first, f(t, x) or f(t, x, dxdt)");
    static_assert(!without_time || changes_state || time_last,
                  "f does not take the time: it is the first argument, f(t, x) or f(t, x, dxdt)");
    static_assert(!returns_other, "f(t, x) returns another type than that of the state x0: it returns dx/dt as an X");
    static_assert(
        changes_state || time_last || without_time || returns_other,
        "f can be called neither as dxdt = f(t, x) nor as f(t, x, dxdt), with t a number and x and dxdt of the type "
        "of x0");
    return false;
  } else {
    return true;
  }
}

/// Refuses, at compile time, a system F for states X of which a part would be ignored. A call of it costs nothing.
template <class F, State X>
consteval void check_system() {
  using namespace detail;
  // A system that is made of others knows more about which go together.
  if constexpr (requires { F::template check_for_states<X>(); }) (void)F::template check_for_states<X>();
  static_assert(
      !writes_into_copy<F, X>(),
      "f takes dxdt by value, so that its result is lost: declare the third parameter as a reference, X& dxdt");
  constexpr bool callable_acceleration = acceleration_is_callable<F, X>();
  static_assert(
      callable_acceleration,
      "the acceleration is called neither as a(t, q), a(t, q, v), a(t, q, out) nor a(t, q, v, out), with q, v "
      "and out arrays of half the size of x0, or spans");
  static_assert(!acceleration_writes_into_copy<F, X>,
                "the acceleration is written into a copy, so that its result is lost: declare the last parameter as a "
                "reference, or return the acceleration");
  static_assert(!cannot_write<F, X>(),
                "f takes dxdt as a constant, so that it has no result: declare the third parameter as X& dxdt");
  static_assert(!MentionsComponentName<F> || Named<F>,
                "the member `component_name` of the system would be ignored: it must be public and const, and give a "
                "text: std::string component_name(std::size_t i) const");
  static_assert(
      !(MentionsPairCount<F> || MentionsPair<F>) || SecondOrder<F>,
      "the members `pair_count` and `pair` of the system would be ignored: they must be public and const: "
      "std::size_t pair_count(std::size_t size) const; PositionVelocity pair(std::size_t i, std::size_t size) "
      "const");
  static_assert(!MentionsIgnoresVelocity<F> || KnowsIfVelocityCounts<F, X>,
                "the member `ignores_velocity` of the system would be ignored: it must be public and const: bool "
                "ignores_velocity(const X& x) const");
  static_assert(
      !MentionsJacobian<F> || HasJacobian<F, X>,
      "the member `jacobian` of the system would be ignored: it must be public: void jacobian(Real t, const X& "
      "x, std::span<Real> rows), with the n*n numbers row by row");
  static_assert(!MentionsJacobianPattern<F> || HasJacobianPattern<F>,
                "the member `jacobian_pattern` of the system would be ignored: it must be public: const SparsePattern& "
                "jacobian_pattern()");
  static_assert(
      !MentionsJacobianValues<F> || HasSparseJacobian<F, X>,
      "the member `jacobian_values` of the system would be ignored: it must be public, and `jacobian_pattern()` "
      "beside it: void jacobian_values(Real t, const X& x, std::span<Real> values)");
  static_assert(
      !MentionsJacobianBand<F> || HasBandJacobian<F, X>,
      "the member `jacobian_band` of the system would be ignored: it must be public, with `jacobian_pattern()` "
      "and `jacobian_values` beside it: void jacobian_band(Real t, const X& x, std::span<Real> band)");
  static_assert(!MentionsJacobianAction<F> || HasJacobianAction<F, X>,
                "the member `jacobian_action` of the system would be ignored: it must be public: void "
                "jacobian_action(Real t, const X& x, const X& v, X& product)");
  static_assert(!MentionsTimeDerivative<F> || HasTimeDerivative<F, X>,
                "the member `time_derivative` of the system would be ignored: it must be public: void "
                "time_derivative(Real t, const X& x, X& dfdt)");
  static_assert(!(MentionsPrecondition<F> || MentionsSetUpPreconditioner<F>) || HasPreconditioner<F, X>,
                "the preconditioner of the system would be ignored: it has two public members: void "
                "set_up_preconditioner(Real t, const X& x, Real c); void precondition(X& r)");
  static_assert(
      !MentionsAutonomous<F> || KnowsAutonomous<F>,
      "the member `autonomous` of the system would be ignored: it must be a public variable: bool autonomous");
  static_assert(!MentionsSpectralRadius<F> || HasSpectralRadius<F, X>,
                "the member `spectral_radius` of the system would be ignored: it must be public: Real "
                "spectral_radius(Real t, const X& x)");
  static_assert(
      !MentionsMassMatrix<F> || HasMassMatrix<F, X>,
      "the member `mass_matrix` of the system would be ignored: it must be public and const: void "
      "mass_matrix(std::span<Real> rows) const, with the n*n numbers row by row; a mass that depends on t and x is "
      "given by with_mass(f, mass), of system/with_mass.hpp");
  static_assert(!MentionsMass<F> || HasMassDiagonal<F, X>,
                "the member `mass` of the system would be ignored: the diagonal of a mass matrix is given by a public "
                "and const member Real mass(std::size_t i) const; give a mass in kilograms another name");
  static_assert(!(HasMassMatrix<F, X> && HasMassDiagonal<F, X>),
                "the system has two mass matrices, of which one would be ignored: give either mass_matrix(rows) or the "
                "diagonal mass(i)");
  static_assert(
      !MentionsHasMass<F> || requires(const F& f) {
        { f.has_mass() } -> std::convertible_to<bool>;
      }, "the member `has_mass` of the system would be ignored: it must be public and const: bool has_mass() const");
  static_assert(!MentionsStiffJacobian<F> || (HasStiffJacobian<F, X> && IsSplit<F, X>),
                "the member `stiff_jacobian` of the system would be ignored: it must be public, and `stiff` and "
                "`nonstiff` beside it: void stiff_jacobian(Real t, const X& x, std::span<Real> rows)");
  static_assert(!(MentionsStiff<F> || MentionsNonstiff<F>) || IsSplit<F, X>,
                "the parts of the system would be ignored: a split system has two public members: void stiff(Real t, "
                "const X& x, X& dxdt); void nonstiff(Real t, const X& x, X& dxdt)");
}

}  // namespace continuo
