// The modules that the command loads at its start, and those that it loads on demand.
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Not;
using ::testing::SizeIs;

namespace fs = std::filesystem;

constexpr const char* fading = "param a = 1 in 0..5\nx' = -a*x\nx(0) = 1\nrun 0..2 output 1\n";
constexpr const char* fading_rows = "t,x\n0,1\n1,0.1353352832366127\n2,0.01831563888873418\n";  // a = 2

/// The libraries that the loader maps for a program or a library. Some parts of the C library are empty today, and only
/// the sanitizers still link them: these are left out.
std::vector<std::string> libraries_of(const fs::path& file) {
  std::vector<std::string> libraries = lines_of(Shell().call("ldd '" + file.string() + "'").out);
  const std::regex empty_ones(R"(^\s*lib(pthread|rt|dl|resolv)\.so)");
  std::erase_if(libraries, [&](const std::string& line) { return std::regex_search(line, empty_ones); });
  return libraries;
}

// Each costs the loader a tenth of a millisecond and more, every time that the command is called.
TEST(Modules, StartingTheCommandLoadsFewLibraries) {
  for (const char* program : {CONTINUO_COMMAND, CONTINUO_COMMAND "-studies"}) {
    const std::vector<std::string> libraries = libraries_of(program);
    EXPECT_THAT(libraries, SizeIs(AllOf(Ge(8u), Le(17u)))) << ::testing::PrintToString(libraries);
    for (const char* heavy : {"netcdf", "ceres", "glog", "blas", "lapack", "hdf5", "curl", "cholmod", "xml"})
      EXPECT_THAT(libraries, Each(Not(HasSubstr(heavy)))) << program;
  }
  const fs::path folder = fs::path(CONTINUO_COMMAND).parent_path();
  EXPECT_THAT(libraries_of(folder / "continuo_least_squares.so"), Contains(HasSubstr("libglog")));
}

TEST(Modules, AreFoundThroughALinkToTheCommand) {
  Shell shell;
  shell.write("decay.sim", fading);
  shell.write("measured.csv", fading_rows);
  const Result fit = shell.call("ln -s '" CONTINUO_COMMAND
                                "' link && env -u LD_LIBRARY_PATH ./link fit decay.sim measured.csv --param a");
  EXPECT_EQ(fit.exit, 0) << fit.err;
  EXPECT_THAT(fit.out, ContainsRegex("a +(2|2\\.0000|1\\.9999)"));
}

TEST(Modules, OneThatIsMissingIsNamedBeforeTheRunWithThePlacesWhereItWasLookedFor) {
  Shell shell;
  shell.write("decay.sim", fading);
  shell.write("measured.csv", fading_rows);
  ASSERT_EQ(shell.call("mkdir bin && cp '" CONTINUO_COMMAND "' '" CONTINUO_COMMAND "-studies' bin").exit, 0);
  const Result result = shell.call("bin/continuo fit decay.sim measured.csv --param a");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.out, IsEmpty());
  const std::string file = "continuo_least_squares.so";
  EXPECT_THAT(result.err, AllOf(HasSubstr("missing"), HasSubstr("/bin/" + file), HasSubstr("/continuo/" + file)));
  const Result other = shell.call("bin/continuo run decay.sim");  // needs none of them
  EXPECT_EQ(other.exit, 0) << other.err;
}

TEST(Modules, OneThatCannotBeOpenedIsNamedWithTheReason) {
  Shell shell;
  shell.write("decay.sim", fading);
  shell.write("measured.csv", fading_rows);
  ASSERT_EQ(shell.call("mkdir bin && cp '" CONTINUO_COMMAND "' '" CONTINUO_COMMAND "-studies' bin").exit, 0);
  shell.write("bin/continuo_least_squares.so", "no library");
  const Result result = shell.call("bin/continuo fit decay.sim measured.csv --param a");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cannot load"), HasSubstr("bin/continuo_least_squares.so: file too short")));
}

}  // namespace
}  // namespace continuo::app
