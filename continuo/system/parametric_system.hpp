// A system with constants: x' = f(t, x, p), with p that studies and boundary-value problems may move. Made from a
// lambda, from any System, or from a model; its type says nothing of where it came from, so that whatever takes it is
// compiled once.
//
//   const auto decay = parametric_system(1, [](double, auto x, auto p, auto dxdt) { dxdt[0] = -p[0] * x[0]; }, {2.0});
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// Some numbers to read: states, constants.
using Values = std::span<const double>;

/// A system x' = f(t, x, p) with its constants p and the derivatives that it knows. Functions that are not set are not
/// known.
struct ParametricSystem {
  std::size_t size = 0;             // n: components of x
  std::vector<double> constants{};  // m: p as it is unless a study says otherwise
  /// dxdt = f(t, x, p)
  std::function<void(double t, Values x, Values p, std::span<double> dxdt)> derivative{};

  // What may be missing.
  /// So many components at the end of x are unknowns of algebraic equations: theirs read 0 = f_i(t, x, p), of index 1.
  std::size_t algebraic = 0;
  /// Where df/dx may differ from zero; empty: anywhere.
  SparsePattern pattern{};
  /// The entries of df/dx in the order of the pattern, or row by row; else by differences.
  std::function<void(double t, Values x, Values p, std::span<double> entries)> jacobian{};
  /// df/dp, n * m row by row; else by differences.
  std::function<void(double t, Values x, Values p, std::span<double> rows)> constant_jacobian{};
  std::vector<std::string> names{};           // of the components
  std::vector<std::string> constant_names{};  // of the constants
  /// How far each component goes on within a period, as angles do by 2 pi where something turns over: f is the same
  /// there. Empty where an orbit comes back to where it was. Only what solves for orbits reads it.
  std::vector<double> advance{};
  /// So many conservation laws are held (conservation_laws.hpp), what is off dies away at this rate: as many
  /// eigenvalues are minus that, which say nothing of the system.
  std::size_t conserved = 0;
  double conserved_rate = 0;  // per time

  /// The number of components with a derivative.
  [[nodiscard]] std::size_t differential() const { return size - algebraic; }
  /// The number of constants.
  [[nodiscard]] std::size_t parameters() const { return constants.size(); }
  /// `x[i]` where it has none.
  [[nodiscard]] std::string name(std::size_t i) const;
  /// `p[i]` where it has none.
  [[nodiscard]] std::string constant_name(std::size_t i) const;
};

/// f called as f(t, x, p, dxdt) with spans.
template <class F>
  requires std::invocable<F&, double, Values, Values, std::span<double>>
[[nodiscard]] ParametricSystem parametric_system(std::size_t size, F f, std::vector<double> constants = {}) {
  return {.size = size, .constants = std::move(constants), .derivative = std::move(f)};
}

/// Any System for std::vector<double>, with the Jacobian and the names it has.
template <RightHandSide<std::vector<double>> System>
[[nodiscard]] ParametricSystem parametric_system(std::size_t size, System system) {
  using X = std::vector<double>;
  struct Shared {
    System system;
    X x, dxdt;
  };
  const auto shared = std::make_shared<Shared>(Shared{std::move(system), X(size), X(size)});
  ParametricSystem result{.size = size};
  result.derivative = [shared](double t, Values x, Values, std::span<double> dxdt) {
    shared->x.assign(x.begin(), x.end());
    evaluate(shared->system, t, shared->x, shared->dxdt);
    std::copy(shared->dxdt.begin(), shared->dxdt.end(), dxdt.begin());
  };
  if constexpr (HasSparseJacobian<System, X>) {
    result.pattern = shared->system.jacobian_pattern();
    result.jacobian = [shared](double t, Values x, Values, std::span<double> entries) {
      shared->x.assign(x.begin(), x.end());
      shared->system.jacobian_values(t, shared->x, entries);
    };
  } else if constexpr (HasJacobian<System, X>) {
    result.jacobian = [shared](double t, Values x, Values, std::span<double> rows) {
      shared->x.assign(x.begin(), x.end());
      shared->system.jacobian(t, shared->x, rows);
    };
  }
  if constexpr (Named<System>)
    for (std::size_t i = 0; i < size; ++i) result.names.push_back(component_name(shared->system, i));
  return result;
}

/// df/dx, n * n row by row, exact where the system gives it, else by central differences. `scale` (of each component,
/// may be empty) says what is small.
[[nodiscard]] std::vector<double> jacobian_of(const ParametricSystem& system, double t, Values x, Values p,
                                              Values scale = {});
/// df/dp, n * m row by row. Without a `scale` a constant is as large as it is now, which says nothing near zero.
[[nodiscard]] std::vector<double> constant_jacobian_of(const ParametricSystem& system, double t, Values x, Values p,
                                                       Values scale = {});

}  // namespace continuo
