// M(t, x) x' = f(t, x): against manufactured solutions, conserved quantities and systems that were solved for x' by
// hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/with_mass.hpp>

namespace continuo::with_mass_test {
namespace {

using X = std::array<double, 3>;

/// Differences are more accurate than in double.
using Real = long double;
using L = std::array<Real, 3>;

/// A random M(t, x) whose symmetric part is positive: B^T B + 1 + a cos(t) C + a diagonal of squares of x.
struct RandomMass {
  std::array<Real, 9> b{}, c{};
  explicit RandomMass(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1, 1);
    for (auto* each : {&b, &c})
      for (Real& value : *each) value = entry(random);
  }
  void operator()(Real t, const L& x, std::span<Real> rows) const {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        rows[i * 3 + j] += i == j ? 1 + x[i] * x[i] : Real(0.2) * x[i] * x[j];
        for (std::size_t k = 0; k < 3; ++k) rows[i * 3 + j] += b[k * 3 + i] * b[k * 3 + j];
        rows[i * 3 + j] += Real(0.2) * std::cos(t) * c[i * 3 + j];
      }
    }
  }
};
L solution_at(Real t) {
  return {std::sin(t), std::cos(2 * t), std::exp(-t)};
}
L slope_at(Real t) {
  return {std::cos(t), -2 * std::sin(2 * t), -std::exp(-t)};
}

/// f with the solution above: M(t, x) s'(t) - (x - s(t)).
struct Manufactured {
  RandomMass mass;
  void operator()(Real t, const L& x, L& f) const {
    std::array<Real, 9> rows{};
    mass(t, x, rows);
    const L s = solution_at(t), slope = slope_at(t);
    for (std::size_t i = 0; i < 3; ++i) {
      f[i] = -(x[i] - s[i]);
      for (std::size_t j = 0; j < 3; ++j) f[i] += rows[i * 3 + j] * slope[j];
    }
  }
};
/// The same with df/dx, of which with_mass makes that of M^-1 f.
struct ManufacturedWithJacobian : Manufactured {
  void jacobian(Real t, const L& x, std::span<Real> rows) const {
    const L slope = slope_at(t);
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i * 3 + i] += -1 + 2 * x[i] * slope[i];
      for (std::size_t j = 0; j < 3; ++j) {
        if (j == i) continue;
        rows[i * 3 + i] += Real(0.2) * x[j] * slope[j];
        rows[i * 3 + j] += Real(0.2) * x[i] * slope[j];
      }
    }
  }
};

template <class M, class System>
Real error_of_fixed_steps(System system, int steps) {
  L x = solution_at(0), x_new = x;
  const Real h = Real(1) / steps;
  auto work = M::workspace(x);
  for (int k = 0; k < steps; ++k) {
    if constexpr (requires { M::set_tolerance(work, Tolerance<Real>{}); })
      M::set_tolerance(work, Tolerance<Real>{1e-14L, 1e-14L});
    (void)M::step(system, k * h, x, h, k == 0, work, x_new);
    M::accept(work);
    x = x_new;
  }
  const L exact = solution_at(1);
  Real error = 0;
  for (std::size_t i = 0; i < 3; ++i) error = std::max(error, Real(std::abs(x[i] - exact[i])));
  return error;
}

// With half the steps the error has the power of 2 of the order, but for what the next power of h adds. Rosenbrock
// methods have their order only with the exact Jacobian.
template <class M>
void expect_order(int order, int steps) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const ManufacturedWithJacobian f{{RandomMass(seed)}};
    const auto system = with_mass(f, f.mass);
    const Real coarse = error_of_fixed_steps<M>(system, steps), fine = error_of_fixed_steps<M>(system, 2 * steps);
    EXPECT_NEAR(static_cast<double>(std::log2(coarse / fine)), order, 0.5)
        << M::name << ", seed " << seed << ", error " << fine;
  }
}

TEST(WithMass, LeavesMethodsTheirOrder) {
  expect_order<Rk4>(4, 20);
  expect_order<Trapezoidal>(2, 20);
  expect_order<Rodas5P>(5, 20);
  expect_order<Radau5>(5, 20);
}

