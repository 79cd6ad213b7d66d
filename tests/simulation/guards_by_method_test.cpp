// Each method of the catalogue locates the crossings of a guard that is nonlinear in the state, and of one that depends
// on an unknown. The solution is a rotation of period 2 pi, so the times are closed forms.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::model {
namespace {

/// x = cos t. The guard x^2 - 1/4 falls at pi/3 and 4 pi/3 and rises at 2 pi/3.
constexpr const char* rotation = R"(
x'' = -x
x(0) = 1; x'(0) = 0
when x^2 falls through 1/4 { mark "falls" }
when x^2 rises through 1/4 { mark "rises" }
run 0..5 [s]
)";

class GuardsByMethod : public testing::TestWithParam<std::string> {};

TEST_P(GuardsByMethod, AreCrossedWhereTheSolutionCrossesThem) {
  const MethodInfo& method = *find_method(GetParam());
  const Loaded loaded = load(Source("rotation.sim", rotation));
  ASSERT_TRUE(loaded) << loaded.text();
  Experiment experiment;
  experiment.method = GetParam();
  const bool controlled = method.error_order > 0;
  if (controlled) {
    const double tolerance = method.order < 3 ? 1e-5 : 1e-9;
    experiment.rtol = tolerance;
    experiment.atol = {tolerance};
  } else {
    experiment.step = method.order < 2 ? 1e-5 : 1e-4;
  }
  experiment.keep_rows = false;
  const Simulated simulated = simulate(*loaded.model, experiment);
  ASSERT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  ASSERT_EQ(simulated.run->outcome.ending, Ending::reached_end) << simulated.run->outcome.hint;
  std::vector<std::string> marks;
  std::vector<double> times;
  for (const RecordedEvent& event : simulated.run->events) {
    marks.push_back(event.mark);
    times.push_back(event.t);
  }
  constexpr double third = std::numbers::pi / 3;
  EXPECT_EQ(marks, (std::vector<std::string>{"falls", "rises", "falls"}));
  ASSERT_EQ(times.size(), 3U);
  // The speed at which x^2 crosses is sin(2 pi/3) = 0.87. An error of 30 tolerances a period, or of 5 s of local errors
  // of order h^2, moves the crossing by less than this.
  const double allowed = controlled ? 300 * *experiment.rtol : method.order < 2 ? 5e-5 : 1e-6;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(times[i], third * (i == 0 ? 1 : i == 1 ? 2 : 4), allowed) << method.name << ' ' << i;
}

std::vector<std::string> names_of_methods() {
  std::vector<std::string> names;
  for (const MethodInfo& method : method_catalogue()) names.emplace_back(method.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, GuardsByMethod, testing::ValuesIn(names_of_methods()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace continuo::model
