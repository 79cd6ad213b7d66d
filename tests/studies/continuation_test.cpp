#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "coordinate_change.hpp"
#include "problems.hpp"
#include <continuo/studies/continuation.hpp>

namespace continuo::studies::continuation_test {
namespace {

TEST(Continuation, LorenzFromTheSide) {  // Hopf at rho = 24.7368..., and where it began, at 1, the pitchfork
  const double beta = 8.0 / 3, side = std::sqrt(beta * 13);
  const auto branch = continue_equilibrium(lorenz(14), {side, side, 13}, {.constant = 1, .low = 0.5, .high = 30});
  std::vector<double> hopf, crossing;
  for (const auto& point : branch.bifurcations) {
    if (point.kind == Bifurcation::hopf) hopf.push_back(point.at.constant);
    if (point.kind == Bifurcation::pitchfork) crossing.push_back(point.at.constant);
  }
  // The branch goes through the pitchfork to the other side and has a Hopf point there too.
  ASSERT_GE(hopf.size(), 1u);
  for (const double rho : hopf) EXPECT_NEAR(rho, 10 * (10 + beta + 3) / (10 - beta - 1), 1e-6);
  for (const auto& point : branch.bifurcations) {
    if (point.kind != Bifurcation::hopf) continue;
    const double rho = point.at.constant;  // frequency^2 = beta (sigma + rho)
    EXPECT_NEAR(point.frequency, std::sqrt(beta * (10 + rho)) / (2 * std::numbers::pi), 1e-6);
  }
  ASSERT_GE(crossing.size(), 1u);
  EXPECT_NEAR(crossing.front(), 1, 1e-10);
}

TEST(Continuation, LorenzFromTheOrigin) {
  const auto branch = continue_equilibrium(lorenz(0.5), {0, 0, 0}, {.constant = 1, .low = 0, .high = 3});
  EXPECT_TRUE(branch.status) << branch.status.message;
  ASSERT_EQ(branch.bifurcations.size(), 1u);
  EXPECT_EQ(branch.bifurcations[0].kind, Bifurcation::pitchfork);
  EXPECT_NEAR(branch.bifurcations[0].at.constant, 1, 1e-10);
  for (const auto& point : branch.points)
    EXPECT_EQ(point.stability, point.constant < 1 ? Stability::asymptotically_stable : Stability::saddle);
}

TEST(Continuation, AFoldIsRounded) {  // 0 = p - x^2: both branches, the fold at the origin
  const auto f = [](double, Values x, Values p, std::span<double> out) { out[0] = p[0] - x[0] * x[0]; };
  const auto branch = continue_equilibrium(parametric_system(1, f, {1.0}), {1}, {.low = -1, .high = 4});
  EXPECT_TRUE(branch.status) << branch.status.message;
  ASSERT_EQ(branch.bifurcations.size(), 1u);
  EXPECT_EQ(branch.bifurcations[0].kind, Bifurcation::fold);
  EXPECT_NEAR(branch.bifurcations[0].at.constant, 0, 1e-9);
  double low = 0, high = 0;
  for (const auto& point : branch.points) {
    EXPECT_NEAR(point.x[0] * point.x[0], point.constant, 1e-10);
    low = std::min(low, point.x[0]);
    high = std::max(high, point.x[0]);
  }
  EXPECT_LE(low, -1.9);  // x = -2 is where it leaves the range
  EXPECT_GE(high, 1.9);
}

// Normal forms in other coordinates, x = c + S(A y) with A a matrix and S adding squares: the places, kinds and
// coefficients of bifurcations are those of the normal form.
template <class T>
using Three = std::array<T, 3>;

struct Disguise {
  Three<double> origin{};
  std::array<Three<double>, 3> a{};
  double first_shear = 0, second_shear = 0;

