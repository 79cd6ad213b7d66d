// The unknowns of algebraic equations taken out of a linear system: near a point of x' = f(x, z, u), 0 = g(x, z, u),
// where dg/dz is regular (index 1), dz = -(dg/dz)^-1 (dg/dx dx + dg/du du), and so
//
//   dx' = (f_x - f_z g_z^-1 g_x) dx + (f_u - f_z g_z^-1 g_u) du.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace continuo::studies {

/// What a singular dg/dz leaves open, of m equations and m unknowns.
struct Undetermined {
  std::vector<std::size_t> equations;  // that say nothing that the others do not say
  std::vector<std::size_t> unknowns;   // that none is left for
};
/// `square`: dg/dz, m * m row by row. Empty lists where it is regular.
[[nodiscard]] Undetermined undetermined_by(std::span<const double> square, std::size_t m);

/// Columns: of x, `states`; of z, `unknowns`; of u, the rest.
struct LinearColumns {
  std::size_t states = 0, unknowns = 0, inputs = 0;
  [[nodiscard]] std::size_t all() const { return states + unknowns + inputs; }
};
/// The rows (of f, or of outputs) without the columns of z; `equations` are the rows of g. Empty where dg/dz is
/// singular.
[[nodiscard]] std::vector<double> without_unknowns(std::span<const double> rows, std::span<const double> equations,
                                                   const LinearColumns& columns);

}  // namespace continuo::studies
