#pragma once
#include <string_view>

#include <continuo/methods/implicit/krylov_equations.hpp>
#include <continuo/methods/multistep/bdf.hpp>

namespace continuo {

/// Backward differentiation for systems too large for a matrix: the same formulas, their equations solved by GMRES.
struct BdfKrylov : BackwardDifferentiation<KrylovEquations> {
  static constexpr std::string_view name = "bdf_krylov";
};

}  // namespace continuo
