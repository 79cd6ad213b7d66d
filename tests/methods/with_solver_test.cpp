// Implicit methods whose linear systems are solved by GMRES or by a solver of the user's, against the same methods with
// a factorization, and against closed forms.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/multistep/bdf2.hpp>
#include <continuo/methods/multistep/bdf_krylov.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/methods/with_solver.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::with_solver_test {
namespace {

using X = std::vector<double>;

/// M x' = A x - k x^3 + g cos(t), with A row by row and a diagonal M: of one type for all problems, so that each method
/// is compiled once.
struct Problem {
  std::size_t n;
  X a;
  double cubic = 0;
  X forcing{}, masses{};

  void operator()(double t, const X& x, X& dxdt) const {
    for (std::size_t i = 0; i < n; ++i) {
      double sum = -cubic * x[i] * x[i] * x[i] + (forcing.empty() ? 0 : forcing[i] * std::cos(t));
      for (std::size_t j = 0; j < n; ++j) sum += a[i * n + j] * x[j];
      dxdt[i] = sum;
    }
  }
  void jacobian(double, const X& x, std::span<double> rows) const {
    for (std::size_t i = 0; i < n * n; ++i) rows[i] = a[i];
    for (std::size_t i = 0; i < n; ++i) rows[i * n + i] -= 3 * cubic * x[i] * x[i];
  }
  bool has_mass() const { return !masses.empty(); }
  double mass(std::size_t i) const { return masses[i]; }
};

Problem heat_on_a_line(std::size_t n) {
  const auto stiffness = std::pow(static_cast<double>(n + 1), 2);
  Problem problem{n, X(n * n, 0), 1, X(n, 1)};
  for (std::size_t i = 0; i < n; ++i) {
    problem.a[i * n + i] = -2 * stiffness;
    if (i > 0) problem.a[i * n + i - 1] = stiffness;
    if (i + 1 < n) problem.a[i * n + i + 1] = stiffness;
  }
  return problem;
}

/// u_t = Laplacian u - 40 u_x - 20 u_y on the unit square, central differences.
Problem advection_and_diffusion(std::size_t side) {
  const std::size_t n = side * side;
  const double dx = 1 / static_cast<double>(side + 1);
  Problem problem{n, X(n * n, 0), 0, X(n, 1)};
  const auto add = [&](std::size_t from, std::size_t to, double value) { problem.a[from * n + to] += value; };
  for (std::size_t i = 0; i < side; ++i) {
    for (std::size_t j = 0; j < side; ++j) {
      const std::size_t here = i * side + j;
      add(here, here, -4 / (dx * dx));
      if (j > 0) add(here, here - 1, 1 / (dx * dx) + 40 / (2 * dx));
      if (j + 1 < side) add(here, here + 1, 1 / (dx * dx) - 40 / (2 * dx));
      if (i > 0) add(here, here - side, 1 / (dx * dx) + 20 / (2 * dx));
      if (i + 1 < side) add(here, here + side, 1 / (dx * dx) - 20 / (2 * dx));
    }
  }
  return problem;
}

/// x' = -x + z, 0 = x - 2 z + cos(t), for several pairs (x, z) that are coupled a little.
Problem differential_and_algebraic(std::size_t pairs) {
  const std::size_t n = 2 * pairs;
  Problem problem{n, X(n * n, 0), 0, X(n, 0), X(n, 1)};
  for (std::size_t i = 0; i < pairs; ++i) {
    const std::size_t x = 2 * i, z = 2 * i + 1;
    problem.masses[z] = 0;
    problem.forcing[z] = 1;
    problem.a[x * n + x] = -1 - 100 * static_cast<double>(i);
    problem.a[x * n + z] = problem.a[z * n + x] = 1;
    problem.a[z * n + z] = -2;
    if (i > 0) problem.a[z * n + z - 2] = 0.3;
  }
  return problem;
}

/// Half a wave.
X start_of(const Problem& problem) {
  X x(problem.n);
  for (std::size_t i = 0; i < problem.n; ++i)
    x[i] = std::sin(std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(problem.n + 1));
  return x;
}

/// Steps of one size. All of them must be solved.
template <class M>
X after_steps(Problem problem, X x, double h, int steps, const Tolerance<double>& tolerance) {
  auto work = M::workspace(x);
  X x_new = x;
  for (int k = 0; k < steps; ++k) {
    M::set_tolerance(work, tolerance);
    (void)M::step(problem, k * h, x, h, k == 0, work, x_new);
    EXPECT_EQ(M::status(work), StepStatus::done) << M::name << ", step " << k;
    M::accept(work);
    x = x_new;
  }
  return x;
}

// Both solve the same equations. An iteration stops at most 0.03 tolerances from their solution, GMRES within a
// millionth of one; the methods damp what earlier steps were off. Linearly implicit methods do not iterate: there the
// millionths alone differ, of some ten stages that multiply an error by less than a thousand.
template <class M>
void expect_the_same_steps(const Problem& problem, const X& x, double h) {
  constexpr bool iterates = !requires { M::tableau.gamma_sum; } && !std::is_same_v<M, Seulex>;
  constexpr int steps = 8;
  const Tolerance<double> tolerance{1e-5, 1e-7};
  const X direct = after_steps<M>(problem, x, h, steps, tolerance);
  const X krylov = after_steps<Krylov<M>>(problem, x, h, steps, tolerance);
  for (std::size_t i = 0; i < problem.n; ++i)
    EXPECT_NEAR(krylov[i], direct[i], steps * (iterates ? 0.06 : 1e-2) * tolerance.scale(i, x[i], direct[i]))
        << M::name << ", component " << i;
}

template <class M>
class EveryImplicitMethod : public ::testing::Test {};
using Methods = ::testing::Types<ImplicitEuler, Trapezoidal, ImplicitMidpoint, TrBdf2, KenCarp4, Kvaerno5, Bdf2, Bdf,
                                 Rosenbrock23, Rodas4, Rodas5P, Seulex, Gauss4, Radau>;
TYPED_TEST_SUITE(EveryImplicitMethod, Methods);

TYPED_TEST(EveryImplicitMethod, TakesTheSameStepsByGmres) {
  for (const double h : {1e-4, 5e-3}) {
    for (const Problem& problem : {heat_on_a_line(20), advection_and_diffusion(5)})
      expect_the_same_steps<TypeParam>(problem, start_of(problem), h);
  }
  const Problem algebraic = differential_and_algebraic(4);
  X x = start_of(algebraic);
  ASSERT_TRUE(make_consistent(algebraic, 0.0, x, Tolerance<double>{1e-10, 1e-10}));
  expect_the_same_steps<TypeParam>(algebraic, x, 2e-2);
}

/// x' = V D V^T x with a random orthogonal V; D has decays between 1 and 1e5 and a pair that oscillates.
struct RandomLinear {
  static constexpr std::size_t n = 12;
  Problem problem{n, X(n* n, 0)};
  X vectors = X(n * n, 0), rates = X(n, 0);
  double frequency = 20;

