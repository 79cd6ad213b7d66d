// The orders that docs/methods.md states for implicit methods are measured: on a nonstiff problem, on that of Prothero
// and Robinson, where a low stage order reduces the order, and on a system of index 1, each component by itself; of the
// states and of the dense output.
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <bench/problems/prothero_robinson.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "implicit_problems.hpp"
#include <continuo/methods/all.hpp>

namespace continuo::stiff_order_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
/// High orders need room before rounding.
template <class M>
using RealOf = std::conditional_t<(M::order > 8), Quad, long double>;
using testing::AnyProblem, testing::Forced;

/// D_0 = at(0), D_1 = at(0) - at(1), ...: the backward differences of `at`, a function of the number of steps back.
template <class Differences, class At>
void set_differences(Differences& D, const At& at) {
  for (std::size_t j = 0; j < D.size(); ++j) D[j] = at(static_cast<int>(j));
  for (std::size_t order = 1; order < D.size(); ++order)
    for (std::size_t j = D.size() - 1; j >= order; --j)
      for (std::size_t i = 0; i < D[j].size(); ++i) D[j][i] = D[j - 1][i] - D[j][i];
}

/// The formulas of `bdf`, each by its order k, fed with exact values for the steps before the first.
struct Ndf : Bdf {
  /// D of the exact values at t, t - h, t - 2 h, ...
  template <class Problem, State X>
  static void remember(Workspace<X>& work, std::size_t k, const Problem& problem, const Scalar<X>& t,
                       const Scalar<X>& h) {
    set_differences(work.D, [&](int i) { return problem.exact(Scalar<X>(t - i * h)); });
    work.h = h;
    work.order = k;
  }
  template <State X>
  static void accept(Workspace<X>& work) {
    work.next_order = work.order;
    Bdf::accept(work);
  }
};

/// The formulas of `adams` that predict from k values and have order k + 1 after correction, up to the order that can
/// be measured in the given numbers; with the same inputs.
template <int greatest>
struct AdamsMoulton : Adams {
  static constexpr int order = greatest;

  template <class Problem, State X>
  static void remember(Workspace<X>& work, std::size_t k, const Problem& problem, const Scalar<X>& t,
                       const Scalar<X>& h) {
    set_differences(work.phi, [&](int i) {
      const Scalar<X> before = t - i * h;
      X slope = problem.exact(before);
      problem(before, problem.exact(before), slope);
      return slope;
    });
    for (std::size_t i = 0; i < work.psi.size(); ++i) work.psi[i] = static_cast<int>(i + 1) * h;
    work.order = k;
    work.known = work.phi.size() - 1;
  }
  template <State X>
  static void accept(Workspace<X>& work) {
    work.next_order = work.order;
    Adams::accept(work);
  }
};

/// One formula of a method of variable order, at one of its orders.
template <class M>
constexpr bool formula = std::derived_from<M, Bdf> || std::derived_from<M, Adams>;
/// A method whose first step needs others before it has no dense output of its own in it.
template <class M>
constexpr bool one_step = !formula<M> && !std::same_as<M, Bdf2>;

/// The columns of the table, in its order.
enum Column { classical, classical_dense, stiff, stiff_dense, differential, algebraic, columns };
using Orders = std::array<std::optional<double>, columns>;

/// The stiff problem, twice: lambda h is beyond -1000 for every h here.
template <class Real>
struct Stiff {
  using One = bench::ProtheroRobinson<Real>;
  using X = std::array<Real, 2>;
  static constexpr int duration = 2;

  void operator()(const Real& t, const X& x, X& dxdt) const {
    for (std::size_t i = 0; i < 2; ++i) {
      typename One::State slope{};
      One{}(t, typename One::State{x[i]}, slope);
      dxdt[i] = slope[0];
    }
  }
  void jacobian(const Real&, const X&, std::span<Real> rows) const {
    rows[0] = rows[3] = One{}.lambda, rows[1] = rows[2] = 0;
  }
  void time_derivative(const Real& t, const X&, X& dfdt) const {
    typename One::State slope{};
    One{}.time_derivative(t, slope, slope);
    dfdt[0] = dfdt[1] = slope[0];
  }
  static X exact(const Real& t) {
    const Real x = One::exact(t)[0];
    return {x, x};
  }
};

