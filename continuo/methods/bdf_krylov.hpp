#pragma once
#include <string_view>

#include <continuo/methods/bdf.hpp>
#include <continuo/methods/krylov_equations.hpp>

namespace continuo {

/// Backward differentiation for systems too large for a matrix: the same formulas, their equations solved by GMRES.
struct BdfKrylov : BackwardDifferentiation<KrylovEquations> {
  static constexpr std::string_view name = "bdf_krylov";
};

}  // namespace continuo
