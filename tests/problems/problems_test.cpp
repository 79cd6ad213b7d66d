// The test problems of bench/problems: their derivatives, their invariants, and their reference states.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <bench/problems/brusselator.hpp>
#include <bench/problems/brusselator_line.hpp>
#include <bench/problems/brusselator_line_reference.hpp>
#include <bench/problems/henon_heiles.hpp>
#include <bench/problems/hires.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lotka_volterra.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pendulum.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/prothero_robinson.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <bench/reference/end_values.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

/// A state near x, without special values in its components.
template <class X>
X moved(X x) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i] * 1.25 + 0.01 * static_cast<double>(i + 1);
  return x;
}

/// The Jacobian against that of dual numbers. An entry is a sum of at most six terms, none of them larger than the
/// largest entry of its row by more than a small factor: some tens of roundings.
template <std::size_t Size, class Problem>
void expect_exact_jacobian(const Problem& problem) {
  using Dual = ceres::Jet<double, static_cast<int>(Size)>;
  const auto x = moved(problem.start());
  ASSERT_EQ(x.size(), Size);
  std::vector<Dual> dual(Size), slope(Size);
  for (std::size_t i = 0; i < Size; ++i) dual[i] = Dual(x[i], static_cast<int>(i));
  problem(0.5, dual, slope);
  std::vector<double> rows(Size * Size);
  problem.jacobian(0.5, x, rows);
  for (std::size_t i = 0; i < Size; ++i) {
    const auto& row = slope[i].v;
    for (std::size_t j = 0; j < Size; ++j) {
      EXPECT_NEAR(rows[i * Size + j], row[static_cast<Eigen::Index>(j)], 30 * epsilon * row.cwiseAbs().maxCoeff())
          << Problem::name << ", row " << i << ", column " << j;
    }
  }
}

TEST(Problems, TheirJacobiansAreExact) {
  expect_exact_jacobian<2>(Brusselator{});
  expect_exact_jacobian<4>(HenonHeiles{});
  expect_exact_jacobian<8>(Hires{});
  expect_exact_jacobian<2>(LotkaVolterra{});
  expect_exact_jacobian<3>(Oregonator{});
  expect_exact_jacobian<2>(Pendulum{});
  expect_exact_jacobian<20>(Pollution{});
  expect_exact_jacobian<1>(ProtheroRobinson{});
  expect_exact_jacobian<3>(Robertson{});
  expect_exact_jacobian<2>(VanDerPol{});
  expect_exact_jacobian<2>(VanDerPolScaled{});
  expect_exact_jacobian<10>(BrusselatorLine<>{.points = 5});
}

TEST(Problems, TheLineOfBrusselatorsVisitsItsEntriesInOrderAndWithinItsBands) {
  const BrusselatorLine<> problem{.points = 50};
  std::size_t last = 0, count = 0;
  problem.jacobian_entries(problem.start(), [&](std::size_t row, std::size_t column, double) {
    const std::size_t place = row * 100 + column;
    EXPECT_TRUE(count == 0 || place > last);
    EXPECT_LE(row > column ? row - column : column - row, problem.bands);
    last = place;
    ++count;
  });
  EXPECT_EQ(count, 4u * 100u - 4u);  // two of its own, two neighbours, of which the ends lack one
}

TEST(Problems, TheDerivativeOfProtheroAndRobinsonsByTimeIsExact) {
  using Dual = ceres::Jet<double, 1>;
  const ProtheroRobinson problem;
  const double t = 0.7;
  const std::array<double, 1> x{0.25};
  std::array<Dual, 1> slope;
  problem(Dual(t, 0), std::array{Dual(x[0])}, slope);
  std::array<double, 1> by_time{};
  problem.time_derivative(t, x, by_time);
  EXPECT_NEAR(by_time[0], slope[0].v[0], 4 * epsilon * std::abs(by_time[0]));
}

/// Along the solution, f is its derivative. Rounding of f is that of its terms, at most `terms`.
template <class Problem, class Exact>
void expect_solution(const Problem& problem, const Exact& exact, double t, double terms) {
  using Dual = ceres::Jet<double, 1>;
  const auto x = exact(t);
  const auto moving = exact(Dual(t, 0));
  auto slope = x;
  problem(t, x, slope);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(slope[i], moving[i].v[0], 20 * epsilon * terms) << t;
}

TEST(Problems, TheirClosedFormsAreSolutions) {
  const ProtheroRobinson problem;
  for (const double t : {0.0, 0.5, 3.0, 10.0}) {
    expect_solution(Kepler{}, [](const auto& at) { return Kepler::exact(at); }, t, 4);  // the pull is 1 / r^2 <= 4
    const auto exact = [](const auto& at) { return ProtheroRobinson<std::decay_t<decltype(at)>>::exact(at); };
    expect_solution(problem, exact, t, 1 - problem.lambda);
  }
  for (std::size_t i = 0; i < Kepler::size; ++i) EXPECT_NEAR(Kepler::exact(0.0)[i], Kepler::start()[i], 4 * epsilon);
  const auto end = Kepler::exact(Quad(Kepler::duration));
  for (std::size_t i = 0; i < Kepler::size; ++i) {
    EXPECT_NEAR(static_cast<double>(end[i]), end_value<Kepler>[i], 2 * epsilon) << i;
  }
}