  explicit RandomLinear(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    for (std::size_t i = 0; i < n; ++i) vectors[i * n + i] = 1;
    for (int turn = 0; turn < 200; ++turn) {
      const std::size_t i = random() % n, j = (i + 1 + random() % (n - 1)) % n;
      const double angle = 2 * std::numbers::pi * part(random), c = std::cos(angle), s = std::sin(angle);
      for (std::size_t k = 0; k < n; ++k) {
        double &u = vectors[k * n + i], &v = vectors[k * n + j];
        const double u_new = c * u - s * v;
        v = s * u + c * v;
        u = u_new;
      }
    }
    for (std::size_t i = 0; i < n; ++i) rates[i] = i < 2 ? -0.5 : -std::pow(10, 5 * part(random));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < n; ++k) {
          problem.a[i * n + j] += vectors[i * n + k] * rates[k] * vectors[j * n + k];
          if (k < 2)
            problem.a[i * n + j] += (k == 0 ? frequency : -frequency) * vectors[i * n + k] * vectors[j * n + (1 - k)];
        }
  }
  X exact(const X& x, double t) const {
    X y(n, 0), result(n, 0);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i) y[k] += vectors[i * n + k] * x[i];
    const double c = std::cos(frequency * t), s = std::sin(frequency * t), first = y[0], second = y[1];
    y[0] = c * first + s * second;
    y[1] = c * second - s * first;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i) result[i] += vectors[i * n + k] * y[k] * std::exp(rates[k] * t);
    return result;
  }
};

template <class M>
void expect_exponentials() {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const RandomLinear random(seed);
    const X x = start_of(random.problem);
    const double tolerance = 1e-6;
    const auto solution = solve(random.problem, x, {0.0, 1.0}, M{}, {.rtol = tolerance, .atol = tolerance});
    ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
    const X exact = random.exact(x, 1);
    for (std::size_t i = 0; i < exact.size(); ++i)
      EXPECT_NEAR(solution.final_state()[i], exact[i], 50 * tolerance) << M::name << ", seed " << seed;
  }
}

