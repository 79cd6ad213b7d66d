// Dry friction by `sign` and `if` in the equations: bodies stick and slip. The motion is compared with the sliding
// solution (A. F. Filippov, "Differential Equations with Discontinuous Righthand Sides", 1988), computed here in tiny
// steps of long double from contact to contact.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tests/hybrid/jet.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::hybrid {
namespace {

using Vector = std::vector<Real>;

/// x' = f(t, x) - sum of B_j lambda_j: surfaces n_j . x = level_j, on which lambda_j is at most `strength_j` and
/// elsewhere has that size and the sign of n_j . x - level_j.
struct Surface {
  Vector normal, direction;  // n, B
  Real level, strength;
};
struct Sliding {
  std::function<Vector(Real, const Vector&)> f;
  std::vector<Surface> surfaces;
};

Real dot(const Vector& a, const Vector& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Steps of a thousandth by the classical Runge-Kutta method; changes within a step are located by bisection.
class Reference {
 public:
  Reference(Sliding system, Vector x) : system_(std::move(system)), x_(std::move(x)) {
    for (std::size_t j = 0; j < surfaces().size(); ++j) {
      const Real s = distance(j, x_);
      sides_.push_back(std::fabs(s) < touching ? 0 : (s > 0 ? 1 : -1));
    }
    release();
  }

  const Vector& to(Real end) {
    while (t_ < end - 1e-15L) step(std::min(end - t_, 1e-3L));
    return x_;
  }

 private:
  const std::vector<Surface>& surfaces() const { return system_.surfaces; }
  Real distance(std::size_t j, const Vector& x) const { return dot(surfaces()[j].normal, x) - surfaces()[j].level; }

  /// The forces: known on the surfaces that are left, solved for on the others, where n . x' = 0.
  Vector forces(Real t, const Vector& x) const {
    const std::size_t count = surfaces().size();
    const Vector f = system_.f(t, x);
    Vector force(count, 0);
    std::vector<std::size_t> held;
    for (std::size_t j = 0; j < count; ++j) {
      force[j] = sides_[j] * surfaces()[j].strength;
      if (sides_[j] == 0) held.push_back(j);
    }
    std::vector<Vector> rows;
    for (const std::size_t j : held) {
      Vector row;
      Real right = dot(surfaces()[j].normal, f);
      for (std::size_t k = 0; k < count; ++k) right -= dot(surfaces()[j].normal, surfaces()[k].direction) * force[k];
      for (const std::size_t k : held) row.push_back(dot(surfaces()[j].normal, surfaces()[k].direction));
      row.push_back(right);
      rows.push_back(std::move(row));
    }
    const Vector solved = solve(std::move(rows));
    for (std::size_t i = 0; i < held.size(); ++i) force[held[i]] = solved[i];
    return force;
  }

  /// By elimination; the matrices here are positive definite and at most three wide.
  static Vector solve(std::vector<Vector> rows) {
    const std::size_t n = rows.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const Real factor = rows[j][i] / rows[i][i];
        for (std::size_t k = 0; k <= n; ++k) rows[j][k] -= factor * rows[i][k];
      }
    }
    Vector x;
    for (std::size_t i = 0; i < n; ++i) x.push_back(rows[i][n] / rows[i][i]);
    return x;
  }

  Vector slope(Real t, const Vector& x) const {
    Vector f = system_.f(t, x);
    const Vector force = forces(t, x);
    for (std::size_t j = 0; j < force.size(); ++j) {
      for (std::size_t i = 0; i < f.size(); ++i) f[i] -= surfaces()[j].direction[i] * force[j];
    }
    return f;
  }

  Vector moved(Real h) const {
    const auto beyond = [&](const Vector& k, Real s) {
      Vector y = x_;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += s * k[i];
      return y;
    };
    const Vector k1 = slope(t_, x_), k2 = slope(t_ + h / 2, beyond(k1, h / 2));
    const Vector k3 = slope(t_ + h / 2, beyond(k2, h / 2)), k4 = slope(t_ + h, beyond(k3, h));
    Vector x = x_;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return x;
  }

