// How a closed orbit changes when one constant does: a branch of orbits followed round its folds by pseudo-arclength,
// with the multipliers of each and the places where its stability changes. E. J. Doedel, H. B. Keller, J. P. Kernevez,
// "Numerical analysis and control of bifurcation problems (II)", Int. J. Bifurcation Chaos 1 (1991); Yu. A. Kuznetsov,
// "Elements of Applied Bifurcation Theory", chapters 5 and 10.
//
//   const auto orbit = find_periodic_orbit(van_der_pol, {2, 0});
//   const auto branch = continue_orbit(van_der_pol, orbit, {.low = 0.1, .high = 10});
//   for (const OrbitPoint& point : branch.points) fmt::print("{} {}\n", point.constant, point.period);
#pragma once
#include <array>
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/simulation/stepping.hpp>
#include <continuo/studies/equilibria/hopf_point.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// A point of a branch of orbits.
struct OrbitPoint {
  double constant = 0;  // its value
  double period = 0;
  std::vector<double> x;                          // a state on the orbit
  std::vector<double> low, high;                  // between which each component goes
  std::vector<std::complex<double>> multipliers;  // by descending size, without the 1 of a shift along the orbit
  bool stable = false;                            // all of them inside the unit circle
  std::vector<double> advance{};                  // as PeriodicOrbit::advance
};

/// `fold`: the branch turns round in the constant, a multiplier passes +1. `period_doubling`: one passes -1, an orbit
/// of twice the period is born. `torus`: a complex pair passes the unit circle (Neimark, Sacker). `crossing`: one
/// passes +1 and the branch goes on, another branch of orbits passes through.
/// `homoclinic`: what a branch ends at, as a start for a curve in two constants; there, of a saddle.
/// `central_homoclinic`: there, of a saddle-node, which the orbit leaves and comes back to along the direction of the
/// eigenvalue zero.
enum class OrbitBifurcation { fold, period_doubling, torus, crossing, homoclinic, central_homoclinic };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(OrbitBifurcation kind);

/// A point of a branch at which its stability changes.
struct OrbitMark {
  OrbitBifurcation kind;
  OrbitPoint at;
  double rotation = 0;  // of torus: the angle of the pair, in turns per period
  // What another branch begins from: the mesh, all that was solved for on it, the direction of this branch.
  std::vector<double> mesh{}, unknowns{}, tangent{};
  /// Of an orbit through events (hybrid_continuation.hpp): where it begins; the tangent is that of x, the period and
  /// the constant.
  std::optional<model::Instant> begin{};
};

/// Why a branch ends. `bound`: of the constant. `hopf`: the orbit has shrunk to an equilibrium. `homoclinic`: the
/// period grows while the constant comes to a standstill, the orbit nears an equilibrium on its way. `family`: the
/// constant does not change any more, orbits lie next to each other at one value. `closed`: it came back to where it
/// began. `branching`: it begins or ends on another branch of orbits. `grazing`: an event is only touched, beyond which
/// other events make other orbits.
enum class OrbitEnding {
  bound,
  hopf,
  homoclinic,
  family,
  closed,
  branching,
  grazing,
  interrupted,
  too_many_points,
  lost
};

/// How one end of a branch came about.
struct OrbitBranchEnd {
  OrbitEnding ending = OrbitEnding::lost;
  double constant = 0;      // where
  std::string reason = {};  // one sentence
  /// Of homoclinic: the last orbit.
  std::optional<OrbitMark> last = {};
};

/// A branch of orbits over one constant.
struct OrbitBranch {
  std::vector<OrbitPoint> points;
  std::vector<OrbitMark> marks;        // in the order of the branch
  std::array<OrbitBranchEnd, 2> ends;  // before the first point, after the last
  Status status{};                     // a failure where there is no branch
};

/// Which constant moves, over which range, and how far the branch may be followed.
struct OrbitContinuationOptions {
  std::size_t constant = 0;  // which of the system's
  double low = 0, high = 1;  // of the constant
  // In parts of high - low, of the period and of the size of x.
  double first_step = 0.01, least_step = 1e-7, largest_step = 0.05;
  std::size_t most_points = 2000;
  double rtol = 1e-9;  // of the integrations
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double)> progress{};  // the part of the range that has been covered
};

/// From an orbit at the constant's present value, in both directions.
[[nodiscard]] OrbitBranch continue_orbit(const ParametricSystem& system, const PeriodicOrbit& start,
                                         const OrbitContinuationOptions& options);
/// From a point of another branch, or any state next to an orbit whose period is about known.
[[nodiscard]] OrbitBranch continue_orbit(const ParametricSystem& system, const OrbitPoint& start,
                                         const OrbitContinuationOptions& options);
/// From where an equilibrium begins to oscillate: the orbits that are born there.
[[nodiscard]] OrbitBranch continue_orbit(const ParametricSystem& system, const HopfPoint& start,
                                         const OrbitContinuationOptions& options);
/// From a period doubling: the orbits of twice the period. From a crossing: the other branch, in both directions.
[[nodiscard]] OrbitBranch continue_orbit(const ParametricSystem& system, const OrbitMark& start,
                                         const OrbitContinuationOptions& options);

}  // namespace continuo::studies