TEST(WithSolver, SolvesRandomStiffSystemsByGmres) {
  expect_exponentials<Krylov<Rodas5P>>();
  expect_exponentials<Krylov<Radau>>();
}

/// The heat equation on a line with three diagonals as the pattern of its Jacobian, whose values are differences.
struct Line {
  struct Calls {
    int factored = 0, solved = 0;
  };
  std::size_t n;
  std::shared_ptr<Calls> calls = std::make_shared<Calls>();
  SparsePattern pattern{};
  double conductivity = 1;

  explicit Line(std::size_t nodes) : n(nodes) {
    std::vector<MatrixPlace> places;
    for (std::uint32_t i = 0; i + 1 < n; ++i) places.insert(places.end(), {{i, i + 1}, {i + 1, i}});
    pattern = SparsePattern(n, places);
  }
  void operator()(double t, const X& u, X& dudt) const {
    const double stiffness = conductivity * std::pow(static_cast<double>(n + 1), 2);
    for (std::size_t i = 0; i < n; ++i)
      dudt[i] =
          stiffness * ((i > 0 ? u[i - 1] : 0) - 2 * u[i] + (i + 1 < n ? u[i + 1] : 0)) + std::cos(t) - u[i] * u[i];
  }
  const SparsePattern& jacobian_pattern() const { return pattern; }
  X start() const {
    X u(n);
    for (std::size_t i = 0; i < n; ++i)
      u[i] = std::sin(std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(n + 1));
    return u;
  }
};

/// L. H. Thomas' elimination, for real matrices, or for complex ones too.
template <bool complex_too>
class Thomas {
 public:
  explicit Thomas(const Line& line) : calls_(line.calls) {}

  template <class Number>
    requires(complex_too || std::is_same_v<Number, double>)
  Status factor(const ShiftedMatrix<X, Number>& a) {
    ++calls_->factored;
    auto& [upper, inverse] = kept<Number>();
    upper.assign(a.size(), Number{});
    inverse.assign(a.size(), Number{});
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Number pivot = a(i, i) - (i > 0 ? Number(a(i, i - 1) * upper[i - 1]) : Number{});
      if (pivot == Number{}) return {Ending::cannot_continue, "a pivot is zero"};
      inverse[i] = reciprocal(pivot);
      if (i + 1 < a.size()) upper[i] = a(i, i + 1) * inverse[i];
    }
    return {};
  }
  template <class Number>
    requires(complex_too || std::is_same_v<Number, double>)
  Status solve(const ShiftedMatrix<X, Number>& a, std::span<Number> b) {
    ++calls_->solved;
    auto& [upper, inverse] = kept<Number>();
    for (std::size_t i = 0; i < b.size(); ++i)
      b[i] = (b[i] - (i > 0 ? Number(a(i, i - 1) * b[i - 1]) : Number{})) * inverse[i];
    for (std::size_t i = b.size() - 1; i-- > 0;) b[i] -= upper[i] * b[i + 1];
    return {};
  }

 private:
  template <class Number>
  struct Kept {
    std::vector<Number> upper, inverse;
  };
  template <class Number>
  Kept<Number>& kept() {
    if constexpr (std::is_same_v<Number, double>) {
      return real_;
    } else {
      return complex_;
    }
  }

  std::shared_ptr<Line::Calls> calls_;
  Kept<double> real_;
  Kept<ComplexNumber<double>> complex_;
};

template <class M, class Solver>
void expect_the_solver_at_work() {
  Line line(50);
  const Options<X> options{.rtol = 1e-6, .atol = 1e-8};
  const auto direct = solve(line, line.start(), {0.0, 0.2}, M{}, options);
  const auto own = solve(std::ref(line), line.start(), {0.0, 0.2}, WithSolver<M, Solver>{}, options);
  ASSERT_TRUE(own.outcome) << describe(own.outcome);
  // Both meet the same tolerance, by steps that differ by what the iteration leaves.
  for (std::size_t i = 0; i < line.n; ++i)
    EXPECT_NEAR(own.final_state()[i], direct.final_state()[i], 2e-6) << M::name << ", component " << i;
  EXPECT_NEAR(static_cast<double>(own.statistics.steps), static_cast<double>(direct.statistics.steps),
              0.1 * static_cast<double>(direct.statistics.steps) + 1);
  EXPECT_EQ(static_cast<std::size_t>(line.calls->factored), own.statistics.factorizations) << M::name;
  EXPECT_GE(static_cast<std::size_t>(line.calls->solved), own.statistics.linear_solves) << M::name;
}

