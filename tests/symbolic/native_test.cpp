// Machine code of tapes against the tapes themselves, bit by bit: random expressions, families, tables, many threads.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "native_referee.hpp"
#include "random_expressions.hpp"
#include <continuo/symbolic/native/c_source.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model::native_test {
namespace {

namespace fs = std::filesystem;
using namespace random_expressions_test;

void expect_the_same_bits(Graph& g, const std::vector<NodeId>& outputs, std::mt19937& random, NativeCompiler& native) {
  const auto tape = std::make_shared<const Tape>(g, outputs, layout, tables());
  const auto compiled = std::make_shared<const Tape>(g, outputs, layout, tables());
  native.watch(compiled);
  ASSERT_TRUE(compiled->is_native()) << native.report().trouble;
  for (int i = 0; i < 20; ++i) {
    const std::vector<double> values = random_values(random);
    const std::vector<double> expected = evaluated(*tape, values), actual = evaluated(*compiled, values);
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_EQ(bits(actual[k]), bits(expected[k])) << "output " << k << ": " << actual[k] << ", not " << expected[k];
  }
}

TEST(Native, RandomExpressionsGiveTheBitsOfTheTape) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Graph g;
    expect_the_same_bits(g, random_expressions(g, random, 10 + seed * 30), random, *native);
  }
  EXPECT_EQ(native->report().trouble, "");
}

TEST(Native, FamiliesInLoopsGiveTheBitsOfTheTape) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::size_t loops = 0;
  for (unsigned seed = 100; seed < 112; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Graph g;
    const std::vector<NodeId> outputs = random_family(g, random);
    loops += Tape(g, outputs, layout, tables()).size().batches;
    expect_the_same_bits(g, outputs, random, *native);
  }
  EXPECT_GT(loops, 12u);
}

// gcc 12 fuses them, two at once, where the processor can (vfmaddsub).
TEST(Native, ProductsBesideSumsAndDifferencesGiveTheBitsOfTheTape) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(17);
  Graph g;
  const auto product = [&g](std::uint32_t i) { return g.multiply(g.variable(1 + i), g.variable(3 + i)); };
  expect_the_same_bits(g, {g.subtract(product(0), g.variable(5)), g.add(product(1), g.variable(6))}, random, *native);
}

/// A sum of many products of one state: 60 operations, an output.
std::shared_ptr<const Tape> some_tape(double salt) {
  Graph g;
  NodeId sum = g.constant(salt);
  for (std::uint32_t i = 1; i <= states; ++i)
    sum = g.add(g.multiply(g.variable(i), sum), g.apply(Op::sine, g.variable(i)));
  const NodeId outputs[] = {sum};
  return std::make_shared<const Tape>(g, outputs, layout);
}

TEST(Native, TakesOverWhileTheTapeRuns) {
  const TestFolder folder;
  std::mt19937 random(5);
  std::vector<double> values(variables, 0.25);
  const auto tape = some_tape(1);
  const double expected = evaluated(*tape, values).front();
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::automatic, folder.path / "cache"});
  native->watch(tape);
  EXPECT_FALSE(tape->count_use(1'000) && tape->is_native());
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!tape->is_native() && std::chrono::steady_clock::now() < give_up) {
    ASSERT_EQ(evaluated(*tape, values).front(), expected);
    tape->count_use(1'000'000);
  }
  ASSERT_TRUE(tape->is_native()) << native->report().trouble;
  EXPECT_EQ(evaluated(*tape, values).front(), expected);
  EXPECT_EQ(native->report().compiled, 1u);
  // The next process finds it, after less work.
  const auto again = some_tape(1);
  const auto other = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::automatic, folder.path / "cache"});
  other->watch(again);
  EXPECT_FALSE(again->count_use(1'000'001));
  EXPECT_TRUE(again->is_native());
  EXPECT_EQ(other->report().loaded, 1u);
}

TEST(Native, IsGivenUpAtOnceWhereTheRunEnds) {
  const TestFolder folder;
  const fs::path slow = folder.path / "slow";
  std::ofstream(slow) << "#!/bin/sh\nexec sleep 60\n";
  fs::permissions(slow, fs::perms::owner_all);
  setenv("CC", slow.c_str(), 1);
  const auto begin = std::chrono::steady_clock::now();
  {
    const auto tape = some_tape(2);
    const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::automatic, folder.path / "cache"});
    native->watch(tape);
    for (int i = 0; i < 40; ++i) tape->count_use(1'000'000);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  unsetenv("CC");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST(Native, WithoutACompilerTheTapeGoesOnAndSaysWhy) {
  const TestFolder folder;
  setenv("CC", "/nowhere/cc", 1);
  const auto tape = some_tape(3);
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  native->watch(tape);
  unsetenv("CC");
  EXPECT_FALSE(tape->is_native());
  EXPECT_THAT(native->report().trouble, ::testing::HasSubstr("/nowhere/cc"));
  EXPECT_TRUE(std::isfinite(evaluated(*tape, std::vector<double>(variables, 0.25)).front()));
}

TEST(Native, FilesThatWereAlteredAreNotLoaded) {
  const TestFolder folder;
  const NativeCache cache(folder.path / "cache");
  ASSERT_TRUE(cache.status()) << cache.status().message;
  const fs::path made = folder.path / "made.so";
  std::ofstream(made) << "machine code";
  cache.keep("text", made);
  const auto kept = cache.find("text");
  ASSERT_TRUE(kept);
  EXPECT_FALSE(cache.find("another text"));
  std::ofstream(*kept, std::ios::app) << "!";
  EXPECT_FALSE(cache.find("text"));
  fs::resize_file(*kept, 4);
  EXPECT_FALSE(cache.find("text"));
  cache.keep("text", made);
  EXPECT_TRUE(cache.find("text"));
  fs::permissions(*kept, fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(cache.find("text"));
}

TEST(Native, TheCacheStaysSmall) {
  const TestFolder folder;
  const NativeCache cache(folder.path / "cache");
  const fs::path made = folder.path / "made.so";
  std::ofstream(made) << std::string(15'000'000, 'x');
  for (const char* text : {"a", "b", "c", "d"}) cache.keep(text, made);
  EXPECT_TRUE(cache.find("a"));  // used now: "b" is the oldest
  cache.keep("e", made);
  EXPECT_TRUE(cache.find("a") && cache.find("c") && cache.find("d") && cache.find("e"));
  EXPECT_FALSE(cache.find("b"));
}

TEST(Native, AFolderThatOthersCanWriteIsNoCache) {
  const TestFolder folder;
  const fs::path open = folder.path / "open";
  fs::create_directory(open);
  fs::permissions(open, fs::perms::all);
  EXPECT_FALSE(NativeCache(open).status());
  EXPECT_THAT(NativeCache(open).status().message, ::testing::HasSubstr("others can write it"));
  EXPECT_FALSE(NativeCache(open / "below").status());
  EXPECT_FALSE(NativeCache("").status());
  // A link leads to where it leads.
  fs::create_directory_symlink(open, folder.path / "link");
  EXPECT_FALSE(NativeCache(folder.path / "link").status());
  EXPECT_TRUE(NativeCache(folder.path / "own").status());
  struct stat info = {};
  ASSERT_EQ(stat((folder.path / "own").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0700u);
}

}  // namespace
}  // namespace continuo::model::native_test
