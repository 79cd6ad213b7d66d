// continuo-mpi: the same bytes for any number of processes, also after one of them was killed; bad calls end and say
// why.
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app::mpi_sweep_test {
namespace {

#ifdef CONTINUO_MPI
constexpr const char* program = CONTINUO_MPI;
#else
constexpr const char* program = nullptr;
#endif

using ::testing::HasSubstr;

constexpr const char* swing_by_ranks =
    "param k = 4\nparam c = 0.1\nx'' = -k*x - c*x'\nx(0) = 1; x'(0) = 0\nrun 0..5\n"
    "sweep { k uniform(1, 9); c normal(0.5, 0.1); runs 1024 sobol seed 7; keep x at end, x at 0..5 by 1 }\n";

class MpiSweep : public testing::Test {
 protected:
  void SetUp() override {
    if (program == nullptr) GTEST_SKIP() << "built without MPI";
    if (shell_.call("command -v mpirun").exit != 0) GTEST_SKIP() << "mpirun is not installed";
    shell_.write("swing.sim", swing_by_ranks);
  }
  /// By so many processes, each of which leaves its number in pid.RANK.
  Result run(int processes, const std::string& arguments, const std::string& after = "") const {
    shell_.write("rank.sh", fmt::format("echo $$ > pid.$OMPI_COMM_WORLD_RANK; exec '{}' \"$@\"", program));
    return shell_.call(
        fmt::format("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 100 mpirun "
                    "--oversubscribe -n {} sh rank.sh {}{}",
                    processes, arguments, after));
  }

  Shell shell_;
};

TEST_F(MpiSweep, HasTheSameBytesForAnyNumberOfProcesses) {
  ASSERT_EQ(shell_.run("sweep swing.sim -o one.nc --threads 1").exit, 0);
  for (const int processes : {2, 4}) {
    const Result made = run(processes, "sweep swing.sim -o m.nc");
    ASSERT_EQ(made.exit, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr("1024 runs, sobol"));
    EXPECT_TRUE(shell_.read("m.nc") == shell_.read("one.nc")) << processes;
    EXPECT_FALSE(shell_.has("m.nc.sweep"));
    ASSERT_EQ(shell_.call("rm m.nc").exit, 0);
  }
}

TEST_F(MpiSweep, GoesOnAfterOneProcessWasKilled) {
  const std::string many = " --runs '6000 sobol seed 7'";
  ASSERT_EQ(shell_.run("sweep swing.sim -o one.nc" + many).exit, 0);
  const std::string killing =
      " & run=$!; for i in $(seq 600); do [ $(ls k.nc.sweep 2> .none | wc -l) -gt 20 ] && break; sleep 0.05; done; "
      "kill -9 $(cat pid.2); wait $run";
  EXPECT_NE(run(4, "sweep swing.sim -o k.nc" + many, killing).exit, 0);
  ASSERT_TRUE(shell_.has("k.nc.sweep"));
  EXPECT_FALSE(shell_.has("k.nc"));
  const Result resumed = run(3, "sweep swing.sim -o k.nc --resume" + many);
  ASSERT_EQ(resumed.exit, 0) << resumed.err;
  EXPECT_TRUE(shell_.read("k.nc") == shell_.read("one.nc"));
}

TEST_F(MpiSweep, BadCallsEndAndSayWhyOnce) {
  const auto says = [&](const std::string& arguments, const std::string& text) {
    const Result result = run(2, arguments);
    EXPECT_EQ(result.exit, 1) << arguments;
    const std::size_t first = result.err.find(text);
    EXPECT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find(text, first + 1), std::string::npos) << result.err;
  };
  says("sweep nowhere.sim -o x.nc", "cannot read nowhere.sim");
  says("sweep swing.sim -o /nowhere/x.nc", "cannot write /nowhere/x.nc");
  // Other words on one of the processes.
  shell_.write(
      "other.sh",
      fmt::format("exec '{}' sweep swing.sim -o x.nc --runs \"64 sobol seed $OMPI_COMM_WORLD_RANK\"", program));
  const Result other = shell_.call(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 100 mpirun --oversubscribe -n 2 sh other.sh");
  EXPECT_EQ(other.exit, 1);
  EXPECT_THAT(other.err, HasSubstr("do not have the same sweep"));
}

}  // namespace
}  // namespace continuo::app::mpi_sweep_test
