// The longest step with which a method keeps decaying motions bounded: its region of absolute stability, with
// a model the largest stable step.
//
//   const StabilityRegion region = stability_region(steps_of("rk4"));
//   region.real_limit;  // 2.7853: z = lambda h down to -2.7853 on the real axis
#pragma once
#include <atomic>
#include <complex>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/studies/accuracy/amplification.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// From the origin in this direction: the distance at which the steps first grow. Infinite where they never do up to
/// `farthest`; 0 where they do from the start; NaN where the method has no factors.
[[nodiscard]] double stability_limit(const StepSequence& sequence, Complex direction, double farthest = 1e4);

/// The region of absolute stability of a method.
struct StabilityRegion {
  double real_limit = 0, imaginary_limit = 0;  // distances down the real axis and up the imaginary one
  /// The curve |zeta| = 1, piece by piece with a NaN between them, in a square of this half side around the origin.
  std::vector<double> x{}, y{};
  double half_side = 0;
  /// A closed path round all that is stable, to be filled. What reaches the border of the square goes on beyond it,
  /// away from the origin, for many times its size.
  std::vector<double> area_x{}, area_y{};
  bool outside = false;  // stable far out on the left: the method is implicit, the limits say nothing there
};

/// `points`: of the grid on which the curve is looked for, along one side; without them no curve.
[[nodiscard]] StabilityRegion stability_region(const StepSequence& sequence, std::size_t points = 160,
                                               const std::atomic<bool>* interrupt = nullptr);

/// Where the eigenvalues of df/dx lie along a run.
struct Spectrum {
  std::vector<double> times;
  std::vector<std::vector<Complex>> values;  // at each time
};
/// At the states that are given. Empty where a Jacobian is not finite.
[[nodiscard]] Spectrum spectrum_along(const ParametricSystem& system, const std::vector<double>& times,
                                      const std::vector<std::vector<double>>& states);

/// The largest stable step of a method on a spectrum; what grows by itself (positive real part) asks nothing of it.
struct StepLimit {
  double step = 0;       // infinite: none; 0: no step is stable; NaN: cannot be told
  Complex eigenvalue{};  // that sets it
  double time = 0;       // and when
  double beyond = 0;     // the factor of each step that is one part in a hundred longer
};
/// Computes the limit by the eigenvalue that bounds the step most.
[[nodiscard]] StepLimit largest_stable_step(std::string_view method, const Spectrum& spectrum);

/// What two runs with fixed steps that begin next to each other do: their distance dies out or stays, or it grows.
enum class Fate { bounded, grows, no_run };
/// The name, as in the text of messages and tables.
[[nodiscard]] std::string_view to_string(Fate fate);
/// What a run needs to know of a system besides its equations, for methods of x'' = a.
struct Pairing {
  std::vector<PositionVelocity> pairs{};
  bool velocity_free = false;
};
/// Runs the equations near one state with this step. `factor` is what a step is expected to multiply a growing motion
/// by: the nearer to 1, the more steps it takes to tell. Fate::no_run where that would be too many, or the method
/// refuses.
[[nodiscard]] Fate fate_of(std::string_view method, const ParametricSystem& system, const Pairing& pairing, double t,
                           const std::vector<double>& x, double step, double factor);

}  // namespace continuo::studies
