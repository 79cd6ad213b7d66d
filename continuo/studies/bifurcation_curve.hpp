// Where equilibria fold or begin to oscillate, followed while two constants move: curves of folds and of Hopf points,
// with the places where they are more than that: cusp, Bogdanov-Takens, generalised Hopf (Bautin), zero-Hopf and double
// Hopf points. By minimally augmented systems and pseudo-arclength: f(x, p, q) = 0 and one scalar test of df/dx.
// Yu. A. Kuznetsov, "Elements of Applied Bifurcation Theory", chapters 8 and 10; W. Govaerts, "Numerical Methods for
// Bifurcations of Dynamical Equilibria" (2000).
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

#include <continuo/status/status.hpp>
#include <continuo/studies/continuation.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// A point of a curve of folds or Hopf points.
struct CurvePoint {
  std::array<double, 2> constants{};  // their values
  std::vector<double> x;
  std::vector<std::complex<double>> eigenvalues;  // those that are critical among them
  double frequency = 0;                           // of a Hopf point: imaginary part / 2 pi
  /// As of a BifurcationPoint: a of a fold, the first Lyapunov coefficient of a Hopf point.
  std::optional<double> coefficient{};
};

/// `cusp`: two folds meet, the quadratic term of the fold vanishes. `bogdanov_takens`: zero is a double eigenvalue; a
/// curve of folds and one of Hopf points touch, the latter ends. `generalized_hopf`: the first Lyapunov coefficient
/// vanishes (Bautin). `zero_hopf`: a zero eigenvalue and a pair on the imaginary axis. `double_hopf`: two such pairs.
enum class Degeneracy { cusp, bogdanov_takens, generalized_hopf, zero_hopf, double_hopf };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(Degeneracy kind);

/// A number of a normal form, by the name it has in the books.
struct NormalFormNumber {
  std::string_view name;
  double value;
};

/// A point of a curve at which a second condition holds.
struct DegeneratePoint {
  Degeneracy kind;
  CurvePoint at;
  std::size_t next = 0;                     // of the curve's points, the first behind it
  double other_frequency = 0;               // of zero_hopf on a curve of folds, and of the second pair of double_hopf
  std::vector<NormalFormNumber> numbers{};  // c of a cusp; a and b of a Bogdanov-Takens point
};

/// Why a curve ends. `bound`: of a constant. `closed`: it comes back to where it began. `bogdanov_takens`: behind it
/// the pair is real (a neutral saddle), nothing begins to oscillate.
enum class CurveEnding { bound, closed, bogdanov_takens, infinity, interrupted, too_many_points, lost };

/// How one end of a curve came about.
struct CurveEnd {
  CurveEnding ending = CurveEnding::lost;
  std::string reason{};  // one sentence
};

/// A curve of folds or Hopf points over two constants.
struct BifurcationCurve {
  Bifurcation kind = Bifurcation::fold;  // fold or hopf
  std::vector<CurvePoint> points{};
  std::vector<DegeneratePoint> marks{};  // in the order of the curve
  std::array<CurveEnd, 2> ends{};        // before the first point, after the last
  Status status{};                       // a failure where there is no curve
};

/// Which constants move, over which ranges, and how far the curve may be followed.
struct CurveOptions {
  std::array<std::size_t, 2> constants{0, 1};  // which of the system's
  std::array<double, 2> low{0, 0}, high{1, 1};
  // In parts of the ranges and of the size of x.
  double first_step = 0.01, least_step = 1e-7, largest_step = 0.02;
  std::size_t most_points = 5000;
  double t = 0;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // of the range of the second constant that has been covered
};

/// From a fold or a Hopf point near these values, in both directions.
struct CurveStart {
  Bifurcation kind = Bifurcation::fold;
  std::array<double, 2> constants{};
  std::vector<double> x;
  double frequency = 0;  // of a Hopf point
};
/// Follows the curve through one point. Where the start is no such point, or the iteration fails, the curve is empty
/// and has a message.
[[nodiscard]] BifurcationCurve follow_bifurcation(const ParametricSystem& system, const CurveStart& start,
                                                  const CurveOptions& options);

/// Curves through several starts, and those that begin at the degenerate points of others, each once.
struct CurveOfDiagram {
  BifurcationCurve curve;
  std::vector<std::size_t> starts;    // those that lie on it
  std::optional<std::size_t> from{};  // it was found at a degenerate point of this curve
};
/// Follows all starts, then the curves that begin at degenerate points, at most `most_curves`.
[[nodiscard]] std::vector<CurveOfDiagram> bifurcation_curves(const ParametricSystem& system,
                                                             const std::vector<CurveStart>& starts,
                                                             const CurveOptions& options, std::size_t most_curves = 20);

}  // namespace continuo::studies
