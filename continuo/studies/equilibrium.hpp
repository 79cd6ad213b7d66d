// Where a system comes to rest: f(t, x, p) = 0, by damped Newton from one or many starts, and what happens nearby.
//
//   const auto found = find_equilibria(lorenz, {.low = {-20, -20, 0}, .high = {20, 20, 40}});
//   for (const Equilibrium& e : found.equilibria) fmt::print("{} {}\n", e.x[0], to_string(e.stability));
#pragma once
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include <continuo/studies/equilibria/algebraic_elimination.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// By the eigenvalues of df/dx: `asymptotically_stable` all on the left, `unstable` one or more on the right, `saddle`
/// some on either side, `undecided` one on the imaginary axis and none on the right (then the linear part does not
/// say).
enum class Stability { asymptotically_stable, unstable, saddle, undecided };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(Stability stability);
/// `undecided` where a real part is within `slack` times the largest eigenvalue of zero, or times `size` where that is
/// more.
[[nodiscard]] Stability stability_of(const std::vector<std::complex<double>>& eigenvalues, double slack = 1e-9,
                                     double size = 0);

/// A state at which f is zero, with the eigenvalues there.
struct Equilibrium {
  std::vector<double> x;  // unknowns of algebraic equations among them
  /// Of df/dx, by descending real part; with algebraic equations of what is left when their unknowns are taken out.
  /// None where `undetermined` is not empty.
  std::vector<std::complex<double>> eigenvalues;
  Stability stability = Stability::undecided;
  bool isolated = true;         // false: df/dx is singular there, a whole curve may be at rest, or a fold is near
  Undetermined undetermined{};  // by the algebraic equations there
};

/// How one search ended.
enum class EquilibriumEnding { found, no_descent, not_finite, too_many };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(EquilibriumEnding ending);

/// One search for an equilibrium.
struct EquilibriumSearch {
  EquilibriumEnding ending = EquilibriumEnding::too_many;
  std::vector<double> x;  // where it ended
  double residual = 0;    // the largest |f_i| there
  std::size_t worst = 0;  // and of which component
  std::size_t iterations = 0;
};

/// Damped Newton from x. Steps are shortened until |f| falls, each component measured by its size at the start; where
/// df/dx is singular they follow the least-squares solution (Levenberg, Marquardt).
[[nodiscard]] EquilibriumSearch find_equilibrium(const ParametricSystem& system, std::vector<double> x, Values p,
                                                 double t = 0);

/// Solves the algebraic equations for their unknowns, the other components of x stay.
[[nodiscard]] EquilibriumSearch find_unknowns(const ParametricSystem& system, const std::vector<double>& x, Values p,
                                              double t = 0);

/// The eigenvalues and what follows from them.
[[nodiscard]] Equilibrium describe_equilibrium(const ParametricSystem& system, std::vector<double> x, Values p,
                                               double t = 0);

/// A box to search: `starts` points that fill it evenly (a Halton sequence, the same at every call), after `first`.
struct EquilibriumBox {
  std::vector<double> low, high;
  std::size_t starts = 200;
  std::vector<double> first{};  // tried before all others; may be empty
  double t = 0;                 // where f depends on time: at this one
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // from 0 to 1
};

/// The equilibria that a search of a box has found. Others may exist between its starting points.
struct Equilibria {
  std::vector<Equilibrium> equilibria;  // each once, ascending in the first component in which they differ
  std::size_t searches = 0, arrived = 0, outside = 0;  // outside of the box: of those that arrived
  EquilibriumSearch nearest;                           // where none was found: the search that came closest
};
/// Searches the box. Each of its starts costs a damped Newton iteration.
[[nodiscard]] Equilibria find_equilibria(const ParametricSystem& system, const EquilibriumBox& box);

/// x' = A u, y = C u near (x, p): the matrices of the linear system, the inputs being the constants p. Unknowns of
/// algebraic equations are taken out; where these do not determine them there are no matrices.
struct Linearization {
  std::size_t states = 0, inputs = 0;
  std::vector<double> a;  // states * states, row by row
  std::vector<double> b;  // states * inputs
  Undetermined undetermined{};
};
/// The linear system at (t, x, p), which need not be an equilibrium.
[[nodiscard]] Linearization linearize(const ParametricSystem& system, Values x, Values p, double t = 0);

/// One eigenvalue, or a pair of conjugates, as motion: exp(real t) cos(imag t).
struct MotionMode {
  std::complex<double> eigenvalue;          // imaginary part >= 0
  double frequency = 0;                     // |lambda| / 2 pi, undamped; 0 where it does not oscillate
  double damping = 0;                       // ratio -real / |lambda|: 1 where it does not oscillate and decays
  double time_constant = 0;                 // -1 / real: to 1/e; negative where it grows; infinite on the axis
  std::vector<std::complex<double>> shape;  // the eigenvector
};
/// The modes of the matrix a, n * n row by row.
[[nodiscard]] std::vector<MotionMode> modes_of(const std::vector<double>& a, std::size_t n);

}  // namespace continuo::studies
