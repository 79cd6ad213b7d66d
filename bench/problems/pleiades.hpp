// bench/problems/pleiades.hpp
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include <bench/problems/accelerations.hpp>
#include <bench/problems/n_body.hpp>

namespace continuo::bench {

/// Seven stars in the plane with masses 1 to 7 and close passes: E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary
/// Differential Equations I", II.10.
struct Pleiades : Accelerations {
  static constexpr std::string_view name = "pleiades", title = "Pleiades to t = 3";
  static constexpr std::size_t size = 28;
  static constexpr double duration = 3;
  static constexpr std::array<double, 7> mass{1, 2, 3, 4, 5, 6, 7};
  static constexpr std::array<double, size> start() {
    return {3, 3, -1, -3, 2, -2, 2, 3, -3, 2, 0, 0, -4, 4, 0, 0, 0, 0, 0, 1.75, -1.5, 0, 0, 0, -1.25, 1, 0, 0};
  }

  template <class Real>
  void operator()(const Real&, const std::array<Real, size>& x, std::array<Real, size>& dxdt) const {
    attract<2>(mass, x, dxdt);
  }
};

}  // namespace continuo::bench
