// continuo/solve/correction.hpp
// What a run holds its states to: invariants, by a projection onto them, and the signs of components.
//
//   auto onto_circle = [](double, X& x) { const double r = std::hypot(x[0], x[1]); x[0] /= r, x[1] /= r; };
//   solve(f, x0, {0, 10}, Bdf{}, {.projection = onto_circle});
//   solve(f, x0, {0, 10}, Radau{}, {.signs = {Sign::nonnegative, Sign::any}});
#pragma once
#include <concepts>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>

namespace continuo {

/// A function (t, x) that moves x onto the invariants of a system. It returns nothing, or a bool: `false` where it
/// finds no state there. After each step whose error is within the tolerance it moves the end of the step; one that it
/// moves by more than the tolerance (root mean square) is rejected. It moves a state of its invariants by no more than
/// rounding.
template <State X>
class Projection {
 public:
  Projection() = default;
  /// No projection.
  explicit(false) Projection(std::nullptr_t) {}
  /// Any function of (t, X& x) that returns nothing or a bool; anything else is refused by the compiler.
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, Projection>)
  explicit(false) Projection(F&& f) {
    if constexpr (check<std::remove_cvref_t<F>>()) {
      if constexpr (requires { f.target_type(); }) {  // a std::function may be empty
        if (!f) return;
      }
      if constexpr (std::same_as<std::invoke_result_t<std::remove_cvref_t<F>&, Scalar<X>, X&>, bool>) {
        f_ = std::forward<F>(f);
      } else {
        f_ = [call = std::forward<F>(f)](Scalar<X> t, X& x) mutable {
          call(t, x);
          return true;
        };
      }
    }
  }

  /// Whether there is a function.
  explicit operator bool() const { return static_cast<bool>(f_); }
  /// Moves x onto the invariants at the time t. False where no state there was found.
  bool operator()(const Scalar<X>& t, X& x) const { return f_(t, x); }

 private:
  template <class F>
  [[nodiscard]] static consteval bool check() {
    constexpr bool callable = std::invocable<F&, Scalar<X>, X&>;
    static_assert(callable,
                  "a projection is called as projection(t, x), with x of the type of the state x0, and moves x");
    if constexpr (callable) {
      using Result = std::invoke_result_t<F&, Scalar<X>, X&>;
      constexpr bool moves = !std::invocable<F&, Scalar<X>, X>;
      static_assert(moves,
                    "the projection takes x by value or as a constant, so that its result is lost: declare X& x");
      constexpr bool usable = std::same_as<Result, void> || std::same_as<Result, bool>;
      static_assert(usable,
                    "a projection moves x itself, and returns nothing, or a bool of which false means that it "
                    "has found no state");
      return moves && usable;
    } else {
      return false;
    }
  }

  std::function<bool(Scalar<X>, X&)> f_;
};

/// The values that a component may have. A step that ends on the wrong side of zero by more than the tolerance is
/// rejected, by less it is set to zero, or, where zero is not allowed, to a tenth of the tolerance.
enum class Sign { any, nonnegative, positive, nonpositive, negative };

namespace detail {

template <class Real>
[[nodiscard]] bool has_sign(Sign sign, const Real& value) {
  switch (sign) {
    case Sign::nonnegative:
      return value >= Real(0);
    case Sign::positive:
      return value > Real(0);
    case Sign::nonpositive:
      return value <= Real(0);
    case Sign::negative:
      return value < Real(0);
    case Sign::any:
      break;
  }
  return true;
}
[[nodiscard]] inline const char* words_for(Sign sign) {
  switch (sign) {
    case Sign::nonnegative:
      return "nonnegative";
    case Sign::positive:
      return "positive";
    case Sign::nonpositive:
      return "nonpositive";
    case Sign::negative:
      return "negative";
    case Sign::any:
      break;
  }
  return "any";
}

}  // namespace detail

}  // namespace continuo
