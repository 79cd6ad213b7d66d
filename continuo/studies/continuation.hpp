// How equilibria move when one constant does: a branch of f(x, p) = 0 followed round its folds by pseudo-arclength,
// with the places where its stability changes: folds, Hopf points, crossings with other branches. H. B. Keller,
// "Numerical solution of bifurcation and nonlinear eigenvalue problems" (1977); Yu. A. Kuznetsov, "Elements of Applied
// Bifurcation Theory", chapter 10.
#pragma once
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// A point of a branch of equilibria.
struct BranchPoint {
  double constant;  // its value
  std::vector<double> x;
  std::vector<std::complex<double>> eigenvalues;
  Stability stability;
};

/// `fold`: the branch turns round in the constant. `hopf`: a pair of eigenvalues crosses the imaginary axis; an orbit
/// with `frequency` is born. `transcritical`: another branch passes through. `pitchfork`: one of the two branches turns
/// round there. `crossing`: another branch is there, but its direction was not found.
enum class Bifurcation { fold, hopf, transcritical, pitchfork, crossing };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(Bifurcation kind);

/// A point of a branch at which its stability changes.
struct BifurcationPoint {
  Bifurcation kind;
  BranchPoint at;
  double frequency = 0;  // of a Hopf point: imaginary part / 2 pi
  std::size_t next = 0;  // of the branch's points, the first behind it
  /// Of the normal form: of a fold a, of a Hopf point the first Lyapunov coefficient, 0 where
  /// it is no more than rounding leaves.
  std::optional<double> coefficient{};
  std::vector<double> other{};  // the direction of the other branch: x, then the constant
};

/// A branch of equilibria over one constant.
struct Branch {
  std::vector<BranchPoint> points;
  std::vector<BifurcationPoint> bifurcations;  // in the order of the branch
  bool closed = false;                         // its first point is also its last
  Status status{};                             // a failure where it neither left the range of the constant nor closed
};

/// Which constant moves, over which range, and how far the branch may be followed.
struct ContinuationOptions {
  std::size_t constant = 0;  // which of the system's
  double low = 0, high = 1;  // of the constant
  // In parts of high - low, and of the size of x.
  double first_step = 0.01, least_step = 1e-7, largest_step = 0.05;
  std::size_t most_points = 5000;
  double t = 0;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // of the range that has been covered
};

/// From an equilibrium (near x at the constant's present value) in both directions.
[[nodiscard]] Branch continue_equilibrium(const ParametricSystem& system, std::vector<double> x,
                                          const ContinuationOptions& options);
/// The other branch through a transcritical point or a pitchfork.
[[nodiscard]] Branch continue_equilibrium(const ParametricSystem& system, const BifurcationPoint& from,
                                          const ContinuationOptions& options);

/// An equilibrium near x where the constant has this value.
struct BranchStart {
  double constant;
  std::vector<double> x;
};
/// Whether the branch passes there.
[[nodiscard]] bool passes_through(const ParametricSystem& system, const Branch& branch, const BranchStart& place,
                                  const ContinuationOptions& options);
/// Branches through several starts, and those that cross them, each once.
struct BranchOfDiagram {
  Branch branch;
  std::vector<std::size_t> starts;       // those that lie on it
  std::optional<std::size_t> crossed{};  // it was found where it crosses this branch
};
/// At most `most_branches`.
/// Follows all starts, then the branches that cross them, at most `most_branches`.
[[nodiscard]] std::vector<BranchOfDiagram> continue_equilibria(const ParametricSystem& system,
                                                               const std::vector<BranchStart>& starts,
                                                               const ContinuationOptions& options,
                                                               std::size_t most_branches = 30);

}  // namespace continuo::studies
