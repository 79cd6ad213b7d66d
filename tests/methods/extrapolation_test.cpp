// The extrapolation tables of odex and seulex, and their dense output: the order of each entry, its error constant, and
// the order of the polynomial for each number of rows, in 113 bits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "implicit_problems.hpp"
#include <continuo/methods/extrapolation/odex.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>

namespace continuo::extrapolation_test {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<80>, boost::multiprecision::et_off>;
using X = std::array<Real, 2>;
using Place = std::pair<std::size_t, std::size_t>;  // row and column, from 1

/// A workspace after one step of h from an exact state, with so many rows.
template <class M>
auto after_step(testing::AnyProblem<Real>& problem, const Real& t, const Real& h, std::size_t rows, X& x_new) {
  const X x = problem.exact(t);
  auto work = M::workspace(x);
  work.rows = rows;
  M::step(problem, t, x, h, false, work, x_new);
  EXPECT_EQ(work.computed, rows);
  return work;
}

/// The errors of all entries of the table of one step of h.
template <class M>
std::map<Place, Real> errors_of_table(const Real& h) {
  auto problem = testing::any_problem<Real, testing::Forced>();
  const Real t(0.25);
  const X x = problem.exact(t), exact = problem.exact(Real(t + h));
  std::map<Place, Real> errors;
  for (std::size_t rows = 1; rows <= M::numbers.size(); ++rows) {
    X entry{};
    const auto work = after_step<M>(problem, t, h, rows, entry);
    for (std::size_t column = 1; column <= rows; ++column) {
      for (std::size_t i = 0; i < 2; ++i) entry[i] = x[i] + work.table[rows - column][i];
      errors[{rows, column}] = testing::greatest_difference(entry, exact);
    }
  }
  return errors;
}

/// The greatest error of the dense output of one step of h.
template <class M>
Real error_within_step(std::size_t rows, const Real& h) {
  auto problem = testing::any_problem<Real, testing::Forced>();
  const Real t(0.25);
  const X x = problem.exact(t);
  X x_new{}, between{};
  auto work = after_step<M>(problem, t, h, rows, x_new);
  Interpolant<X, M::dense_degree> interpolant(x);
  M::interpolate(problem, t, x, h, x_new, work, interpolant);
  Real worst(0);
  for (int i = 1; i < 16; ++i) {
    interpolant(Real(i) / 16, between);
    worst = std::max<Real>(worst, testing::greatest_difference(between, problem.exact(Real(t + i * h / 16))));
  }
  interpolant(Real(0), between);
  EXPECT_EQ(between, x);
  interpolant(Real(1), between);
  EXPECT_LT(testing::greatest_difference(between, x_new), Real("1e-70"));
  return worst;
}

// Errors below are not far enough above rounding, which numbers of substeps to high powers multiply.
const Real least_error("1e-60");

/// log2 of the ratio of the last two errors above rounding.
class Halvings {
 public:
  void add(const Real& error) {
    if (error < least_error) return;
    if (last_ > 0) order_ = std::log2(static_cast<double>(Real(last_ / error)));
    last_ = error;
  }
  [[nodiscard]] double order() const { return order_; }

 private:
  Real last_{};
  double order_ = 0;
};

template <class M>
class Extrapolation : public ::testing::Test {};
using Methods = ::testing::Types<Odex, Seulex>;
TYPED_TEST_SUITE(Extrapolation, Methods);

// T_jk has order p k: the error of one step is h^(p k + 1).
TYPED_TEST(Extrapolation, EachColumnOfTheTableHasItsOrder) {
  std::map<Place, Halvings> halvings;
  for (Real h(0.5); h > Real(1e-3); h /= 2)
    for (const auto& [place, error] : errors_of_table<TypeParam>(h)) halvings[place].add(error);
  for (const auto& [place, errors] : halvings) {
    const double expected = TypeParam::power * static_cast<double>(place.second) + 1;
    EXPECT_NEAR(errors.order(), expected, 0.3) << "row " << place.first << ", column " << place.second;
  }
}

// The error of T_jk is e_k h^(p k + 1) / (n_j ... n_(j-k+1))^p, and e_k is the same for all rows (Hairer, Norsett &
// Wanner, eq. II.9.9). What is left out is smaller by h.
TYPED_TEST(Extrapolation, TheErrorConstantsOfAColumnAreThoseOfItsNumbers) {
  const Real h = Real(1) / 1024;
  std::map<std::size_t, double> first;  // by column
  for (const auto& [place, error] : errors_of_table<TypeParam>(h)) {
    const auto [row, column] = place;
    Real product = error;
    for (std::size_t j = row - column + 1; j <= row; ++j)
      for (int power = 0; power < TypeParam::power; ++power) product *= TypeParam::numbers[j - 1];
    const double constant = static_cast<double>(product);
    const auto known = first.emplace(column, constant).first;
    EXPECT_NEAR(constant / known->second, 1, 0.02) << "row " << row << ", column " << column;
  }
  EXPECT_EQ(first.size(), TypeParam::numbers.size());
}

// With k rows: 2 k - 1 for odex, k for seulex; its error within one step is of an order more.
TYPED_TEST(Extrapolation, TheDenseOutputHasItsOrderForEachNumberOfRows) {
  for (std::size_t rows = 2; rows <= TypeParam::numbers.size(); ++rows) {
    Halvings halvings;
    for (Real h(0.5); h > Real(1e-3); h /= 2) halvings.add(error_within_step<TypeParam>(rows, h));
    const double expected = TypeParam::power * static_cast<double>(rows) + (TypeParam::power == 1 ? 1 : 0);
    EXPECT_NEAR(halvings.order(), expected, 0.4) << rows;
  }
}

// The order of the method is that of the most rows that it aims at and one more; of fixed steps, that of their rows.
TYPED_TEST(Extrapolation, StatesItsOrders) {
  constexpr int most = static_cast<int>(TypeParam::numbers.size());
  EXPECT_EQ(TypeParam::order, TypeParam::power * most);
  EXPECT_EQ(TypeParam::error_order, TypeParam::power * (most - 1));
  EXPECT_EQ(TypeParam::dense_order, TypeParam::power == 2 ? 2 * most - 1 : most);
  EXPECT_EQ(TypeParam::dense_degree, TypeParam::dense_order);
  EXPECT_EQ(TypeParam::order_of_fixed_steps, TypeParam::power * static_cast<int>(TypeParam::starting_rows));
}

TYPED_TEST(Extrapolation, FixedStepsHaveTheStatedOrder) {
  Halvings halvings;
  for (int n = 2; n <= 32; n *= 2)
    halvings.add(testing::error_of_steps<TypeParam, Real>(testing::any_problem<Real, testing::Forced>(), n));
  EXPECT_NEAR(halvings.order(), TypeParam::order_of_fixed_steps, 0.2);
}

}  // namespace
}  // namespace continuo::extrapolation_test