  /// Whether a body reaches its surface, or sticking needs more than the greatest force of friction.
  bool changes(Real t, const Vector& x) const {
    const Vector force = forces(t, x);
    for (std::size_t j = 0; j < sides_.size(); ++j) {
      if (sides_[j] == 0 ? std::fabs(force[j]) > surfaces()[j].strength : sides_[j] * distance(j, x) < 0) return true;
    }
    return false;
  }

  void step(Real h) {
    const Vector x = moved(h);
    if (!changes(t_ + h, x)) {
      x_ = x;
      t_ += h;
      return;
    }
    Real before = 0, after = h;
    for (int i = 0; i < 60; ++i) {
      const Real middle = (before + after) / 2;
      (changes(t_ + middle, moved(middle)) ? after : before) = middle;
    }
    x_ = moved(after);
    t_ += after;
    for (std::size_t j = 0; j < sides_.size(); ++j) {
      if (sides_[j] * distance(j, x_) < 0) sides_[j] = 0;  // it sticks, until release() finds that it does not
    }
    release();
  }

  /// Releases the surface whose limit of friction is exceeded most, until none is exceeded.
  void release() {
    for (std::size_t again = 0; again < sides_.size(); ++again) {
      const Vector force = forces(t_, x_);
      std::size_t worst = 0;
      Real most = 0;
      for (std::size_t j = 0; j < sides_.size(); ++j) {
        const Real excess = std::fabs(force[j]) - surfaces()[j].strength;
        if (sides_[j] == 0 && excess > most) {
          most = excess;
          worst = j;
        }
      }
      if (most <= 0) return;
      sides_[worst] = force[worst] > 0 ? 1 : -1;
    }
  }

  static constexpr Real touching = 1e-14L;
  Sliding system_;
  Vector x_;
  Real t_ = 0;
  std::vector<int> sides_{};
};

struct Case {
  std::vector<std::string> columns;  // of the states, in the reference's order
  std::string text;
  double end;
  Sliding system;
  Vector start;
};

/// By the default method: every row within ten tolerances, in fewer than a thousand steps.
void expect_sliding_solution(const Case& c, double tolerance = 1e-6) {
  const model::Loaded loaded = model::load(model::Source("friction.sim", c.text));
  ASSERT_TRUE(loaded) << loaded.text();
  const model::Simulated simulated = simulate(
      *loaded.model, {.rtol = tolerance, .atol = {tolerance}, .to = c.end, .output = 0.05, .max_steps = 20'000});
  ASSERT_TRUE(simulated.run);
  const model::Run& run = *simulated.run;
  EXPECT_EQ(run.outcome.ending, Ending::reached_end) << describe(run.outcome);
  EXPECT_LT(run.statistics.steps, 1000u);
  Reference reference(c.system, c.start);
  std::vector<std::size_t> places;
  for (const std::string& name : c.columns) {
    const auto column = std::ranges::find(run.motion.columns, name, &model::Column::name);
    ASSERT_NE(column, run.motion.columns.end()) << name;
    places.push_back(static_cast<std::size_t>(column - run.motion.columns.begin()));
  }
  double worst = 0, when = 0;
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const double t = run.motion.time(row);
    const Vector& expected = reference.to(t);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double value = static_cast<double>(expected[i]);
      const double error = std::fabs(run.motion.row(row)[places[i]] - value) / (tolerance * (1 + std::fabs(value)));
      if (error > worst) {
        worst = error;
        when = t;
      }
    }
  }
  EXPECT_LE(worst, 10) << "tolerances, at t = " << when << "\n" << c.text;
  EXPECT_GE(run.final_time(), c.end);
}

Surface friction(Vector on, Real level, Real strength) {
  return {on, on, level, strength};
}

