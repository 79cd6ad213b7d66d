// Sums of states that never change: the totals of a reaction network, momenta. Each law w . x = c says that an equation
// depends on the others: df/dx is singular everywhere, and no equilibrium and no orbit stands by itself, for there is
// one for each value of c. With c that of the initial state there is one.
//
//   const auto laws = conservation_laws_of(system, start);
//   const ParametricSystem held = holding(system, laws, [&](Values p) { return start_at(p); });
//
// C. Reder, "Metabolic control theory: a structural approach", J. Theor. Biol. 135 (1988); H. M. Sauro, B. Ingalls,
// "Conservation analysis in biochemical networks", Biophys. Chem. 109 (2004).
#pragma once
#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// A linear combination of the components that the motion does not change.
struct ConservationLaw {
  std::vector<double> weights;  // of the components; 0 of the unknowns of algebraic equations
  double value = 0;             // of the sum, at the start
};

/// Those linear combinations w with w . f(t, x, p) = 0 for any t, x and constants, from f at random places and
/// confirmed at others, also far off. Empty where there is none, or more components than are worth it (400).
[[nodiscard]] std::vector<ConservationLaw> conservation_laws_of(const ParametricSystem& system,
                                                                std::span<const double> start);

/// "a + 2 c", "v1 - v2".
[[nodiscard]] std::string law_text(const ParametricSystem& system, const ConservationLaw& law);

/// The same motion where the laws hold, and one that comes to there where they do not: x' = f - r M (W x - c(p)), M a
/// right inverse of W. As W f = 0, so W (df/dx - r M W) = -r W: each law turns one eigenvalue 0 into -r and leaves the
/// others as they are. `start`: the initial state, which gives c, by the constants. The studies leave out what
/// `conserved` in the system counts.
[[nodiscard]] ParametricSystem holding(const ParametricSystem& system, const std::vector<ConservationLaw>& laws,
                                       std::function<std::vector<double>(Values p)> start);

/// Takes out the eigenvalues that come from laws that are held: those nearest to `own`, which are so many.
void leave_out_conserved(const ParametricSystem& system, std::complex<double> own,
                         std::vector<std::complex<double>>& eigenvalues);

}  // namespace continuo::studies
