// Where closed orbits fold, double their period or begin to wind round a torus, followed while two constants move, with
// the places where they are more than that: cusps, fold-flips, strong resonances. By minimally augmented systems on the
// collocation of the orbit and pseudo-arclength. E. J. Doedel, W. Govaerts, Yu. A. Kuznetsov, "Computation of periodic
// solution bifurcations in ODEs using bordered systems", SIAM J. Numer. Anal. 41 (2003) 401-435; Yu. A. Kuznetsov,
// "Elements of Applied Bifurcation Theory", chapter 9.
#pragma once
#include <array>
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/bifurcation_curve.hpp>
#include <continuo/studies/orbit_continuation.hpp>

namespace continuo::studies {

namespace detail {
struct HomoclinicMark;
}

/// A point of a curve of bifurcations of orbits.
struct OrbitCurvePoint {
  std::array<double, 2> constants{};  // their values
  double period = 0;
  std::vector<double> x{};                          // a state on the orbit
  std::vector<double> low{}, high{};                // between which each component goes
  std::vector<std::complex<double>> multipliers{};  // by descending size, without the 1 of a shift along the orbit
  double rotation = 0;                              // of torus: the angle of the pair, in turns per period
  // Of a homoclinic orbit, whose `period` is the length of the interval that is solved for and `x` its saddle.
  std::vector<std::complex<double>> eigenvalues{};  // of the saddle, by descending real part
  /// Estimated: by how much the constants are off, in ranges. Of a central orbit of a saddle-node, whose constants are
  /// those of the saddle-node: by how much the orbit is, in parts of its size.
  double truncation = 0;
};

/// `cusp`: two folds of orbits meet. `resonance_1` to `resonance_4`: strong resonances 1:1 to 1:4, where a pair on the
/// unit circle is twice 1, twice -1, at a third or at a quarter of a turn. `fold_flip`: one multiplier is 1, another
/// -1. `fold_torus`, `flip_torus`: a multiplier 1, or -1, and a pair on the circle. `double_torus`: two such pairs.
/// Of homoclinic orbits, by the leading eigenvalues of the saddle (those nearest to the imaginary axis on either side):
/// `neutral_*`: their real parts add up to zero; one or both may be pairs. `divergent_saddle_focus`: a pair's real part
/// twice and the other's do. `double_leading`: two real ones meet, behind which they are a pair. `triple_leading`: a
/// real one and a pair have the same real part. `saddle_node`, `hopf`: one is zero, or a pair imaginary. `orbit_flip`:
/// the orbit does not come, or leave, along the leading eigenvector. `inclination_flip`: nor does the adjoint solution.
/// `non_central`: of a saddle-node, the orbit does not come, or leave, along the centre.
enum class OrbitDegeneracy {
  cusp,
  resonance_1,
  resonance_2,
  resonance_3,
  resonance_4,
  fold_flip,
  fold_torus,
  flip_torus,
  double_torus,
  neutral_saddle,
  neutral_saddle_focus,
  neutral_focus_focus,
  divergent_saddle_focus,
  double_leading_stable,
  double_leading_unstable,
  triple_leading_stable,
  triple_leading_unstable,
  saddle_node,
  hopf,
  orbit_flip_stable,
  orbit_flip_unstable,
  inclination_flip_stable,
  inclination_flip_unstable,
  non_central
};
inline constexpr std::size_t orbit_degeneracies = 24;
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(OrbitDegeneracy kind);

/// A point of a curve at which a second condition holds.
struct DegenerateOrbit {
  OrbitDegeneracy kind;
  OrbitCurvePoint at;
  std::size_t next = 0;  // of the curve's points, the first behind it
  /// Of a homoclinic orbit: from which a curve in three constants begins (degenerate_homoclinic.hpp).
  std::shared_ptr<const detail::HomoclinicMark> homoclinic{};
};

/// Why a curve ends. `equilibrium`: the orbit shrinks to one. `long_period`: the period has grown to many times that at
/// the start. `resonance`: 1:1 or 1:2, behind which there is no pair on the circle. `no_saddle`: a homoclinic orbit's
/// equilibrium is none any more. `merged`: leading eigenvalues by which the orbits are special meet.
enum class OrbitCurveEnding {
  bound,
  closed,
  equilibrium,
  long_period,
  resonance,
  no_saddle,
  merged,
  interrupted,
  too_many_points,
  lost
};

/// How one end of a curve came about.
struct OrbitCurveEnd {
  OrbitCurveEnding ending = OrbitCurveEnding::lost;
  std::string reason{};  // one sentence
};

/// Whether it is a homoclinic orbit, of a saddle or of a saddle-node.
[[nodiscard]] inline bool is_homoclinic(OrbitBifurcation kind) {
  return kind == OrbitBifurcation::homoclinic || kind == OrbitBifurcation::central_homoclinic;
}

/// A curve of bifurcations of orbits over two constants.
struct OrbitCurve {
  OrbitBifurcation kind = OrbitBifurcation::fold;  // but crossing
  std::vector<OrbitCurvePoint> points{};
  std::vector<DegenerateOrbit> marks{};  // in the order of the curve
  std::array<OrbitCurveEnd, 2> ends{};   // before the first point, after the last
  Status status{};                       // a failure where there is no curve
};

/// Which constants move, over which ranges, and how far the curve may be followed.
struct OrbitCurveOptions {
  std::array<std::size_t, 2> constants{0, 1};  // which of the system's
  std::array<double, 2> low{0, 0}, high{1, 1};
  // In parts of the ranges, of the period and of the size of x.
  double first_step = 0.01, least_step = 1e-6, largest_step = 0.05;
  std::size_t most_points = 1000;
  double longest_period = 30;  // in periods at the start
  double rtol = 1e-9;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // of the range of the second constant that has been covered
};

/// From what is marked on a branch of orbits of the first constant, the second one having the system's value. From its
/// homoclinic end: of homoclinic orbits, by projection (homoclinic_curve.hpp).
[[nodiscard]] OrbitCurve follow_orbit_bifurcation(const ParametricSystem& system, const OrbitMark& start,
                                                  const OrbitCurveOptions& options);
/// The same, and behind it the curves that begin where homoclinic ones end, at most so many in all.
[[nodiscard]] std::vector<OrbitCurve> follow_orbit_bifurcations(const ParametricSystem& system, const OrbitMark& start,
                                                                const OrbitCurveOptions& options, std::size_t most);

/// Curves through several marks, each once, and those that begin where homoclinic ones end.
struct OrbitCurveOfDiagram {
  OrbitCurve curve;
  std::vector<std::size_t> starts;  // those that lie on it; none where it begins at the end of another
};
/// Follows all marks, then the curves that begin where homoclinic ones end, at most `most_curves`.
[[nodiscard]] std::vector<OrbitCurveOfDiagram> orbit_curves(const ParametricSystem& system,
                                                            const std::vector<OrbitMark>& starts,
                                                            const OrbitCurveOptions& options,
                                                            std::size_t most_curves = 12);

}  // namespace continuo::studies