  explicit Disguise(unsigned seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    for (std::size_t i = 0; i < 3; ++i) {
      origin[i] = 3 * number();
      for (std::size_t j = 0; j < 3; ++j) a[i][j] = (i == j ? 1.5 : 0) + 0.6 * number();
    }
    first_shear = number();
    second_shear = number();
  }
  template <class T>
  Three<T> back(const Three<T>& x) const {
    Three<T> z{x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]};
    z[2] -= second_shear * z[0] * z[1];
    z[1] -= first_shear * z[0] * z[0];
    z[2] += second_shear * z[0] * first_shear * z[0] * z[0];  // S first adds to z1, then z0 z1 before that to z2
    const auto det = [](const Three<T>& u, const Three<T>& v, const Three<T>& w) {
      return u[0] * (v[1] * w[2] - v[2] * w[1]) - v[0] * (u[1] * w[2] - u[2] * w[1]) +
             w[0] * (u[1] * v[2] - u[2] * v[1]);
    };
    std::array<Three<T>, 3> columns;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) columns[j][i] = T(a[i][j]);
    const T whole = det(columns[0], columns[1], columns[2]);
    return {det(z, columns[1], columns[2]) / whole, det(columns[0], z, columns[2]) / whole,
            det(columns[0], columns[1], z) / whole};
  }
  /// DS(A y) A g
  template <class T>
  Three<T> forth(const Three<T>& y, const Three<T>& g) const {
    Three<T> z{}, out{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) z[i] += a[i][j] * y[j], out[i] += a[i][j] * g[j];
    return {out[0], out[1] + 2 * first_shear * z[0] * out[0], out[2] + second_shear * (z[0] * out[1] + z[1] * out[0])};
  }
  double length(std::size_t column) const { return std::hypot(a[0][column], a[1][column], a[2][column]); }
};

/// g as a template over numbers; df/dx by a step along the imaginary axis, exact to rounding.
template <class G>
ParametricSystem disguised(const Disguise& disguise, double constant, G g) {
  const auto of = [=](const auto& x, double p) {
    const auto y = disguise.back(x);
    return disguise.forth(y, g(y, p));
  };
  auto system = parametric_system(3,
                                  [=](double, Values x, Values p, std::span<double> out) {
                                    std::ranges::copy(of(Three<double>{x[0], x[1], x[2]}, p[0]), out.begin());
                                  },
                                  {constant});
  system.jacobian = [=](double, Values x, Values p, std::span<double> rows) {
    using Complex = std::complex<double>;
    for (std::size_t j = 0; j < 3; ++j) {
      Three<Complex> moved{x[0], x[1], x[2]};
      moved[j] += Complex(0, 1e-40);
      const auto f = of(moved, p[0]);
      for (std::size_t i = 0; i < 3; ++i) rows[i * 3 + j] = f[i].imag() / 1e-40;
    }
  };
  return system;
}

std::vector<BifurcationPoint> of_kind(const Branch& branch, Bifurcation kind) {
  std::vector<BifurcationPoint> found;
  std::ranges::copy_if(branch.bifurcations, std::back_inserter(found),
                       [&](const auto& point) { return point.kind == kind; });
  return found;
}

TEST(NormalForms, FoldsHaveTheirCoefficient) {  // y1' = p - 0.3 + b y1^2: in units of the eigenvector b / |A e1|
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Disguise disguise(seed);
    const double b = 0.5 + 0.2 * seed;
    const auto system = disguised(disguise, 0.1, [b](const auto& y, double p) {
      return std::remove_cvref_t<decltype(y)>{p - 0.3 + b * y[0] * y[0], y[0] * y[0] - y[1], -2.0 * y[2] + y[0] * y[1]};
    });
    const double y = std::sqrt(0.2 / b);
    auto start = disguise.origin;
    for (std::size_t i = 0; i < 3; ++i) start[i] -= disguise.a[i][0] * y;
    const auto search = find_equilibrium(system, {start.begin(), start.end()}, system.constants);
    ASSERT_EQ(search.ending, EquilibriumEnding::found) << seed;
    const auto branch = continue_equilibrium(system, search.x, {.low = 0, .high = 1});
    const auto folds = of_kind(branch, Bifurcation::fold);
    ASSERT_EQ(folds.size(), 1u) << seed;
    EXPECT_NEAR(folds[0].at.constant, 0.3, 1e-10);
    // The error of x is the square root of the rounding of f, 1e-16.
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(folds[0].at.x[i], disguise.origin[i], 1e-6);
    ASSERT_TRUE(folds[0].coefficient);
    EXPECT_NEAR(std::abs(*folds[0].coefficient), b / disguise.length(0), 1e-5);
  }
}