/// x' = z, 0 = z + x^2/4 - (cos(t) + sin(t)^2/4): x = sin(t) and, by an equation of index 1, z = cos(t).
struct Algebraic {
  static constexpr int duration = 2;
  static double mass(std::size_t i) { return i == 0 ? 1 : 0; }
  template <class X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) const {
    using std::cos, std::sin;
    const Scalar<X> s = sin(t);
    dxdt[0] = x[1];
    dxdt[1] = x[1] - cos(t) + (x[0] * x[0] - s * s) / 4;
  }
  template <class X>
  void jacobian(const Scalar<X>&, const X& x, std::span<Scalar<X>> rows) const {
    rows[0] = 0, rows[1] = 1, rows[2] = x[0] / 2, rows[3] = 1;
  }
  template <class X>
  void time_derivative(const Scalar<X>& t, const X&, X& dfdt) const {
    using std::cos, std::sin;
    dfdt[0] = 0, dfdt[1] = sin(t) - sin(t) * cos(t) / 2;
  }
  template <class Real>
  static std::array<Real, 2> exact(const Real& t) {
    return Forced::exact(t);
  }
};

/// The error that `error_by` finds where the equations are solved a thousand times as closely as that; infinite where
/// they cannot be.
template <class M, class ErrorBy>
RealOf<M> of_solved_equations(const ErrorBy& error_by) {
  using Real = RealOf<M>;
  const auto solves_nothing = [](auto&) {};
  if constexpr (!detail::is_implicit<M>()) return error_by(solves_nothing);
  Real error(0);
  for (Real tolerance(0.001); tolerance > std::numeric_limits<Real>::epsilon(); tolerance /= 100) {
    error = error_by([&](auto& work) {
      if constexpr (requires { M::set_tolerance(work, Tolerance<Real>{}); })
        M::set_tolerance(work, Tolerance<Real>{tolerance, tolerance});
    });
    if (error > 1000 * tolerance) return error;
  }
  return error;
}

/// A workspace for steps of h from t on, with the exact state and, for formula k of a multistep method, exact earlier
/// values.
template <class M, class Real>
auto work_at(std::size_t k, const AnyProblem<Real>& problem, const Real& t, const Real& h) {
  const auto x = problem.exact(t);
  auto work = M::workspace(x);
  if constexpr (formula<M>) M::remember(work, k, problem, t, h);
  return work;
}

/// The greatest error of a component after n equal steps; infinite where one of them cannot be solved.
template <class M, class Real>
Real error_of_steps(AnyProblem<Real> problem, std::size_t k, int n, std::size_t component, const auto& set_tolerance) {
  using std::abs;
  const Real h = Real(problem.duration) / n;
  auto x = problem.exact(Real(0)), x_new = x;
  auto work = work_at<M>(k, problem, Real(0), h);
  set_tolerance(work);
  Real worst(0);
  for (int i = 0; i < n; ++i) {
    M::step(problem, Real(h * i), x, h, i == 0 && !formula<M>, work, x_new);
    // With a Jacobian of its own, as the driver would.
    if (one_step<M> && detail::status_of<M>(work) != StepStatus::done)
      M::step(problem, Real(h * i), x, h, true, work, x_new);
    if (detail::status_of<M>(work) != StepStatus::done) return std::numeric_limits<Real>::infinity();
    M::accept(work);
    x = x_new;
    worst = std::max<Real>(worst, abs(x[component] - problem.exact(Real(h * (i + 1)))[component]));
  }
  return worst;
}

/// The greatest error of the interpolant of one step from the exact state.
template <class M, class Real>
Real error_within_step(AnyProblem<Real> problem, std::size_t k, int n, const auto& set_tolerance) {
  using std::abs;
  // Formulas use values of many earlier steps: neither sine nor cosine may be near zero there.
  const Real t(formula<M> ? 1 : 0.25), h = Real(1) / n;
  auto x = problem.exact(t), x_new = x, value = x;
  auto work = work_at<M>(k, problem, t, h);
  set_tolerance(work);
  Interpolant<decltype(x), M::dense_degree> interpolant(x);
  M::step(problem, t, x, h, !formula<M>, work, x_new);
  M::interpolate(problem, t, x, h, x_new, work, interpolant);
  Real worst(0);
  for (Real theta(0.0625); theta < 1; theta += Real(0.0625)) {
    interpolant(theta, value);
    worst = std::max<Real>(worst, abs(value[0] - problem.exact(Real(t + theta * h))[0]));
  }
  return worst;
}

/// log2 of the ratio of the last two errors above rounding, each of half the step of the one before.
template <class Error>
std::optional<double> order_of(const Error& error) {
  using Real = decltype(error(1));
  using std::pow;
  const Real least = pow(std::numeric_limits<Real>::epsilon(), Real(0.65));
  std::optional<double> order;
  Real before = error(1);
  for (int n = 2; n <= 256; n *= 2) {
    const Real now = error(n);
    if (!(now > least)) break;
    const Real none = std::numeric_limits<Real>::infinity();
    if (before < none && now < none) order = std::log2(static_cast<double>(before / now));
    before = now;
  }
  return order;
}