TEST(WithSolver, UsesTheSolverOfTheUser) {
  expect_the_solver_at_work<Rodas5P, Thomas<false>>();
  expect_the_solver_at_work<Bdf, Thomas<false>>();
  expect_the_solver_at_work<Radau5, Thomas<false>>();  // whose complex systems are solved by real ones
  expect_the_solver_at_work<Radau5, Thomas<true>>();
}

/// The action of the Jacobian and a preconditioner that is exact but for the square of u.
struct PreconditionedLine : Line {
  using Line::Line;
  int products = 0, set_up = 0;
  double shift = 0;
  X kept{}, slopes{};

  void jacobian_action(double, const X& u, const X& v, X& product) {
    ++products;
    const double stiffness = std::pow(static_cast<double>(n + 1), 2);
    for (std::size_t i = 0; i < n; ++i)
      product[i] = stiffness * ((i > 0 ? v[i - 1] : 0) - 2 * v[i] + (i + 1 < n ? v[i + 1] : 0)) - 2 * u[i] * v[i];
  }
  void set_up_preconditioner(double, const X&, double c) {
    ++set_up;
    shift = c;
  }
  void precondition(X& r) {
    const double stiffness = std::pow(static_cast<double>(n + 1), 2), diagonal = shift + 2 * stiffness;
    slopes.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double pivot = diagonal - (i > 0 ? stiffness * slopes[i - 1] : 0);
      slopes[i] = stiffness / pivot;
      r[i] = (r[i] + (i > 0 ? stiffness * r[i - 1] : 0)) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 0;) r[i] += slopes[i] * r[i + 1];
  }
};

template <class M>
void expect_few_products(double most) {
  PreconditionedLine line(400);
  const Options<X> options{.rtol = 1e-6, .atol = 1e-8};
  const auto direct = solve(Line(400), line.start(), {0.0, 0.2}, M{}, options);
  const auto krylov = solve(std::ref(line), line.start(), {0.0, 0.2}, Krylov<M>{}, options);
  ASSERT_TRUE(krylov.outcome) << describe(krylov.outcome);
  for (std::size_t i = 0; i < line.n; ++i)
    EXPECT_NEAR(krylov.final_state()[i], direct.final_state()[i], 2e-6) << M::name << ", component " << i;
  EXPECT_GT(line.set_up, 0);
  EXPECT_LE(line.set_up, static_cast<int>(krylov.statistics.factorizations)) << M::name;
  EXPECT_LT(line.products, most * static_cast<double>(krylov.statistics.linear_solves)) << M::name;
}

TEST(WithSolver, NeedsFewProductsWithAGoodPreconditioner) {
  expect_few_products<Rodas5P>(5);
  expect_few_products<Radau5>(12);  // half of its systems are complex
}

/// What a solver does that fails: at every factorization, or at some calls.
struct Script {
  bool singular = false;
  int failing_from = 0, failing_to = 0, calls = 0;
};
struct ScriptedLine : Line {
  using Line::Line;
  std::shared_ptr<Script> script = std::make_shared<Script>();
};
class FailingThomas {
 public:
  explicit FailingThomas(const ScriptedLine& line) : script_(line.script), thomas_(line) {}
  Status factor(const ShiftedMatrix<X>& a) {
    if (script_->singular) return {Ending::cannot_continue, "the grid has no levels"};
    return thomas_.factor(a);
  }
  Status solve(const ShiftedMatrix<X>& a, std::span<double> b) {
    const int call = script_->calls++;
    if (call >= script_->failing_from && call < script_->failing_to)
      return {Ending::nonlinear_solve_failed, "the cycles do not converge"};
    return thomas_.solve(a, b);
  }

 private:
  std::shared_ptr<Script> script_;
  Thomas<false> thomas_;
};