TEST(NormalForms, CrossingsAreNamedAndTheOtherBranchIsFound) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    for (const bool pitchfork : {false, true}) {
      const Disguise disguise(seed);
      const auto system = disguised(disguise, 0.1, [pitchfork](const auto& y, double p) {
        return std::remove_cvref_t<decltype(y)>{(p - 0.4) * y[0] - (pitchfork ? y[0] * y[0] : y[0]) * y[0],
                                                y[0] * y[0] - y[1], -2.0 * y[2] + y[0] * y[1]};
      });
      const std::vector<double> rest(disguise.origin.begin(), disguise.origin.end());
      // Once from either side of where they cross: it is the same diagram.
      const auto diagram = continue_equilibria(system, {{0.1, rest}, {0.9, rest}}, {.low = 0, .high = 1});
      ASSERT_EQ(diagram.size(), 2u) << seed;
      EXPECT_EQ(diagram[0].starts, (std::vector<std::size_t>{0, 1}));
      EXPECT_EQ(diagram[1].crossed, 0u);
      const auto kind = pitchfork ? Bifurcation::pitchfork : Bifurcation::transcritical;
      const auto points = of_kind(diagram[0].branch, kind);
      ASSERT_EQ(points.size(), 1u) << seed;
      EXPECT_EQ(diagram[0].branch.bifurcations.size(), 1u);
      EXPECT_NEAR(points[0].at.constant, 0.4, 1e-11);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(points[0].at.x[i], disguise.origin[i], 1e-11);
      for (const BranchPoint& point : diagram[1].branch.points) {
        const auto y = disguise.back(Three<double>{point.x[0], point.x[1], point.x[2]});
        EXPECT_NEAR(point.constant - 0.4, pitchfork ? y[0] * y[0] : y[0], 1e-9);
      }
      EXPECT_TRUE(diagram[1].branch.status) << diagram[1].branch.status.message;
    }
  }
}

// z' = (p - 0.2 + i w) z + s z |z|^2 + k z y3, y3' = |z|^2 c - l y3: with y3 = c |z|^2 / l at the Hopf point s + k c /
// l stands before z |z|^2. In units of the eigenvector, |A q|^2 = (|A e1|^2 + |A e2|^2) / 2, and x = w q + conj(w q),
// l1 = 2 Re(s + k c / l) / (w |A q|^2).
TEST(NormalForms, HopfPointsHaveTheirLyapunovCoefficient) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Disguise disguise(seed);
    const double w = 0.8 + 0.3 * seed, s = 0.7, twist = 0.4, k = seed % 2 ? 1.0 : -1.0, c = 1.5, l = 1.2;
    const auto system = disguised(disguise, 0, [=](const auto& y, double p) {
      const auto square = y[0] * y[0] + y[1] * y[1];
      const auto grow = p - 0.2 + s * square + k * y[2], turn = w + twist * square;
      return std::remove_cvref_t<decltype(y)>{grow * y[0] - turn * y[1], grow * y[1] + turn * y[0],
                                              c * square - l * y[2]};
    });
    const std::vector<double> rest(disguise.origin.begin(), disguise.origin.end());
    const auto branch = continue_equilibrium(system, rest, {.low = -1, .high = 1});
    const auto points = of_kind(branch, Bifurcation::hopf);
    ASSERT_EQ(points.size(), 1u) << seed;
    EXPECT_NEAR(points[0].at.constant, 0.2, 1e-10);
    EXPECT_NEAR(points[0].frequency, w / (2 * std::numbers::pi), 1e-10);
    const double unit = (std::pow(disguise.length(0), 2) + std::pow(disguise.length(1), 2)) / 2;
    ASSERT_TRUE(points[0].coefficient);
    const double expected = 2 * (s + k * c / l) / (w * unit);
    // Differences of df/dx that leave 1e-11 / h^2 of rounding, h = 3e-3.
    EXPECT_NEAR(*points[0].coefficient, expected, 1e-6 * (1 + std::abs(expected)));
  }
}

// A Hopf point at p0 besides a pair that is on the imaginary axis for all p, as with a conserved quantity: only the
// Hopf point is found, also where the branch begins there; without it, nothing is found.
TEST(Continuation, HopfPointsBesideAPairThatStaysOnTheAxis) {
  for (unsigned seed = 1; seed <= 120; ++seed) {
    const CoordinateChange<5> change(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.3, 3);
    const bool passes = seed % 3 != 0;
    const double p0 = seed % 5 == 0 ? 0 : number(random) - 1.5, w = number(random), v = w + number(random),
                 decay = number(random);
    // The constant moves one pair through the axis, or leaves it on one side.
    const auto of = [=](const auto& x, double p) {
      const auto y = change.back(x);
      const auto grow = passes ? p - p0 : -0.5 - p * p;
      return change.forth(
          y, std::remove_cvref_t<decltype(y)>{grow * y[0] - w * y[1] - y[0] * y[0] * y[0], w * y[0] + grow * y[1],
                                              -v * y[3], v * y[2], -decay * y[4]});
    };
    auto system = parametric_system(5,
                                    [of](double, Values x, Values p, std::span<double> out) {
                                      std::array<double, 5> at{};
                                      std::copy_n(x.begin(), 5, at.begin());
                                      std::ranges::copy(of(at, p[0]), out.begin());
                                    },
                                    {0.0});
    system.jacobian = [of](double, Values x, Values p, std::span<double> rows) {
      for (std::size_t j = 0; j < 5; ++j) {
        std::array<std::complex<double>, 5> moved{};
        std::copy_n(x.begin(), 5, moved.begin());
        moved[j] += std::complex<double>(0, 1e-40);
        const auto f = of(moved, p[0]);
        for (std::size_t i = 0; i < 5; ++i) rows[i * 5 + j] = f[i].imag() / 1e-40;
      }
    };
    const auto rest = change.place(std::array<double, 5>{});
    const auto branch = continue_equilibrium(system, {rest.begin(), rest.end()}, {.low = -2, .high = 2});
    EXPECT_TRUE(branch.status) << seed << ": " << branch.status.message;
    ASSERT_EQ(branch.bifurcations.size(), passes ? 1u : 0u) << seed;
    if (!passes) continue;
    EXPECT_EQ(branch.bifurcations[0].kind, Bifurcation::hopf) << seed;
    EXPECT_NEAR(branch.bifurcations[0].at.constant, p0, 1e-9) << seed;
    EXPECT_NEAR(branch.bifurcations[0].frequency, w / (2 * std::numbers::pi), 1e-9) << seed;
  }
}

