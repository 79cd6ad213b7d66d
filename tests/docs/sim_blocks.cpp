// Every ```sim block of the documentation is a model that `continuo verify` accepts; one marked `error=E201` is a model
// that it refuses with this code. `file=NAME` names the file, so that later blocks can read it.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/docs/blocks.hpp>
#include <tests/docs/process.hpp>

namespace continuo::docs {
namespace {

class SimBlock : public testing::TestWithParam<Block> {};

TEST_P(SimBlock, KeepsItsPromise) {
  const Block& block = GetParam();
  const auto folder = fresh_folder(test_name(block));
  for (const Block& other : blocks_of(block.file)) {
    if (other.line < block.line && other.tags.contains("file")) {
      std::ofstream(folder / other.tags.at("file")) << other.text;
    }
  }
  std::ofstream(folder / "example.sim") << block.text;

  const Finished finished = run_in(folder, "continuo verify example.sim");

  SCOPED_TRACE(block.place() + "\n" + block.text);
  if (const auto expected = block.tags.find("error"); expected != block.tags.end()) {
    EXPECT_NE(finished.exit_code, 0);
    EXPECT_THAT(finished.printed, testing::HasSubstr("[" + expected->second + "]"));
  } else {
    EXPECT_EQ(finished.exit_code, 0) << finished.printed;
  }
}

INSTANTIATE_TEST_SUITE_P(Documentation, SimBlock, testing::ValuesIn(blocks_in_documentation("sim")),
                         [](const auto& information) { return test_name(information.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SimBlock);

}  // namespace
}  // namespace continuo::docs