TEST(SlidingReference, TakesTwiceTheFrictionOffEachSwing) {
  // From 2 by -1.4 and 0.8 to -0.2, where the spring is weaker than the friction.
  Reference reference({[](Real, const Vector& x) { return Vector{x[1], -x[0]}; }, {friction({0, 1}, 0, 0.3L)}}, {2, 0});
  EXPECT_NEAR(static_cast<double>(reference.to(20)[0]), -0.2, 1e-12);
  EXPECT_NEAR(static_cast<double>(reference.to(20)[1]), 0, 1e-15);
}

// ---- one mass ----

Case pushed(const std::string& equation) {
  return {{"v"},
          equation + "\nv(0) = 1\nrun 0..20\n",
          20,
          {[](Real t, const Vector&) { return Vector{0.7L * std::sin(1.3L * t) + 0.2L * std::sin(3 * t)}; },
           {friction({1}, 0, 0.25L)}},
          {1}};
}

TEST(DryFriction, OfAPushedMassBySign) {
  const Case c = pushed("param m = 2, mu = 0.5\nv' = (1.4*sin(1.3*t) + 0.4*sin(3*t) - mu*sign(v))/m");
  expect_sliding_solution(c, 1e-6);
  expect_sliding_solution(c, 1e-9);
}

TEST(DryFriction, OfAPushedMassByIf) {
  expect_sliding_solution(pushed("v' = 0.7*sin(1.3*t) + 0.2*sin(3*t) + (if v > 0 then -0.25 else 0.25)"));
  expect_sliding_solution(pushed("let F = 0.7*sin(1.3*t) + 0.2*sin(3*t)\nv' = if v >= 0 then F - 0.25 else F + 0.25"));
}

TEST(DryFriction, HoldsWhatIsAtRest) {
  // The push is always weaker than the friction: nothing moves.
  expect_sliding_solution(
      {{"v"},
       "v' = 0.2*sin(3*t) - 0.3*sign(v)\nv(0) = 0\nrun 0..50\n",
       50,
       {[](Real t, const Vector&) { return Vector{0.2L * std::sin(3 * t)}; }, {friction({1}, 0, 0.3L)}},
       {0}});
}

TEST(DryFriction, OfAnOscillatorThatComesToRest) {
  expect_sliding_solution({{"x", "v"},
                           "x' = v; v' = -x - 0.3*sign(v)\nx(0) = 2; v(0) = 0\nrun 0..20\n",
                           20,
                           {[](Real, const Vector& x) { return Vector{x[1], -x[0]}; }, {friction({0, 1}, 0, 0.3L)}},
                           {2, 0}});
}

/// A mass on a spring on a moving belt, whose friction falls with the velocity: it sticks, tears off, and sticks again.
Case on_a_belt(const std::string& equations) {
  return {
      {"x", "v"},
      equations + "\nx(0) = 0; v(0) = 0.2\nrun 0..30\n",
      30,
      {[](Real, const Vector& x) { return Vector{x[1], -x[0] + 0.3L * (x[1] - 0.5L)}; }, {friction({0, 1}, 0.5L, 1)}},
      {0, 0.2L}};
}

TEST(DryFriction, OfAnOscillatorOnABeltBySign) {
  expect_sliding_solution(on_a_belt("x' = v; v' = -x + 0.3*(v - 0.5) - sign(v - 0.5)"));
}

TEST(DryFriction, OfAnOscillatorOnABeltByIf) {
  expect_sliding_solution(on_a_belt("x' = v; v' = -x + 0.3*(v - 0.5) + (if v > 0.5 then -1 else 1)"));
}

// ---- relays ----

/// The switch is y + 2 x: the motion reaches the line and slides to the origin along it.
Case relay_in_the_plane(const std::string& relay) {
  return {{"x", "y"},
          "x' = y; y' = " + relay + "\nx(0) = 1; y(0) = 0.4\nrun 0..8\n",
          8,
          {[](Real, const Vector& x) { return Vector{x[1], 0}; }, {Surface{{2, 1}, {0, 1}, 0, 3}}},
          {1, 0.4L}};
}

