// Tests the mass matrix of implicit equations for singularity at the start of a run.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <continuo/numerics/finite.hpp>
#include <continuo/simulation/program/singular_mass.hpp>

namespace continuo::model {

namespace {

/// Rows and then columns to a largest entry of 1: units of the equations and of their variables say nothing. False
/// where one is zero.
bool equilibrate(std::vector<double>& a, std::size_t n) {
  for (const auto& [line, along] : {std::pair(n, std::size_t{1}), std::pair(std::size_t{1}, n)}) {
    for (std::size_t i = 0; i < n; ++i) {
      double largest = 0;
      for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(a[i * line + j * along]));
      if (largest == 0) return false;
      for (std::size_t j = 0; j < n; ++j) a[i * line + j * along] /= largest;
    }
  }
  return true;
}

/// By elimination with exchange of rows and columns, whose pivots show the rank: those of a singular matrix end with
/// what rounding leaves, a modest multiple of n*eps times the largest entry (N. Higham, Accuracy and Stability of
/// Numerical Algorithms, 2nd ed., section 9.3).
bool is_singular(std::vector<double> a, std::size_t n) {
  if (n == 1) return a.front() == 0;
  if (!equilibrate(a, n)) return true;
  const double zero = 16 * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t row = k, column = k;
    for (std::size_t i = k; i < n; ++i)
      for (std::size_t j = k; j < n; ++j)
        if (std::abs(a[i * n + j]) > std::abs(a[row * n + column])) row = i, column = j;
    if (std::abs(a[row * n + column]) <= zero) return true;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[row * n + j]);
    for (std::size_t i = 0; i < n; ++i) std::swap(a[i * n + k], a[i * n + column]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
    }
  }
  return false;
}

bool is_known_at_start(const Model& model, const MassMatrix& mass) {
  const Layout& layout = model.layout;
  return std::ranges::none_of(variables_of(model.graph, mass.coefficients), [&](std::uint32_t variable) {
    const bool unknown = variable >= layout.unknowns && variable < layout.parameters;
    const bool state = variable >= layout.states && variable < layout.unknowns;
    return unknown || (state && model.needs_boundary_solver());
  });
}

/// `initially`, `at` or `every` at the start itself: the equations are not asked before it.
bool acts_at_start(const Model& model, std::span<const double> variables) {
  return std::ranges::any_of(model.schedule, [&](const Scheduled& event) {
    const std::optional<Setting>& time = event.kind == Scheduled::Kind::every ? event.first : event.time;
    if (event.kind == Scheduled::Kind::initially) return true;
    return time && evaluate(model, time->node, variables) == variables[Layout::time];
  });
}

std::string all_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "`" : i + 1 == names.size() ? " and `" : ", `") + names[i] + "`";
  return text;
}

}  // namespace

std::optional<Diagnostic> singular_mass(const Model& model, std::span<const double> variables) {
  if (model.masses.empty() || acts_at_start(model, variables)) return std::nullopt;
  for (const MassMatrix& mass : model.masses) {
    if (mass.mode != model.start_mode || !is_known_at_start(model, mass)) continue;
    const std::vector<double> a = evaluate(model, mass.coefficients, variables);
    if (!all_finite(a) || !is_singular(a, mass.names.size())) continue;
    const bool alone = mass.names.size() == 1;
    return error("E335", mass.span,
                 fmt::format("{} {} not determined at the start", all_of(mass.names), alone ? "is" : "are"),
                 alone ? "what stands before it is 0" : "the matrix before them is singular",
                 "look at the parameters it is made of; where it is 0 on purpose, write an `unknown` and 0 = ...");
  }
  return std::nullopt;
}

}  // namespace continuo::model