TEST(WithMass, TurnsTheJacobianOfFIntoThatOfTheSlope) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ManufacturedWithJacobian f{{RandomMass(seed)}};
    auto system = with_mass(f, f.mass);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1, 1);
    const Real t = entry(random);
    const L x{0.2L + std::abs(entry(random)), seed % 2 == 0 ? 0 : -0.3L - std::abs(entry(random)), 0.5L};
    std::array<Real, 9> rows{};
    system.jacobian(t, x, std::span<Real>(rows));
    constexpr Real d = 1e-5L;  // central differences: errors of d^2 and of 1e-16 / d, times some derivatives
    for (std::size_t j = 0; j < 3; ++j) {
      L up = x, down = x, f_up{}, f_down{};
      up[j] += d, down[j] -= d;
      system(t, up, f_up);
      system(t, down, f_down);
      for (std::size_t i = 0; i < 3; ++i)
        // M, of the size of 10, is rounded by 1e-18, over increments of 3e-10, and of 1e-12 for a component that is 0.
        EXPECT_NEAR(static_cast<double>(rows[i * 3 + j]), static_cast<double>((f_up[i] - f_down[i]) / (2 * d)),
                    x[j] == 0 ? 1e-5 : 1e-7)
            << i << ", " << j << ", seed " << seed;
    }
  }
}

/// A cart of mass 2 on a rail with a pendulum of mass 1 and length 0.5: the state is (x, angle, x', angle').
struct CartAndPendulum {
  using Y = std::array<double, 4>;
  static constexpr double cart = 2, bob = 1, length = 0.5, gravity = 9.81;

  static void mass(double, const Y& y, std::span<double> rows) {
    const double coupling = bob * length * std::cos(y[1]);
    rows[0] = rows[5] = 1;
    rows[10] = cart + bob;
    rows[11] = rows[14] = coupling;
    rows[15] = bob * length * length;
  }
  static Y forces(double, const Y& y) {
    return {y[2], y[3], bob * length * std::sin(y[1]) * y[3] * y[3], -bob * gravity * length * std::sin(y[1])};
  }
  static double energy(const Y& y) {
    return (cart + bob) * y[2] * y[2] / 2 + bob * length * std::cos(y[1]) * y[2] * y[3] +
           bob * length * length * y[3] * y[3] / 2 - bob * gravity * length * std::cos(y[1]);
  }
  static double momentum(const Y& y) { return (cart + bob) * y[2] + bob * length * std::cos(y[1]) * y[3]; }
};

template <class M>
void expect_conserved_quantities(double tolerance) {
  using Cart = CartAndPendulum;
  const Cart::Y start{0, 2.5, 0.3, 1};
  const auto solution =
      solve(with_mass(Cart::forces, Cart::mass), start, {0.0, 5.0}, M{}, {.rtol = tolerance, .atol = tolerance});
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  const auto& end = solution.final_state();
  // A derivative of the energy is at most some 20, and errors of a run are some ten tolerances.
  EXPECT_NEAR(Cart::energy(end), Cart::energy(start), 2000 * tolerance) << M::name;
  EXPECT_NEAR(Cart::momentum(end), Cart::momentum(start), 2000 * tolerance) << M::name;
}

TEST(WithMass, MovesACartWithAPendulum) {
  expect_conserved_quantities<Dop853>(1e-10);
  expect_conserved_quantities<Rodas5P>(1e-8);
}

/// x_0 and x_1 have masses that depend on everything, x_2 = cos(t) + x_0^2 none.
struct Algebraic {
  static void mass(double t, const X& x, std::span<double> rows) {
    rows[0] = 2 + std::cos(t);
    rows[1] = x[2];
    rows[3] = -x[0];
    rows[4] = 3 + x[1] * x[1];
  }
  static X solution(double t) { return {std::sin(t), std::exp(-t), std::cos(t) + std::sin(t) * std::sin(t)}; }
  void operator()(double t, const X& x, X& f) const {
    const X s = solution(t);
    const double slope = std::cos(t), other = -std::exp(-t);
    f[0] = (2 + std::cos(t)) * slope + x[2] * other - 50 * (x[0] - s[0]);
    f[1] = -x[0] * slope + (3 + x[1] * x[1]) * other - (x[1] - s[1]);
    f[2] = std::cos(t) + x[0] * x[0] - x[2];
  }
};

