// solve() with the method by name, for systems of run-time size in float, double or long double: every method compiled
// once for all studies.
//
//   const auto oscillator = named_system<double>(2, [](auto, auto x, auto dxdt) { dxdt[0] = x[1], dxdt[1] = -x[0]; });
//   const auto solution = named_solve("rk4", oscillator, {1, 0}, {0, 10}, {.step = 0.01});
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/solve/choice.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/solution.hpp>
#include <continuo/system/system.hpp>

namespace continuo::studies {

/// x' = f(t, x) with what the methods may ask for, its type forgotten.
template <class Real>
struct NamedSystem {
  std::size_t size = 0;
  std::function<void(Real t, std::span<const Real> x, std::span<Real> dxdt)> derivative{};

  // What may be missing.
  /// df/dx row by row; else by central differences.
  std::function<void(Real t, std::span<const Real> x, std::span<Real> rows)> given_jacobian{};
  std::vector<PositionVelocity> pairs{};           // for methods of x'' = a
  bool velocity_free = false;                      // no acceleration reads a velocity
  std::function<std::string(std::size_t)> name{};  // of a component; asked where a run fails

  // A System, as solve asks for it.
  using X = std::vector<Real>;
  void operator()(const Real& t, const X& x, X& dxdt) { derivative(t, x, dxdt); }
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return pairs.size(); }
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t) const { return pairs[i]; }
  [[nodiscard]] bool ignores_velocity(const X&) const { return velocity_free; }
  [[nodiscard]] std::string component_name(std::size_t i) const {
    return name ? name(i) : "x[" + std::to_string(i) + "]";
  }
  void jacobian(const Real& t, const X& x, std::span<Real> rows) {
    if (given_jacobian) return given_jacobian(t, x, rows);
    // The third root of epsilon balances the error of a central difference with its rounding.
    const Real relative = std::cbrt(std::numeric_limits<Real>::epsilon());
    X moved = x, above(size), below(size);
    for (std::size_t j = 0; j < size; ++j) {
      const Real increment = relative * std::max(std::abs(x[j]), Real(1));
      moved[j] = x[j] + increment;
      const Real up = moved[j];
      derivative(t, moved, above);
      moved[j] = x[j] - increment;
      const Real width = up - moved[j];
      derivative(t, moved, below);
      moved[j] = x[j];
      for (std::size_t i = 0; i < size; ++i) rows[i * size + j] = (above[i] - below[i]) / width;
    }
  }
};

/// f called as f(t, x, dxdt) with spans.
template <class Real, class F>
[[nodiscard]] NamedSystem<Real> named_system(std::size_t size, F f) {
  return {.size = size, .derivative = std::move(f)};
}
/// The first half of the state are positions, the second their velocities; the accelerations read no velocity unless
/// said otherwise.
template <class Real, class F>
[[nodiscard]] NamedSystem<Real> named_motion(std::size_t size, F f, bool velocity_free = true) {
  NamedSystem<Real> system{.size = size, .derivative = std::move(f), .velocity_free = velocity_free};
  for (std::size_t i = 0; 2 * i < size; ++i) system.pairs.push_back({i, i + size / 2});
  return system;
}

/// As solve(). A name that is none ends as Ending::invalid_input, and so does a method for x'' = a where there are no
/// pairs.
template <class Real>
[[nodiscard]] Solution<std::vector<Real>> named_solve(std::string_view method, const NamedSystem<Real>& system,
                                                      std::type_identity_t<std::vector<Real>> x0,
                                                      std::type_identity_t<Interval<Real>> interval,
                                                      const std::type_identity_t<Options<std::vector<Real>>>& options);

/// The method chosen as solve() does where none is named.
template <class Real>
[[nodiscard]] Solution<std::vector<Real>> named_solve(const NamedSystem<Real>& system,
                                                      std::type_identity_t<std::vector<Real>> x0,
                                                      std::type_identity_t<Interval<Real>> interval,
                                                      const std::type_identity_t<Options<std::vector<Real>>>& options) {
  const std::string_view method =
      choose_method({.size = system.size,
                     .rtol = static_cast<double>(options.rtol),
                     .accelerations = system.velocity_free && 2 * system.pairs.size() == system.size})
          .method;
  return named_solve(method, system, std::move(x0), interval, options);
}

extern template Solution<std::vector<float>> named_solve(std::string_view, const NamedSystem<float>&,
                                                         std::vector<float>, Interval<float>,
                                                         const Options<std::vector<float>>&);
extern template Solution<std::vector<double>> named_solve(std::string_view, const NamedSystem<double>&,
                                                          std::vector<double>, Interval<double>,
                                                          const Options<std::vector<double>>&);
extern template Solution<std::vector<long double>> named_solve(std::string_view, const NamedSystem<long double>&,
                                                               std::vector<long double>, Interval<long double>,
                                                               const Options<std::vector<long double>>&);

}  // namespace continuo::studies