template <class M>
void expect_failures_to_be_reported() {
  ScriptedLine line(20);
  const auto run = [&](const Script& script, double step) {
    *line.script = script;
    return solve(line, line.start(), {0.0, 0.1}, WithSolver<M, FailingThomas>{},
                 {.rtol = 1e-6, .atol = 1e-6, .step = step});
  };
  for (const double step : {0.0, 0.01}) {
    const auto singular = run({.singular = true}, step);
    EXPECT_EQ(singular.outcome.ending, Ending::nonlinear_solve_failed) << M::name;
    EXPECT_EQ(singular.outcome.hint, "the grid has no levels") << M::name;
    const auto diverges = run({.failing_from = 3, .failing_to = 1000000}, step);
    EXPECT_EQ(diverges.outcome.ending, Ending::nonlinear_solve_failed) << M::name;
    EXPECT_EQ(diverges.outcome.hint, "the cycles do not converge") << M::name;
  }
  const auto good = run({}, 0), recovered = run({.failing_from = 3, .failing_to = 5}, 0);
  ASSERT_TRUE(recovered.outcome) << describe(recovered.outcome);
  for (std::size_t i = 0; i < line.n; ++i) EXPECT_NEAR(recovered.final_state()[i], good.final_state()[i], 1e-5);
}

TEST(WithSolver, ReportsWhatTheSolverSays) {
  expect_failures_to_be_reported<Rodas5P>();
  expect_failures_to_be_reported<Radau5>();
  expect_failures_to_be_reported<TrBdf2>();
}

/// x_i' = w x_(i+1), around a circle: of such a matrix GMRES knows nothing before it has gone around.
struct Circle {
  void operator()(double, const X& x, X& dxdt) const {
    for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = 1e3 * x[(i + 1) % x.size()];
  }
  void jacobian_action(double t, const X&, const X& v, X& product) const { operator()(t, v, product); }
};

TEST(WithSolver, DoesNotTakeAnIterationForSolvedThatDoesNotConverge) {
  X x(700, 0);
  x[0] = 1;
  const auto solution = solve(Circle{}, x, {0.0, 1.0}, Krylov<Rodas5P>{}, {.rtol = 1e-6, .atol = 1e-6, .step = 0.5});
  EXPECT_EQ(solution.outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_NE(solution.outcome.hint.find("GMRES does not converge within 500 products"), std::string::npos);
}

TEST(WithSolver, NamesWhatIsNotFinite) {
  const auto f = [](double t, const X& x, X& dxdt) {
    for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = -x[i] + std::sqrt(1 - t);
  };
  const auto solution = solve(f, X(3, 1.0), {0.0, 2.0}, Krylov<Rodas5P>{}, {.rtol = 1e-6, .atol = 1e-6});
  EXPECT_EQ(solution.outcome.ending, Ending::not_finite) << describe(solution.outcome);
}

TEST(WithSolver, ACopyGoesOnToTheSameBitsWithoutTheOriginal) {
  using Run = Integrator<Problem, X, Krylov<Radau>>;
  const Problem problem = heat_on_a_line(15);
  auto original = std::make_unique<Run>(problem, start_of(problem), Interval<double>{0.0, 0.5}, Krylov<Radau>{},
                                        Options<X>{.rtol = 1e-6, .atol = 1e-8});
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(original->advance());
  Run copy = *original;
  while (original->advance()) {
  }
  const X expected = original->x();
  original.reset();
  while (copy.advance()) {
  }
  ASSERT_TRUE(copy.outcome()) << describe(copy.outcome());
  EXPECT_EQ(copy.x(), expected);
}

TEST(WithSolver, RefusesAMethodThatTakesNone) {
  const auto solution = solve(Circle{}, X(30, 1), {0.0, 1e-3}, WithSolver<BdfKrylov, KrylovSolver<>>{}, {});
  EXPECT_EQ(solution.outcome.hint, "the method takes no linear solver");
}

TEST(WithSolver, ServesOtherScalars) {
  using Long = std::vector<long double>;
  const auto f = [](long double, const Long& x, Long& dxdt) {
    for (std::size_t i = 0; i < x.size(); ++i) dxdt[i] = -1000 * (x[i] - x[(i + 1) % x.size()]) - x[i];
  };
  const auto solution =
      solve(f, Long(5, 1.0L), {0.0L, 1.0L}, Krylov<Radau5, long double>{}, {.rtol = 1e-12L, .atol = 1e-12L});
  ASSERT_TRUE(solution.outcome);
  for (const long double x : solution.final_state()) EXPECT_NEAR(static_cast<double>(x), std::exp(-1.0), 30e-12);
}

}  // namespace
}  // namespace continuo::with_solver_test
