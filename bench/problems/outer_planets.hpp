// bench/problems/outer_planets.hpp
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include <bench/problems/accelerations.hpp>
#include <bench/problems/n_body.hpp>

namespace continuo::bench {

/// The sun (with the inner planets' mass), Jupiter, Saturn, Uranus, Neptune and Pluto for 200,000 days: E. Hairer,
/// Ch. Lubich, G. Wanner, "Geometric Numerical Integration", I.2.4. Masses relative to the sun's (here multiplied by
/// the constant of gravity), distances in astronomical units, time in days.
struct OuterPlanets : Accelerations {
  static constexpr std::string_view name = "outer_planets", title = "Outer solar system, 200,000 days";
  static constexpr std::size_t size = 36;
  static constexpr double duration = 200'000;
  static constexpr double gravity = 2.95912208286e-4;
  static constexpr std::array<double, 6> mass{gravity * 1.00000597682,      gravity * 0.000954786104043,
                                              gravity * 0.000285583733151,  gravity * 0.0000437273164546,
                                              gravity * 0.0000517759138449, gravity / 1.3e8};
  static constexpr std::array<double, size> start() {
    return {0, -3.5023653,  9.0755314,  8.3101420,   11.4707666,  -15.5387357,   // x
            0, -3.8169847,  -3.0458353, -16.2901086, -25.7294829, -25.2225594,   // y
            0, -1.5507963,  -1.6483708, -7.2521278,  -10.8169456, -3.1902382,    // z
            0, 0.00565429,  0.00168318, 0.00354178,  0.00288930,  0.00276725,    // x'
            0, -0.00412490, 0.00483525, 0.00137102,  0.00114527,  -0.00170702,   // y'
            0, -0.00190589, 0.00192462, 0.00055029,  0.00039677,  -0.00136504};  // z'
  }

  template <class Real>
  void operator()(const Real&, const std::array<Real, size>& x, std::array<Real, size>& dxdt) const {
    attract<3>(mass, x, dxdt);
  }
};

/// The same for a thousand years of 365.25 days.
struct OuterPlanetsMillennium : OuterPlanets {
  static constexpr std::string_view name = "outer_planets_millennium", title = "Outer solar system, 1000 years";
  static constexpr double duration = 365'250;
};

}  // namespace continuo::bench
