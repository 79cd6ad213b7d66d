// Runs of systems whose functions are pointers: against closed forms, by every method, with every kind of Jacobian.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/foreign/foreign_run.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::foreign_run_test {
namespace {

using X = std::vector<double>;

struct Counted {
  double rate = 1;
  int calls = 0, jacobians = 0, least_calls = 0;
  std::atomic<bool> stop{false};
};

void oscillator(double, const double* x, double* dxdt, void* user) {
  auto& counted = *static_cast<Counted*>(user);
  ++counted.calls;
  dxdt[0] = counted.rate * x[1];
  dxdt[1] = -counted.rate * x[0];
}
void oscillator_jacobian(double, const double*, double* rows, void* user) {
  auto& counted = *static_cast<Counted*>(user);
  ++counted.jacobians;
  rows[1] = counted.rate;
  rows[2] = -counted.rate;
}
// Fails after some calls.
void failing(double t, const double* x, double* dxdt, void* user) {
  auto& counted = *static_cast<Counted*>(user);
  oscillator(t, x, dxdt, user);
  if (counted.calls < counted.least_calls) return;
  counted.stop = true;
  dxdt[0] = dxdt[1] = std::nan("");
}
// x_i' = x_{i-1} - 2 x_i + x_{i+1}, of thirty components.
constexpr std::size_t cells = 30;
void diffusion(double, const double* x, double* dxdt, void*) {
  for (std::size_t i = 0; i < cells; ++i) dxdt[i] = (i > 0 ? x[i - 1] : 0) - 2 * x[i] + (i + 1 < cells ? x[i + 1] : 0);
}
void diffusion_jacobian(double, const double*, double* rows, void*) {
  for (std::size_t i = 0; i < cells; ++i) {
    if (i > 0) rows[i * cells + i - 1] = 1;
    rows[i * cells + i] = -2;
    if (i + 1 < cells) rows[i * cells + i + 1] = 1;
  }
}

[[nodiscard]] std::shared_ptr<ForeignFunctions> oscillator_functions(Counted& counted, bool gives_jacobian) {
  auto functions = std::make_shared<ForeignFunctions>();
  functions->size = 2;
  functions->derivative = {oscillator, &counted};
  if (gives_jacobian) functions->jacobian = {oscillator_jacobian, &counted};
  functions->pairs = {{0, 1}};
  functions->ignores_velocity = true;
  return functions;
}

TEST(ForeignRun, EveryMethodFollowsTheOscillator) {
  for (const MethodInfo& method : method_catalogue()) {
    if (method.needs_series) continue;
    SCOPED_TRACE(std::string(method.name));
    for (const bool gives_jacobian : {false, true}) {
      Counted counted;
      Options<X> options{.rtol = 1e-5, .atol = 1e-5};
      if (method.error_order == 0) options.step = 1e-3;
      const auto run =
          begin_foreign_run(oscillator_functions(counted, gives_jacobian), {1, 0}, {0, 2}, method.name, options);
      ASSERT_NE(run, nullptr);
      ForeignRecord record({.dense = true});
      record.begin(0, run->x());
      while (run->advance(record)) {
      }
      ASSERT_EQ(run->outcome().ending, Ending::reached_end) << describe(run->outcome());
      EXPECT_NEAR(run->x()[0], std::cos(2.0), 5e-3);
      EXPECT_NEAR(run->x()[1], -std::sin(2.0), 5e-3);
      EXPECT_EQ(record.t.size(), record.dense.pieces.size() + 1);
      EXPECT_TRUE(gives_jacobian || counted.jacobians == 0);
      X x(2);
      const std::size_t middle = record.dense.pieces.size() / 2;
      record.dense.evaluate(middle, record.t[middle + 1], x.data());
      EXPECT_EQ(x[0], record.x[2 * (middle + 1)]);
    }
  }
}

TEST(ForeignRun, AFunctionThatFailsEndsTheRunWithWhatWasComputed) {
  for (const char* method : {"dormand_prince5", "dop853", "bdf", "radau5", "rodas5p", "tsitouras5_bdf"}) {
    SCOPED_TRACE(method);
    Counted counted{.least_calls = 60};
    auto functions = oscillator_functions(counted, false);
    functions->derivative = {failing, &counted};
    const auto run = begin_foreign_run(functions, {1, 0}, {0, 100}, method, {.rtol = 1e-6, .interrupt = &counted.stop});
    ForeignRecord record({});
    record.begin(0, run->x());
    while (run->advance(record)) {
    }
    EXPECT_NE(run->outcome().ending, Ending::reached_end);
    EXPECT_GT(record.t.size(), 1u);
    for (const double number : record.x) EXPECT_TRUE(std::isfinite(number));
    EXPECT_LT(counted.calls, 300);
  }
}

TEST(ForeignRun, PatternAndValuesAgreeWithTheWholeMatrix) {
  std::vector<MatrixPlace> places;
  for (std::uint32_t i = 0; i < cells; ++i)
    for (std::uint32_t j = i == 0 ? 0 : i - 1; j < std::min<std::uint32_t>(i + 2, cells); ++j) places.push_back({i, j});
  X x0(cells);
  for (std::size_t i = 0; i < cells; ++i) x0[i] = std::sin(0.3 * static_cast<double>(i));
  X reference;
  for (const bool knows_pattern : {false, true})
    for (const bool gives_jacobian : {false, true}) {
      auto functions = std::make_shared<ForeignFunctions>();
      functions->size = cells;
      functions->derivative = {diffusion, nullptr};
      if (gives_jacobian) functions->jacobian = {diffusion_jacobian, nullptr};
      if (knows_pattern) functions->pattern = SparsePattern(cells, places);
      const auto run = begin_foreign_run(functions, x0, {0, 5}, "bdf", {.rtol = 1e-8, .atol = 1e-10});
      while (run->advance()) {
      }
      ASSERT_EQ(run->outcome().ending, Ending::reached_end);
      if (reference.empty()) reference = run->x();
      for (std::size_t i = 0; i < cells; ++i) EXPECT_NEAR(run->x()[i], reference[i], 1e-7);
    }
}

TEST(ForeignRun, AMassThatIsAFullMatrix) {
  Counted counted;
  auto functions = oscillator_functions(counted, true);
  functions->mass_rows = {2, 1, 1, 2};
  EXPECT_EQ(begin_foreign_run(functions, {1, 0}, {0, 1}, "dop853", {}), nullptr);
  EXPECT_FALSE(solves_with_matrix("dop853"));
  // Of x' = M^-1 (x1, -x0) the exponential is taken by its series.
  const double a[2][2] = {{1.0 / 3, 2.0 / 3}, {-2.0 / 3, -1.0 / 3}};
  X term = {1, 0}, exact = term;
  for (int k = 1; k < 30; ++k) {
    term = {(a[0][0] * term[0] + a[0][1] * term[1]) / k, (a[1][0] * term[0] + a[1][1] * term[1]) / k};
    exact[0] += term[0], exact[1] += term[1];
  }
  for (const char* method : {"radau5", "radau", "bdf", "rodas5p"}) {
    ASSERT_TRUE(solves_with_matrix(method));
    const auto run = begin_foreign_run(functions, {1, 0}, {0, 1}, method, {.rtol = 1e-9, .atol = 1e-11});
    while (run->advance()) {
    }
    EXPECT_NEAR(run->x()[0], exact[0], 1e-6) << method;
    EXPECT_NEAR(run->x()[1], exact[1], 1e-6) << method;
  }
}

TEST(ForeignRun, AStateOfAnotherSizeIsRefused) {
  Counted counted;
  const auto run = begin_foreign_run(oscillator_functions(counted, false), {1, 0, 0}, {0, 1}, "dop853", {});
  EXPECT_FALSE(run->advance());
  EXPECT_EQ(run->outcome().ending, Ending::invalid_input);
  EXPECT_EQ(begin_foreign_run(oscillator_functions(counted, false), {1, 0}, {0, 1}, "no such", {}), nullptr);
}

}  // namespace
}  // namespace continuo::foreign_run_test