TEST(Relay, SlidesToTheOriginOfThePlane) {
  expect_sliding_solution(relay_in_the_plane("-3*sign(y + 2*x)"));
  expect_sliding_solution(relay_in_the_plane("if y + 2*x > 0 then -3 else 3"));
}

TEST(Relay, OfTwoStatesHoldsBothAtOnce) {
  // Each slides on its own line, then both at their crossing.
  expect_sliding_solution(
      {{"x", "y"},
       "x' = 0.5*sin(t) + 0.3*y - 1.5*sign(x); y' = 0.4*cos(2*t) - 0.2*x - sign(y - 0.2)\nx(0) = 1; y(0) = -1\n"
       "run 0..10\n",
       10,
       {[](Real t, const Vector& x) {
          return Vector{0.5L * std::sin(t) + 0.3L * x[1], 0.4L * std::cos(2 * t) - 0.2L * x[0]};
        },
        {friction({1, 0}, 0, 1.5L), friction({0, 1}, 0.2L, 1)}},
       {1, -1}});
}

// ---- chains ----

TEST(DryFriction, OfAChainOfThreeBlocksOnTheGround) {
  // The first block is pulled to and fro; each rubs on the ground, and some or all stick at times.
  expect_sliding_solution({{"x[1]", "x[2]", "x[3]", "v[1]", "v[2]", "v[3]"},
                           "param k = 4\n"
                           "for i in 1..3 { x[i]' = v[i]; x[i](0) = 0; v[i](0) = 0 }\n"
                           "v[1]' = 3*sin(0.9*t) - k*(x[1] - x[2]) - 0.6*sign(v[1])\n"
                           "v[2]' = k*(x[1] - x[2]) - k*(x[2] - x[3]) - 0.6*sign(v[2])\n"
                           "v[3]' = k*(x[2] - x[3]) - k*x[3] - 0.6*sign(v[3])\n"
                           "run 0..12\n",
                           12,
                           {[](Real t, const Vector& s) {
                              // States are in the order of the names above: x[1], x[2], x[3], v[1], v[2], v[3].
                              const Real *x = s.data(), *v = s.data() + 3;
                              return Vector{v[0],
                                            v[1],
                                            v[2],
                                            3 * std::sin(0.9L * t) - 4 * (x[0] - x[1]),
                                            4 * (x[0] - x[1]) - 4 * (x[1] - x[2]),
                                            4 * (x[1] - x[2]) - 4 * x[2]};
                            },
                            {friction({0, 0, 0, 1, 0, 0}, 0, 0.6L), friction({0, 0, 0, 0, 1, 0}, 0, 0.6L),
                             friction({0, 0, 0, 0, 0, 1}, 0, 0.6L)}},
                           Vector(6, 0)});
}

TEST(DryFriction, OfThreeBlocksOnOneAnother) {
  // Equal blocks, the lowest pulled: u1 = v1 - v2 and u2 = v2 - v3 are two surfaces that the motion slides on at once.
  expect_sliding_solution(
      {{"v1", "v2", "v3"},
       "let F = 2.5*sin(1.1*t)\n"
       "v1' = F - 0.8*sign(v1 - v2)\nv2' = 0.8*sign(v1 - v2) - 0.5*sign(v2 - v3)\nv3' = 0.5*sign(v2 - v3)\n"
       "v1(0) = 0.5; v2(0) = 0; v3(0) = -0.3\nrun 0..15\n",
       15,
       {[](Real t, const Vector&) { return Vector{2.5L * std::sin(1.1L * t), 0, 0}; },
        {friction({1, -1, 0}, 0, 0.8L), friction({0, 1, -1}, 0, 0.5L)}},
       {0.5L, 0, -0.3L}});
}

}  // namespace
}  // namespace continuo::hybrid
