// Degenerate homoclinic orbits (with a flip, a neutral saddle, a saddle-node), followed while three
// constants move: HomCont's curves with a fixed psi. At each place one constant, that which moves fastest, is given; in
// the other two a homoclinic orbit with a zero of the test function is solved for, along the curve of homoclinic orbits
// that goes through there. A. R. Champneys, Yu. A. Kuznetsov, B. Sandstede, "A numerical toolbox for homoclinic
// bifurcation analysis", Int. J. Bifurcation Chaos 6 (1996) 867-887.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/orbit_curve.hpp>

namespace continuo::studies {

/// A point of a curve of degenerate homoclinic orbits.
struct DegenerateHomoclinicPoint {
  std::array<double, 3> constants{};  // their values
  OrbitCurvePoint orbit{};            // whose constants are the first two
};

/// A point of a curve at which another condition holds too.
struct MarkedHomoclinic {
  OrbitDegeneracy kind;  // what it is besides
  DegenerateHomoclinicPoint at;
  std::size_t next = 0;  // of the curve's points, the first behind it
};

/// A curve of degenerate homoclinic orbits over three constants.
struct DegenerateHomoclinicCurve {
  OrbitDegeneracy kind = OrbitDegeneracy::saddle_node;
  std::vector<DegenerateHomoclinicPoint> points{};
  std::vector<MarkedHomoclinic> marks{};  // in the order of the curve
  std::array<OrbitCurveEnd, 2> ends{};    // before the first point, after the last
  Status status{};                        // a failure where there is no curve
};

/// Which constants move, over which ranges, and how far the curve may be followed.
struct DegenerateHomoclinicOptions {
  std::array<std::size_t, 3> constants{0, 1, 2};  // which of the system's
  std::array<double, 3> low{0, 0, 0}, high{1, 1, 1};
  // In parts of the ranges and of the size of x.
  double first_step = 0.01, least_step = 1e-6, largest_step = 0.1;
  std::size_t most_points = 1000;
  double longest_interval = 30;  // in intervals at the start
  double rtol = 1e-9;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // of the range of the third constant that has been covered
};

/// From what is marked on a curve of homoclinic orbits of the first two constants, the third one having the system's
/// value.
[[nodiscard]] DegenerateHomoclinicCurve follow_degenerate_homoclinic(const ParametricSystem& system,
                                                                     const DegenerateOrbit& start,
                                                                     const DegenerateHomoclinicOptions& options);

/// Curves through all that is marked, each once.
[[nodiscard]] std::vector<DegenerateHomoclinicCurve> degenerate_homoclinic_curves(
    const ParametricSystem& system, const std::vector<OrbitCurveOfDiagram>& curves,
    const DegenerateHomoclinicOptions& options, std::size_t most_curves = 12);

}  // namespace continuo::studies