TEST(Continuation, HaresAndLynxesGoRoundWhateverTheyEat) {  // a centre all along: trace 0 but for rounding
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = 1.5 * x[0] - p[0] * x[0] * x[1];
    out[1] = -3 * x[1] + p[0] * x[0] * x[1];
  };
  const auto branch = continue_equilibrium(parametric_system(2, f, {1.0}), {3, 1.5}, {.low = 0.01, .high = 3});
  EXPECT_TRUE(branch.bifurcations.empty());
}

TEST(Continuation, APairThatComesToTheAxisAndStaysIsNoHopfPoint) {  // x'' = -x - max(0, p) x'
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[1];
    out[1] = -x[0] - std::max(0.0, p[0]) * x[1];
  };
  const auto branch = continue_equilibrium(parametric_system(2, f, {0.5}), {0, 0}, {.low = -1, .high = 1});
  EXPECT_TRUE(branch.status) << branch.status.message;
  EXPECT_TRUE(branch.bifurcations.empty());
}

TEST(Continuation, ALineOfRestsIsNoPitchfork) {  // x' = p x, at p = 0 any x; and x' = p x - x^3 beside it is one
  for (const double cubic : {0.0, 1.0}) {
    const auto f = [cubic](double, Values x, Values p, std::span<double> out) {
      out[0] = p[0] * x[0] - cubic * x[0] * x[0] * x[0];
    };
    const auto branch = continue_equilibrium(parametric_system(1, f, {-0.53}), {0}, {.low = -1, .high = 1});
    ASSERT_EQ(branch.bifurcations.size(), 1u);
    EXPECT_EQ(branch.bifurcations[0].kind, cubic == 0 ? Bifurcation::crossing : Bifurcation::pitchfork);
    EXPECT_NEAR(branch.bifurcations[0].at.constant, 0, 1e-10);
  }
}

// z' = (p + i w) z but for terms that keep |z|: nothing of third order grows or decays.
TEST(NormalForms, ACoefficientThatIsZeroIsSaidToBe) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    const double turn = 1.3 + x[0] * x[0] + x[1] * x[1];
    out[0] = p[0] * x[0] - turn * x[1];
    out[1] = p[0] * x[1] + turn * x[0];
  };
  const auto branch = continue_equilibrium(parametric_system(2, f, {-0.5}), {0, 0}, {.low = -1, .high = 1});
  ASSERT_EQ(branch.bifurcations.size(), 1u);
  EXPECT_EQ(branch.bifurcations[0].coefficient, 0);
}

TEST(Continuation, WhatGoesToInfinityIsSaidToDoSo) {  // x = 1 / p
  const auto f = [](double, Values x, Values p, std::span<double> out) { out[0] = 1 - p[0] * x[0]; };
  const auto branch = continue_equilibrium(parametric_system(1, f, {1.0}), {1}, {.low = 0, .high = 2});
  EXPECT_FALSE(branch.status);
  EXPECT_NE(branch.status.message.find("infinity"), std::string_view::npos) << branch.status.message;
  EXPECT_LE(branch.points.size(), 400u);
}

