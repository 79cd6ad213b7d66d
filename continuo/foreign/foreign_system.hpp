// continuo/foreign/foreign_system.hpp
// A system whose functions come from another language at run time: pointers to functions, each with data of its own.
//
//   ForeignFunctions functions{.size = 2, .derivative = {f, user}};
//   const ForeignRun::Pointer run = begin_foreign_run(std::make_shared<ForeignFunctions>(functions), {1, 0}, {0, 10},
//                                                     "dop853", options);
//
// A function that fails writes NaN and sets Options::interrupt: the run ends at once, and keeps what was computed.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// A function of (t, x) that writes numbers, and the data that it gets as `user`.
struct ForeignFunction {
  void (*call)(double t, const double* x, double* result, void* user) = nullptr;  // null: there is none
  void* user = nullptr;                                                           // handed to it
};

/// The functions of a system, and what is known of it.
struct ForeignFunctions {
  std::size_t size = 0;                   // the number of components
  ForeignFunction derivative{};           // writes dx/dt; with a mass M, M dx/dt
  ForeignFunction jacobian{};             // writes df/dx row by row into n*n zeros
  ForeignFunction jacobian_values{};      // writes the entries of the pattern in its order, into zeros
  SparsePattern pattern{};                // of df/dx; empty: not known. With it, jacobian_values may be missing
  std::vector<PositionVelocity> pairs{};  // for methods of x'' = a(t, x)
  bool ignores_velocity = false;          // no acceleration reads a velocity
  std::vector<double> mass{};             // the diagonal of M, 0 for an algebraic equation; empty: the identity
  std::vector<double> mass_rows{};        // M row by row, where it is no diagonal
  std::vector<std::string> names{};       // of the components; empty: x[0], x[1], ...
};

/// A system as solve asks for it, by these functions. M is the identity or a diagonal.
class ForeignSystem {
 public:
  using X = std::vector<double>;

  /// The functions must outlive their runs, which share the description of them.
  explicit ForeignSystem(std::shared_ptr<const ForeignFunctions> functions)
      : functions_(std::move(functions)), derivative_(functions_->derivative) {}

  /// dx/dt, or M dx/dt where there is a mass.
  void operator()(double t, const X& x, X& dxdt) { derivative_.call(t, x.data(), dxdt.data(), derivative_.user); }

  /// Why there is no state of this size; empty where there is.
  [[nodiscard]] std::string size_problem(std::size_t size) const {
    if (size == functions_->size) return {};
    return "f is one of " + std::to_string(functions_->size) + " components, and the state has " + std::to_string(size);
  }
  /// The name of component i.
  [[nodiscard]] std::string component_name(std::size_t i) const {
    return i < functions_->names.size() ? functions_->names[i] : "y[" + std::to_string(i) + "]";
  }
  /// The number of pairs of a position and its velocity.
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return functions_->pairs.size(); }
  /// Pair i.
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t) const { return functions_->pairs[i]; }
  /// Whether no acceleration reads a velocity.
  [[nodiscard]] bool ignores_velocity(const X&) const { return functions_->ignores_velocity; }
  /// Whether one of the functions is df/dx, in either form.
  [[nodiscard]] bool gives_jacobian() const { return functions_->jacobian.call || functions_->jacobian_values.call; }
  /// df/dx row by row, from the entries of the pattern where these are given.
  void jacobian(double t, const X& x, std::span<double> rows) {
    if (functions_->jacobian.call)
      return functions_->jacobian.call(t, x.data(), rows.data(), functions_->jacobian.user);
    values_.assign(functions_->pattern.entries(), 0);
    jacobian_values(t, x, values_);
    const SparsePattern& pattern = functions_->pattern;
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) rows[pattern.row(p) * x.size() + j] = values_[p];
  }
  /// Where df/dx may differ from zero; empty where that is not known.
  [[nodiscard]] const SparsePattern& jacobian_pattern() const { return functions_->pattern; }
  /// The entries of df/dx in the order of the pattern, from the rows where these are given.
  void jacobian_values(double t, const X& x, std::span<double> values) {
    if (functions_->jacobian_values.call)
      return functions_->jacobian_values.call(t, x.data(), values.data(), functions_->jacobian_values.user);
    values_.assign(x.size() * x.size(), 0);
    functions_->jacobian.call(t, x.data(), values_.data(), functions_->jacobian.user);
    const SparsePattern& pattern = functions_->pattern;
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
        values[p] = values_[pattern.row(p) * x.size() + j];
  }
  /// Whether M is not the identity.
  [[nodiscard]] bool has_mass() const { return !functions_->mass.empty(); }
  /// Entry i of the diagonal of M.
  [[nodiscard]] double mass(std::size_t i) const { return has_mass() ? functions_->mass[i] : 1; }

 private:
  std::shared_ptr<const ForeignFunctions> functions_;
  ForeignFunction derivative_;
  X values_;  // of a Jacobian in the other form
};

/// The same with a mass that is a full matrix: for implicit methods alone.
class ForeignSystemWithMatrix {
 public:
  using X = std::vector<double>;

  /// The functions must outlive their runs, which share the description of them.
  explicit ForeignSystemWithMatrix(std::shared_ptr<const ForeignFunctions> functions)
      : functions_(std::move(functions)) {}

  /// M dx/dt.
  void operator()(double t, const X& x, X& dxdt) {
    functions_->derivative.call(t, x.data(), dxdt.data(), functions_->derivative.user);
  }
  /// Why there is no state of this size; empty where there is.
  [[nodiscard]] std::string size_problem(std::size_t size) const {
    if (size == functions_->size && functions_->mass_rows.size() == size * size) return {};
    return "f and its mass are those of " + std::to_string(functions_->size) + " components, and the state has " +
           std::to_string(size);
  }
  /// The name of component i.
  [[nodiscard]] std::string component_name(std::size_t i) const {
    return i < functions_->names.size() ? functions_->names[i] : "y[" + std::to_string(i) + "]";
  }
  /// Whether one of the functions is df/dx, row by row.
  [[nodiscard]] bool gives_jacobian() const { return functions_->jacobian.call != nullptr; }
  /// df/dx row by row.
  void jacobian(double t, const X& x, std::span<double> rows) {
    functions_->jacobian.call(t, x.data(), rows.data(), functions_->jacobian.user);
  }
  /// M row by row.
  void mass_matrix(std::span<double> rows) const { std::ranges::copy(functions_->mass_rows, rows.begin()); }

 private:
  std::shared_ptr<const ForeignFunctions> functions_;
};

}  // namespace continuo
