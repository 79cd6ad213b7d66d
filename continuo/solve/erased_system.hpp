// continuo/solve/erased_system.hpp
// A type-erased right-hand side. Its runs by the usual methods, for states of up to four numbers in an array and for
// vectors, are in the library and need not be compiled with the program:
//
//   ErasedSystem<std::vector<double>> f([](double, const auto& x, auto& dxdt) { dxdt[0] = -x[0]; });
//   auto solution = solve(f, std::vector{1.0}, {0, 10}, Dop853{});
//
// `solve` takes this way by itself in a program that is compiled without optimization, as one does while it is being
// written: it is then compiled in a third of the time, and the run is an optimized one. Both ways give the same bits.
// An optimized program keeps f compiled into the steps, which a small system needs to be fast.
#pragma once
#include <array>
#include <concepts>
#include <functional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <continuo/numerics/state.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/solution.hpp>
#include <continuo/system/check_system.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

struct Dop853;
struct Dop853Radau;
struct DormandPrince5;
struct Rk4;
struct Tsitouras5;
struct Tsitouras5Bdf;
struct Tsitouras5Rodas5P;

/// A right-hand side that says nothing of itself, by a call through a pointer.
template <State X>
class ErasedSystem {
 public:
  /// Keeps a copy of f.
  template <class F>
    requires(!std::same_as<F, ErasedSystem>) && std::copy_constructible<F> && RightHandSide<F, X>
  explicit ErasedSystem(F f)
      : f_([f = std::move(f)](const Scalar<X>& t, const X& x, X& dxdt) mutable {
          if constexpr (WritesDerivative<F, X>) {
            f(t, x, dxdt);
          } else {
            dxdt = f(t, x);
          }
        }) {}

  /// dxdt = f(t, x), of the size that f gives it.
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) { f_(t, x, dxdt); }

 private:
  std::function<void(const Scalar<X>&, const X&, X&)> f_;
};

namespace detail {

template <class T, class Types>
inline constexpr bool is_one_of = false;
template <class T, class... Types>
inline constexpr bool is_one_of<T, std::tuple<Types...>> = (std::same_as<T, Types> || ...);

using StatesInLibrary = std::tuple<std::array<double, 1>, std::array<double, 2>, std::array<double, 3>,
                                   std::array<double, 4>, std::vector<double>>;
using MethodsInLibrary =
    std::tuple<Tsitouras5Rodas5P, Dop853Radau, Tsitouras5Bdf, Dop853, DormandPrince5, Rk4, Tsitouras5>;

#ifdef __OPTIMIZE__
constexpr bool program_is_optimized = true;
#else
constexpr bool program_is_optimized = false;
#endif

/// Whether `solve` calls the library for this run.
template <class F, class X, class M, bool Optimized>
inline constexpr bool runs_in_library =
    is_one_of<X, StatesInLibrary> && is_one_of<M, MethodsInLibrary> &&
    (std::same_as<F, ErasedSystem<X>> || (!Optimized && IsOnlyRightHandSide<F> && std::copy_constructible<F>));

/// The runs of an ErasedSystem that the library has.
template <State X>
struct RunsInLibrary {
  /// That by the method of this name.
  [[nodiscard]] static Solution<X> run(ErasedSystem<X> f, X x0, Interval<Scalar<X>> interval, std::string_view method,
                                       Options<X> options);
};

extern template struct RunsInLibrary<std::array<double, 1>>;
extern template struct RunsInLibrary<std::array<double, 2>>;
extern template struct RunsInLibrary<std::array<double, 3>>;
extern template struct RunsInLibrary<std::array<double, 4>>;
extern template struct RunsInLibrary<std::vector<double>>;

}  // namespace detail

}  // namespace continuo