// The equilibria are the circle x^2 + p^2 = 1, beside an oscillator whose pair has the real part x - 0.3: Hopf points
// at p = +-sqrt(0.91), folds at p = +-1.
TEST(Continuation, AClosedBranchIsFollowedOnceRound) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    const double grow = x[0] - 0.3 - x[1] * x[1] - x[2] * x[2];
    out[0] = 1 - x[0] * x[0] - p[0] * p[0];
    out[1] = grow * x[1] - x[2];
    out[2] = x[1] + grow * x[2];
  };
  for (const double angle : {0.0, 0.1, 0.25, 0.31, 0.5, 1.2, 2.0, 3.0, 4.0, 5.0}) {
    const auto branch = continue_equilibrium(parametric_system(3, f, {std::sin(angle)}), {std::cos(angle), 0, 0},
                                             {.low = -2, .high = 2});
    EXPECT_TRUE(branch.status && branch.closed) << angle << ": " << branch.status.message;
    EXPECT_EQ(branch.points.front().x, branch.points.back().x) << angle;
    std::vector<double> hopf, folds;
    for (const auto& point : branch.bifurcations)
      (point.kind == Bifurcation::hopf ? hopf : folds).push_back(point.at.constant);
    std::ranges::sort(hopf);
    std::ranges::sort(folds);
    ASSERT_EQ(hopf.size(), 2u) << angle;
    ASSERT_EQ(folds.size(), 2u) << angle;
    for (const std::size_t k : {0u, 1u}) {
      EXPECT_NEAR(hopf[k], (k == 0 ? -1 : 1) * std::sqrt(0.91), 1e-9) << angle;
      EXPECT_NEAR(folds[k], k == 0 ? -1 : 1, 1e-9) << angle;
    }
    double turned = 0;  // once round, and no piece twice
    for (std::size_t k = 1; k < branch.points.size(); ++k) {
      const auto &a = branch.points[k - 1], &b = branch.points[k];
      turned += std::asin(a.x[0] * b.constant - b.x[0] * a.constant);
    }
    EXPECT_NEAR(std::abs(turned), 2 * std::numbers::pi, 1e-6) << angle;
  }
}

TEST(Continuation, AClosedBranchAcrossAnotherIsFollowedOnceRound) {  // x = 0 and the circle meet at p = +-1
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = x[0] * (1 - x[0] * x[0] - p[0] * p[0]);
  };
  const auto system = parametric_system(1, f, {-1.5});
  const ContinuationOptions options{.low = -2, .high = 2};
  const auto diagram = continue_equilibria(system, {{-1.5, {0}}}, options);
  ASSERT_EQ(diagram.size(), 2u);
  EXPECT_FALSE(diagram[0].branch.closed);
  EXPECT_TRUE(diagram[1].branch.status && diagram[1].branch.closed) << diagram[1].branch.status.message;
  for (const auto& one : diagram) {
    ASSERT_EQ(one.branch.bifurcations.size(), 2u);
    for (const auto& point : one.branch.bifurcations) {
      EXPECT_EQ(point.kind, Bifurcation::pitchfork);
      EXPECT_NEAR(std::abs(point.at.constant), 1, 1e-9);
    }
    EXPECT_LT(one.branch.bifurcations[0].at.constant * one.branch.bifurcations[1].at.constant, 0);
  }
}

// x' = p (x - 1) (x + 1), y' = -y: at p = 0 every x is an equilibrium, and this line crosses both branches where they
// leave the range.
TEST(Continuation, BranchesThatMeetAtTheBoundAreListedOnce) {
  const auto f = [](double, Values x, Values p, std::span<double> out) {
    out[0] = p[0] * (x[0] - 1) * (x[0] + 1);
    out[1] = -x[1];
  };
  const auto diagram =
      continue_equilibria(parametric_system(2, f, {0.5}), {{0.5, {1, 0}}, {0.5, {-1, 0}}}, {.low = 0, .high = 2});
  ASSERT_EQ(diagram.size(), 3u);  // the two, and the line
  for (const std::size_t k : {0u, 1u}) {
    const auto& points = diagram[k].branch.points;
    EXPECT_NEAR(std::min(points.front().constant, points.back().constant), 0, 1e-6);
    EXPECT_EQ(std::max(points.front().constant, points.back().constant), 2);
  }
  for (const auto& point : diagram[2].branch.points) EXPECT_NEAR(point.constant, 0, 1e-9);
}

TEST(Continuation, WithoutAStartItSaysSo) {
  const auto f = [](double, Values x, Values p, std::span<double> out) { out[0] = p[0] + x[0] * x[0]; };
  const auto branch = continue_equilibrium(parametric_system(1, f, {1.0}), {1}, {.low = 0, .high = 4});
  EXPECT_TRUE(branch.points.empty());
  EXPECT_FALSE(branch.status.message.empty());
}

}  // namespace
}  // namespace continuo::studies::continuation_test
