// Models that tempt a simulator into silent errors: each NAME.sim of tests/simulation/faults runs and its checks hold.
// See the README there.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <tests/language/model_folder.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

const std::filesystem::path folder = CONTINUO_SOURCE_DIR "/tests/simulation/faults";

class Faults : public testing::TestWithParam<std::string> {};

TEST_P(Faults, AreMended) {
  const std::filesystem::path path = folder / (GetParam() + ".sim");
  const std::string text = contents(path);
  EXPECT_TRUE(text.starts_with("# Rule: ")) << "the first comment names the rule";
  const Loaded loaded = load(path);
  ASSERT_TRUE(loaded) << loaded.text();
  const Simulated simulated = simulate(*loaded.model);
  ASSERT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  const auto& run = *simulated.run;
  if (run.outcome.ending == Ending::events_accumulate && text.find("May end in E310") != std::string::npos) {
    // The check of such a model is a lower bound for all times, and so holds up to the end of the run.
    for (const CheckResult& check : run.checks) EXPECT_GT(check.value, check.expected) << check.text;
    return;
  }
  EXPECT_TRUE(succeeded(run.outcome.ending)) << describe(run.outcome);
  for (const CheckResult& check : run.checks)
    EXPECT_TRUE(check.passed) << check.text << ": " << check.value << " " << check.message;
}

INSTANTIATE_TEST_SUITE_P(Each, Faults, testing::ValuesIn(models_in(folder)), name_of_test);

TEST(FaultsTogether, AreThirtyAndMore) {
  EXPECT_GE(models_in(folder).size(), 30U);
}

}  // namespace
}  // namespace continuo::model