template <class M>
void expect_algebraic_solution() {
  const double tolerance = 1e-7;
  const auto solution = solve(with_mass(Algebraic{}, Algebraic::mass, {2}), Algebraic::solution(0), {0.0, 3.0}, M{},
                              {.rtol = tolerance, .atol = tolerance});
  ASSERT_TRUE(solution.outcome) << M::name << ": " << describe(solution.outcome);
  const X exact = Algebraic::solution(3);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(solution.final_state()[i], exact[i], 30 * tolerance) << M::name << ", component " << i;
}

TEST(WithMass, SolvesForComponentsWithoutMass) {
  expect_algebraic_solution<Rodas5P>();
  expect_algebraic_solution<Radau>();
  expect_algebraic_solution<Bdf>();
}

TEST(WithMass, RefusesWhatItCannotSolve) {
  const auto hint_of = [](auto&& mass, std::vector<std::size_t> algebraic, auto method) {
    return solve(with_mass(Algebraic{}, mass, std::move(algebraic)), Algebraic::solution(0), {0.0, 1.0}, method)
        .outcome.hint;
  };
  EXPECT_TRUE(hint_of(Algebraic::mass, {}, Rodas5P{}).starts_with("the mass matrix is singular"));
  EXPECT_TRUE(hint_of(Algebraic::mass, {1}, Rodas5P{}).starts_with("the mass matrix has an entry in the row"));
  EXPECT_TRUE(hint_of(Algebraic::mass, {7}, Rodas5P{}).starts_with("component 7 is named as algebraic"));
  EXPECT_TRUE(hint_of(Algebraic::mass, {2}, Dop853{}).starts_with("dop853 cannot integrate M x' = f(t, x)"));
  const auto infinite = [](double, const X&, std::span<double> rows) { rows[0] = 1 / std::abs(0.0); };
  EXPECT_EQ(hint_of(infinite, {2}, Rodas5P{}), "the mass matrix is not finite");
  // t x' = 1 from t = -1: x' grows without bound at 0.
  const auto clock = [](double t, const std::array<double, 1>&, std::span<double> rows) { rows[0] = t; };
  const auto one = [](double, const std::array<double, 1>&) { return std::array{1.0}; };
  EXPECT_FALSE(solve(with_mass(one, clock), std::array{0.0}, {-1.0, 1.0}, Rodas5P{}).outcome);
}

TEST(WithMass, KeepsTheNamesOfComponents) {
  struct Named {
    X operator()(double, const X&) const { return {1, 1, 1}; }
    std::string component_name(std::size_t i) const { return std::string(1, "abc"[i]); }
  };
  EXPECT_EQ(component_name(with_mass(Named{}, RandomMass(1)), 1), "b");
}

/// Burgers' equation u_t + u u_x = e u_xx on nodes that move with the front: where node i moves, its value changes by
/// u_x x_i' besides, and the nodes follow the monitor w = sqrt(1 + u_x^2), the pull of which is spread over neighbours
/// (W. Huang, Y. Ren, R. D. Russell, SIAM J. Numer. Anal. 31 (1994)). The state is the values, then the places.
struct MovingMesh {
  using Y = std::vector<double>;
  static constexpr std::size_t n = 16;
  static constexpr double e = 0.02, relaxation = 0.05, spread = 2;

  static double front(double x, double t) { return 1 / (1 + std::exp((x - 0.25 - t / 2) / (2 * e))); }
  /// Value and place of node i = 0..n+1, with those of the ends.
  static double u(double t, const Y& y, std::size_t i) {
    return i == 0 ? front(0, t) : i == n + 1 ? front(1, t) : y[i - 1];
  }
  static double x(const Y& y, std::size_t i) { return i == 0 ? 0 : i == n + 1 ? 1 : y[n + i - 1]; }
  static double slope(double t, const Y& y, std::size_t i) {
    return (u(t, y, i + 1) - u(t, y, i - 1)) / (x(y, i + 1) - x(y, i - 1));
  }

