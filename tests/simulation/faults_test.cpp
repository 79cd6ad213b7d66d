// Models in which a simulator goes wrong without a word: each NAME.sim of tests/simulation/faults runs and its checks
// hold. See the README there.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

const std::filesystem::path folder = CONTINUO_SOURCE_DIR "/tests/simulation/faults";

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> names() {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".sim") found.push_back(entry.path().stem().string());
  std::sort(found.begin(), found.end());
  return found;
}

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
    // The check of such a model is a lower bound for all times, which holds up to the end that the run has come to.
    for (const CheckResult& check : run.checks) EXPECT_GT(check.value, check.expected) << check.text;
    return;
  }
  EXPECT_TRUE(succeeded(run.outcome.ending)) << describe(run.outcome);
  for (const CheckResult& check : run.checks)
    EXPECT_TRUE(check.passed) << check.text << ": " << check.value << " " << check.message;
}

INSTANTIATE_TEST_SUITE_P(Each, Faults, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& model) { return model.param; });

TEST(FaultsTogether, AreThirtyAndMore) {
  EXPECT_GE(names().size(), 30U);
}

}  // namespace
}  // namespace continuo::model
