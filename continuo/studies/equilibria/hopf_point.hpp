// Where an equilibrium begins to oscillate: a pair of eigenvalues on the imaginary axis, found by moving one constant.
#pragma once
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

struct HopfPoint {
  double constant = 0;  // its value
  std::vector<double> x;
  double angular_frequency = 0;
  std::vector<std::complex<double>> vector;         // the eigenvector of the one with positive imaginary part
  std::vector<std::complex<double>> eigenvalues{};  // of df/dx, by descending real part
};

/// The Hopf point nearest to the guess, by the secant on the real part of the pair next to +- i angular_frequency; the
/// equilibrium is followed from x. Nothing where the iteration leaves [low, high], or loses the equilibrium.
struct HopfGuess {
  std::size_t constant = 0;  // which of the system's
  double value = 0, low = 0, high = 1;
  std::vector<double> x{};
  double angular_frequency = 1;
};
[[nodiscard]] std::optional<HopfPoint> find_hopf_point(const ParametricSystem& system, const HopfGuess& guess,
                                                       double t = 0);

}  // namespace continuo::studies
