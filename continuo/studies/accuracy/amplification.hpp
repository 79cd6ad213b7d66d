// By how much the steps of a method multiply a motion of x' = z x (with h = 1, so z is lambda h), of any method, found
// from nothing but the states it gives:
//
//   amplification(steps_of("rk4"), {-2.0, 0})  // 1/3: |1 + z + z^2/2 + z^3/6 + z^4/24|
//
// A method applied to a linear equation is a linear recurrence, y_(n+k) = c_0 y_n + ... + c_(k-1) y_(n+k-1): k = 1 for
// a one-step method, with R(z) for c_0, and one more for each step remembered. Its shortest form that explains the
// states is found by least squares (the method of R. Prony, 1795); the roots of zeta^k = c_0 + ... + c_(k-1) zeta^(k-1)
// are the factors of its motions, the greatest of them what stays. E. Hairer, G. Wanner, "Solving Ordinary Differential
// Equations II", IV.2 and V.1.
#pragma once
#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::studies {

using Complex = std::complex<double>;

/// y_0, y_1, ..., y_steps for x' = z x with h = 1; fewer where the numbers overflow, none where the method cannot.
using StepSequence = std::function<std::vector<Complex>(Complex z, std::size_t steps)>;

/// A method of the suite. A method for x'' = a integrates q'' = (z + z*) q' - z z* q, whose motions are those of z and
/// its conjugate; one that refuses velocities in a only the case without damping, z on the imaginary axis.
[[nodiscard]] StepSequence steps_of(std::string_view method);
/// The same for a motion of two factors: q'' = (z1 + z2) q' - z1 z2 q. They are real, or conjugates of each other.
std::function<std::vector<Complex>(Complex z1, Complex z2, std::size_t steps)> motion_steps_of(std::string_view method);

/// The greatest |zeta|; NaN where no linear recurrence explains the steps.
[[nodiscard]] double amplification(const StepSequence& sequence, Complex z);
/// The same of states that are there, without those of a method's start.
[[nodiscard]] double amplification(std::span<const Complex> states);

/// Factors up to here are taken for 1: what rounding does to them.
inline constexpr double neutral_factor = 1 + 1e-9;

}  // namespace continuo::studies
