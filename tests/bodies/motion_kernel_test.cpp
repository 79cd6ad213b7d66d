// Bodies that are moved in lanes: against the same for one body, to the last bit, and that against the exact turn.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>
#include <continuo/bodies/manifold_kernels/solver_states.hpp>

namespace continuo {
namespace {

template <class Real>
void expect_precise_quotients() {
  const long double rounding = std::numeric_limits<Real>::epsilon();
  for (int k = 0; k <= 4000; ++k) {
    const Real square = static_cast<Real>(std::pow(10.0, 1 - k / 100.0));  // to 1e-39
    const SineQuotients<Real> of = sine_quotients(square);
    const long double s = square, x = std::sqrt(s), half = std::sin(x / 2) / x;
    EXPECT_NEAR(static_cast<double>(of.sine), static_cast<double>(std::sin(x) / x), static_cast<double>(2 * rounding));
    // 1 - cos(x) loses digits where the angle is small, and there the series holds: 0.1 / 2 is left of 1.
    const long double lost = square > Real(most_square_of_series) ? 1 / s : 1;
    EXPECT_NEAR(static_cast<double>(of.versine), static_cast<double>(2 * half * half),
                static_cast<double>(2 * rounding * lost));
  }
}
TEST(SineQuotients, ArePreciseToRounding) {
  expect_precise_quotients<float>();
  expect_precise_quotients<double>();
}

template <class Real, int Dim>
struct MovingScene {
  LargeArray<SolverState<Real, Dim>> states;
  std::vector<Real> angles;

  /// The last body never moves.
  explicit MovingScene(unsigned seed, std::size_t bodies) {
    std::mt19937 engine(seed);
    const auto between = [&](double low, double high) {
      return static_cast<Real>(low + (high - low) * (static_cast<double>(engine()) / 4294967296.0));
    };
    states.resize(bodies + 1), angles.assign(bodies + 1, Real(0));
    for (std::size_t i = 0; i <= bodies; ++i) {
      SolverState<Real, Dim> state;
      if constexpr (Dim == 3) state.set_turn({{1, 0, 0, 0}});
      if (i < bodies) {
        Vector<Real, Dim> v;
        Spin<Real, Dim> spin;
        // From hardly any to some radians in a substep.
        const Real fastest = static_cast<Real>(std::pow(10.0, between(-6, 3)));
        for (Real& part : v.components) part = between(-1, 1);
        for (Real& part : spin.components) part = between(-1, 1) * fastest;
        state.set_v(v), state.set_spin(spin), state.set_inverse_mass(between(0.1, 10));
      }
      states.data()[i] = state;
    }
  }
  [[nodiscard]] std::vector<Real> numbers() const {
    std::vector<Real> all(angles);
    for (std::size_t i = 0; i < angles.size(); ++i)
      for (const auto& quad : states.data()[i].quad) all.insert(all.end(), quad.begin(), quad.end());
    return all;
  }
};

template <class Real, int Dim>
void expect_the_bits_of_single_bodies() {
  const Real h = Real(1) / 240;
  for (const std::size_t bodies : {1u, 3u, 4u, 31u, 200u}) {
    MovingScene<Real, Dim> one_by_one(static_cast<unsigned>(bodies), bodies);
    for (int step = 0; step < 4; ++step)
      for (std::size_t i = 0; i < bodies; ++i) {
        auto& state = one_by_one.states.data()[i];
        if constexpr (Dim == 2) {
          move(state, state.spin(), h, one_by_one.angles[i]);
        } else {
          move(state, state.spin(), h);
        }
      }
    for (const auto& kernels : manifold_kernels<Real, Dim>()) {
      MovingScene<Real, Dim> in_lanes(static_cast<unsigned>(bodies), bodies);
      std::vector<std::uint32_t> numbers;
      for (std::uint32_t i = 0; i < bodies; ++i) numbers.push_back(static_cast<std::uint32_t>(bodies - 1 - i));
      while (numbers.size() % kernels.lanes != 0) numbers.push_back(static_cast<std::uint32_t>(bodies));
      const MotionTask<Real, Dim> task{in_lanes.states.data(), in_lanes.angles.data(), numbers.data(), h};
      for (int step = 0; step < 4; ++step) kernels.move(task, 0, numbers.size() / kernels.lanes);
      EXPECT_EQ(in_lanes.numbers(), one_by_one.numbers()) << kernels.lanes << " lanes, " << bodies << " bodies";
    }
  }
}
TEST(MotionKernel, MovesAsOneBodyMoves) {
  expect_the_bits_of_single_bodies<double, 2>();
  expect_the_bits_of_single_bodies<double, 3>();
  expect_the_bits_of_single_bodies<float, 2>();
  expect_the_bits_of_single_bodies<float, 3>();
}

}  // namespace
}  // namespace continuo