  static void mass(double t, const Y& y, std::span<double> rows) {
    const std::size_t m = 2 * n;
    for (std::size_t i = 0; i < n; ++i) {
      rows[i * m + i] = 1;
      rows[i * m + n + i] = -slope(t, y, i + 1);
      double* const row = &rows[(n + i) * m + n];
      row[i] = 1 + 2 * spread;
      if (i > 0) row[i - 1] = -spread;
      if (i + 1 < n) row[i + 1] = -spread;
    }
  }
  void operator()(double t, const Y& y, Y& f) const {
    for (std::size_t i = 1; i <= n; ++i) {
      const double left = x(y, i) - x(y, i - 1), right = x(y, i + 1) - x(y, i);
      const double to_left = (u(t, y, i) - u(t, y, i - 1)) / left, to_right = (u(t, y, i + 1) - u(t, y, i)) / right;
      f[i - 1] = e * 2 * (to_right - to_left) / (left + right) - u(t, y, i) * slope(t, y, i);
      f[n + i - 1] =
          (std::sqrt(1 + to_right * to_right) * right - std::sqrt(1 + to_left * to_left) * left) / relaxation;
    }
  }
  static Y start() {
    Y y(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
      y[n + i] = static_cast<double>(i + 1) / (n + 1);
      y[i] = front(y[n + i], 0);
    }
    return y;
  }
};
/// The same, solved for y' by hand: the places by L. H. Thomas' elimination, the values from them.
struct MovingMeshByHand : MovingMesh {
  void operator()(double t, const Y& y, Y& f) const {
    MovingMesh::operator()(t, y, f);
    std::array<double, n> upper{};
    for (std::size_t i = 0; i < n; ++i) {
      const double pivot = 1 + 2 * spread + (i > 0 ? spread * upper[i - 1] : 0);
      upper[i] = -spread / pivot;
      f[n + i] = (f[n + i] + (i > 0 ? spread * f[n + i - 1] : 0)) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 0;) f[n + i] -= upper[i] * f[n + i + 1];
    for (std::size_t i = 0; i < n; ++i) f[i] += slope(t, y, i + 1) * f[n + i];
  }
};

TEST(WithMass, MovesAMeshWithAFront) {
  const Options<MovingMesh::Y> options{.rtol = 1e-7, .atol = 1e-7};
  const auto by_hand = solve(MovingMeshByHand{}, MovingMesh::start(), {0.0, 0.8}, Dop853{}, options);
  ASSERT_TRUE(by_hand.outcome) << describe(by_hand.outcome);
  const auto system = with_mass(MovingMesh{}, MovingMesh::mass);
  const auto explicitly = solve(system, MovingMesh::start(), {0.0, 0.8}, Dop853{}, options);
  const auto implicitly = solve(system, MovingMesh::start(), {0.0, 0.8}, Rodas5P{}, options);
  for (std::size_t i = 0; i < 2 * MovingMesh::n; ++i) {
    EXPECT_NEAR(explicitly.final_state()[i], by_hand.final_state()[i], 1e-5) << i;
    EXPECT_NEAR(implicitly.final_state()[i], by_hand.final_state()[i], 1e-5) << i;
  }
  // The nodes are where the front is: as many within 0.1 of it as lie in the rest of the interval.
  const auto& y = implicitly.final_state();
  const double at = 0.25 + 0.4;
  EXPECT_GE(std::count_if(y.begin() + MovingMesh::n, y.end(), [&](double x) { return std::abs(x - at) < 0.1; }), 6);
  for (std::size_t i = 0; i < MovingMesh::n; ++i)
    EXPECT_NEAR(y[i], MovingMesh::front(y[MovingMesh::n + i], 0.8), 0.1) << i;  // 1 at its left, 0 at its right
}

}  // namespace
}  // namespace continuo::with_mass_test
