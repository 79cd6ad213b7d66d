// Where two branches of f(z) = 0, n equations of n + 1 unknowns, cross: found as the solution of equations that are not
// singular there, and the directions of both. Internal to continuation.
//
// At a crossing the rows of df/dz have one combination psi that vanishes: f + beta psi = 0, (df/dz)^T psi = 0, psi^2 =
// 1 are 2 n + 2 equations for z, beta, psi. The directions d of the branches have df/dz d = 0 and d^T H d = 0 with H =
// psi . d^2f/dz^2. G. Moore, "The numerical treatment of non-trivial bifurcation points", Numer. Funct. Anal. Optim. 2
// (1980) 441-472; H. B. Keller (1977).
#pragma once
#include <functional>
#include <optional>
#include <vector>

namespace continuo::studies::detail {

struct CrossingEquations {
  std::size_t n = 0;
  std::function<std::vector<double>(const std::vector<double>& z)> f{};         // n numbers
  std::function<std::vector<double>(const std::vector<double>& z)> jacobian{};  // n rows of n + 1
};

struct Crossing {
  std::vector<double> z;
  std::vector<double> own, other;  // directions of length 1: of the branch that was followed, of the other
};

/// Near z, on a branch in the direction `along`; z in units in which all is about 1. Nothing where the iteration fails,
/// goes far away, or the branches touch rather than cross.
[[nodiscard]] std::optional<Crossing> find_crossing(const CrossingEquations& equations, std::vector<double> z,
                                                    const std::vector<double>& along);

}  // namespace continuo::studies::detail