template <class M>
std::optional<double> order_of_steps(const AnyProblem<RealOf<M>>& problem, std::size_t k, std::size_t component) {
  return order_of([&](int n) {
    return of_solved_equations<M>(
        [&](const auto& set_tolerance) { return error_of_steps<M>(problem, k, n, component, set_tolerance); });
  });
}

template <class M>
std::optional<double> order_within_step(const AnyProblem<RealOf<M>>& problem, std::size_t k) {
  return order_of([&](int n) {
    return of_solved_equations<M>(
        [&](const auto& set_tolerance) { return error_within_step<M>(problem, k, n, set_tolerance); });
  });
}

/// Of formula k where M is several.
template <class M>
Orders measured(std::size_t k) {
  using Real = RealOf<M>;
  const auto plain = testing::any_problem<Real, Forced>(), hard = testing::any_problem<Real, Stiff<Real>>(),
             index_1 = testing::any_problem<Real, Algebraic>();
  constexpr bool for_stiff = detail::is_implicit<M>();
  Orders orders;
  orders[classical] = order_of_steps<M>(plain, k, 0);
  if constexpr (one_step<M> || formula<M>) {
    // The error within one step is of an order more than that of many.
    if (const auto within = order_within_step<M>(plain, k)) orders[classical_dense] = *within - 1;
    if constexpr (for_stiff) orders[stiff_dense] = order_within_step<M>(hard, k);
  }
  if constexpr (for_stiff) {
    orders[stiff] = order_of_steps<M>(hard, k, 0);
    orders[differential] = order_of_steps<M>(index_1, k, 0);
    orders[algebraic] = order_of_steps<M>(index_1, k, 1);
  }
  return orders;
}

std::string row_of(std::string_view name, const Orders& orders) {
  std::ostringstream row;
  row.precision(1);
  row << std::fixed << "| `" << name << "` |";
  for (const auto& order : orders) {
    if (order) {
      row << ' ' << *order << " |";
    } else {
      row << " - |";
    }
  }
  return row.str();
}

using Documented = std::map<std::string, Orders, std::less<>>;

/// The rows of the table under "## Measured orders": | `name` | 1.0 | ... |.
Documented documented() {
  std::ifstream page(CONTINUO_SOURCE_DIR "/docs/methods.md");
  Documented rows;
  bool there = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) there = line == "## Measured orders";
    if (!there || !line.starts_with("| `")) continue;
    std::istringstream cells(line.substr(3));
    std::string name, cell;
    std::getline(cells, name, '`');
    std::getline(cells, cell, '|');
    Orders& orders = rows[name];
    for (std::size_t i = 0; i < columns && std::getline(cells, cell, '|'); ++i)
      if (cell != " - ") orders[i] = std::stod(cell);
  }
  return rows;
}

template <class M>
void expect_as_documented(const Documented& rows, std::string_view name, std::size_t k = 0) {
  const Orders orders = measured<M>(k);
  const auto row = rows.find(name);
  ASSERT_NE(row, rows.end()) << "docs/methods.md lacks " << row_of(name, orders);
  for (std::size_t i = 0; i < columns; ++i) {
    ASSERT_EQ(orders[i].has_value(), row->second[i].has_value()) << row_of(name, orders);
    // The last halving of the step is not the limit yet, and the libraries' sines differ in their last digit.
    if (!orders[i]) continue;
    EXPECT_NEAR(*orders[i], *row->second[i], 0.25) << row_of(name, orders);
  }
}

TEST(StiffOrder, IsTheDocumentedOneForEveryMethod) {
  if (std::numeric_limits<long double>::digits < 64)
    GTEST_SKIP() << "long double is double here: no room before rounding";
  const auto rows = documented();
  using Measured = std::tuple<ImplicitEuler, Trapezoidal, ImplicitMidpoint, Bdf2, TrBdf2, KenCarp4, Kvaerno5, Rkc2,
                              Rosenbrock23, Rodas4, Rodas5P, Gauss4, Radau5, Radau9, Radau13, Odex, Seulex>;
  for_each_method<Measured>([&]<class M>() { expect_as_documented<M>(rows, M::name); });
  for (std::size_t k = 1; k <= Bdf::greatest_order; ++k) expect_as_documented<Ndf>(rows, "ndf" + std::to_string(k), k);
  for (std::size_t k = 1; k <= Adams::greatest_order; ++k) {
    const auto expect = k < 8 ? expect_as_documented<AdamsMoulton<8>> : expect_as_documented<AdamsMoulton<13>>;
    expect(rows, "adams" + std::to_string(k + 1), k);
  }
  EXPECT_EQ(rows.size(), std::tuple_size_v<Measured> + Bdf::greatest_order + Adams::greatest_order);
}

}  // namespace
}  // namespace continuo::stiff_order_test
