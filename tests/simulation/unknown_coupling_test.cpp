// The unknowns on which an expression depends, and the equations that determine them.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/unknown_coupling.hpp>

namespace continuo::model::unknown_coupling_test {
namespace {

using testing::ElementsAre;

std::shared_ptr<const ModelProgram> program_of(const std::string& text) {
  Loaded loaded = load(Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return compile(std::move(*loaded.model));
}

/// The names of the unknowns of the first event's guard; "too many".
std::vector<std::string> names(const std::string& text) {
  const auto program = program_of(text);
  const Model& model = program->model;
  const UnknownCoupling coupling(*program, model.modes[0].derivatives);
  const auto block = coupling.block(model.events[0].guard);
  if (!block) return {"too many"};
  EXPECT_EQ(block->components.size(), block->residuals.size());
  std::vector<std::string> found;
  for (const std::uint32_t i : block->components) found.push_back(model.states[i].column);
  return found;
}

const std::string three = R"(
unknown a = 0; unknown b = 0; unknown c = 0
x' = a
x(0) = 1
0 = b - 2*a
0 = a - x
0 = c - a*b
run 0..1
)";

TEST(UnknownCoupling, TakesWhatTheGuardNeedsAndNothingElse) {
  EXPECT_THAT(names(three + "when x > 2 { mark \"m\" }\n"), ElementsAre());
  EXPECT_THAT(names(three + "when a > 2 { mark \"m\" }\n"), ElementsAre("a"));
  EXPECT_THAT(names(three + "when b > 2 { mark \"m\" }\n"), ElementsAre("a", "b"));
  EXPECT_THAT(names(three + "when c > 2 { mark \"m\" }\n"), ElementsAre("a", "b", "c"));
}

TEST(UnknownCoupling, TakesBothOfAPairThatDeterminesEachOther) {
  EXPECT_THAT(names("unknown a = 0; unknown b = 0\nx' = 1\nx(0) = 0\n0 = a + b - x\n0 = a - b - x^2\nrun 0..1\n"
                    "when a > 2 { mark \"m\" }\n"),
              ElementsAre("a", "b"));
}

/// u[1] = x, u[2] = u[1] + x, ...
std::string chain(std::size_t length) {
  std::string text = "unknown u1 = 0\nx' = 1\nx(0) = 0\n0 = u1 - x\n";
  for (std::size_t i = 2; i <= length; ++i) {
    const std::string here = "u" + std::to_string(i), before = "u" + std::to_string(i - 1);
    text += "unknown " + here + " = 0\n0 = " + here + " - " + before + " - x\n";
  }
  return text + "run 0..1\nwhen u" + std::to_string(length) + " > 2 { mark \"m\" }\n";
}

TEST(UnknownCoupling, NamesNoMoreThanCanBeEnclosed) {
  EXPECT_EQ(names(chain(most_enclosed_unknowns)).size(), most_enclosed_unknowns);
  EXPECT_THAT(names(chain(most_enclosed_unknowns + 1)), ElementsAre("too many"));
}

}  // namespace
}  // namespace continuo::model::unknown_coupling_test