/// A conserved quantity has at every reference state its value at the start, to 28 digits.
template <class Problem, class Conserved>
void expect_conserved(const Conserved& conserved, double within) {
  const Quad start = conserved(Problem::start());
  for (const auto& reference : Problem::reference()) {
    EXPECT_NEAR(static_cast<double>(Quad(conserved(reference.x) - start)), 0, within)
        << Problem::name << " at t = " << reference.t;
  }
}

TEST(Problems, TheirReferenceStatesKeepWhatIsConserved) {
  expect_conserved<Robertson<Quad>>([](const auto& x) { return Quad(x[0] + x[1] + x[2]); }, 1e-27);
  expect_conserved<Hires<Quad>>([](const auto& x) { return Quad(x[6] + x[7]); }, 1e-29);
  for (const auto& weights : Pollution<>::invariants) {
    const auto sum = [&](const auto& x) {
      Quad total = 0;
      for (std::size_t i = 0; i < x.size(); ++i) total += weights[i] * x[i];
      return total;
    };
    expect_conserved<Pollution<Quad>>(sum, 1e-27);
  }
  // The next ones are invariants of the motion that no linear method keeps: the digits themselves are judged.
  const auto volterra = [](const auto& x) { return Quad(x[0] - 3 * log(x[0]) + x[1] - Quad(1.5) * log(x[1])); };
  expect_conserved<LotkaVolterra<Quad>>(volterra, 1e-24);
  expect_conserved<Pendulum<Quad>>([](const auto& x) { return Quad(x[1] * x[1] / 2 - cos(x[0])); }, 1e-24);
  const auto henon_heiles = [](const auto& x) {
    const Quad squares = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
    return Quad(squares / 2 + x[0] * x[0] * x[1] - x[1] * x[1] * x[1] / 3);
  };
  expect_conserved<HenonHeiles<Quad>>(henon_heiles, 1e-27);
}

/// Verner's method in long double comes as much nearer to the end state as its tolerance shrinks, by at least a tenth
/// of that: these digits, and no others, are its limit. No constant of the problem's condition is needed.
template <class Problem, class End>
void expect_approached(const End& exact) {
  using X = std::array<long double, Problem::size>;
  X start;
  std::ranges::copy(Problem::start(), start.begin());
  const auto error = [&](long double tolerance) {
    const auto end = solve(Problem{}, start, {0, Problem::duration}, Verner9{},
                           {.rtol = tolerance, .atol = tolerance, .save = Save<X>::only_end()})
                         .final_state();
    long double worst = 0;
    for (std::size_t i = 0; i < end.size(); ++i) worst = std::max<long double>(worst, std::abs(end[i] - exact[i]));
    return worst;
  };
  EXPECT_LT(error(1e-15L), error(1e-12L) / 100) << Problem::name;
}

TEST(Problems, AMethodOfTheLibraryApproachesTheirEnds) {
  expect_approached<Brusselator<long double>>(end_of<Brusselator<long double>>());
  expect_approached<HenonHeiles<long double>>(end_of<HenonHeiles<long double>>());
  expect_approached<LotkaVolterra<long double>>(end_of<LotkaVolterra<long double>>());
  expect_approached<Pendulum<long double>>(end_of<Pendulum<long double>>());
  expect_approached<Lorenz>(end_value<Lorenz>);
  expect_approached<Arenstorf>(end_value<Arenstorf>);
  expect_approached<Kepler>(end_value<Kepler>);
  expect_approached<Pleiades>(end_value<Pleiades>);
  expect_approached<OuterPlanets>(end_value<OuterPlanets>);
  expect_approached<OuterPlanetsMillennium>(end_value<OuterPlanetsMillennium>);
}

TEST(Problems, TheEndOfTheLineOfBrusselatorsIsThePublishedOne) {
  // E. Hairer, G. Wanner: the first and the last of the values of their programs, 16 digits.
  const auto end = brusselator_line_end<double>();
  ASSERT_EQ(end.size(), every_seventh(BrusselatorLine{}.start()).size());
  EXPECT_NEAR(end[0], 0.9949197002317599, 1e-13);
  EXPECT_NEAR(end[1], 3.0213845767604077, 1e-13);
  EXPECT_NEAR(end[141], 3.0384245041548366, 1e-13);
  EXPECT_NEAR(end[142], 0.9848367306701233, 1e-13);
}

}  // namespace
}  // namespace continuo::bench
