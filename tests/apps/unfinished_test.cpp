// Runs that are killed, interrupted or run out of disk leave what was computed, and nothing else is lost. Rows need no
// memory.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr const char* swinging = "param n = 40000\nx'' = -x\nx(0) = 1; x'(0) = 0\nrun 0..n*0.01 output 0.01\n";

/// The process of a run, with its messages thrown away.
class Process {
 public:
  explicit Process(const std::vector<std::string>& words) {
    std::vector<std::string> all{CONTINUO_COMMAND};
    all.insert(all.end(), words.begin(), words.end());
    process_ = fork();
    if (process_ != 0) return;
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
    std::vector<char*> pointers;
    for (std::string& word : all) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(CONTINUO_COMMAND, pointers.data());
    _exit(127);
  }
  void send(int signal) const { kill(process_, signal); }
  /// Its exit code, or that of a shell for a signal; and how much memory it had.
  int wait() {
    int status = 0;
    rusage used{};
    wait4(process_, &status, 0, &used);
    kilobytes_ = used.ru_maxrss;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  long kilobytes() const { return kilobytes_; }

 private:
  pid_t process_;
  long kilobytes_ = 0;
};

/// A folder with the model, in which the processes are.
class Place {
 public:
  Place() {
    shell.write("swing.sim", swinging);
    folder = lines_of(shell.call("pwd").out).at(0);
  }
  std::string path(const std::string& name) const { return folder + "/" + name; }
  const Shell shell;
  std::string folder;
};

using Rows = std::vector<std::vector<double>>;

Rows rows_of_text(const std::string& text) {
  Rows rows;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with('#') || line.starts_with('t')) continue;
    rows.emplace_back();
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

/// By the library of the format's inventors.
Rows rows_of_netcdf(const std::string& path) {
  int file = -1, variables = 0;
  EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file), NC_NOERR) << path;
  EXPECT_EQ(nc_inq_nvars(file, &variables), NC_NOERR);
  int record = -1;
  std::size_t count = 0;
  EXPECT_EQ(nc_inq_unlimdim(file, &record), NC_NOERR);
  EXPECT_EQ(nc_inq_dimlen(file, record, &count), NC_NOERR);
  Rows rows(count, std::vector<double>(static_cast<std::size_t>(variables)));
  std::vector<double> column(count);
  for (int variable = 0; variable < variables; ++variable) {
    EXPECT_EQ(nc_get_var_double(file, variable, column.data()), NC_NOERR);
    for (std::size_t i = 0; i < count; ++i) rows[i][static_cast<std::size_t>(variable)] = column[i];
  }
  nc_close(file);
  return rows;
}

/// A cut last line is no row.
std::string whole_lines(const std::string& text) {
  return text.substr(0, text.rfind('\n') + 1);
}

void expect_prefix(const Rows& rows, const Rows& whole) {
  ASSERT_LE(rows.size(), whole.size());
  ASSERT_TRUE(std::equal(rows.begin(), rows.end(), whole.begin()));
}

class Killed : public testing::TestWithParam<const char*> {};

TEST_P(Killed, AtAnyTimeLeavesABeginningOfTheTable) {
  const Place place;
  const std::string ending = GetParam(), name = "out." + ending;
  ASSERT_EQ(place.shell.run("run swing.sim -o whole.csv").exit, 0);
  const Rows whole = rows_of_text(place.shell.read("whole.csv"));
  ASSERT_EQ(whole.size(), 40001u);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(place.shell.run("run swing.sim -o whole_too." + ending).exit, 0);
  std::chrono::duration<double> duration = std::chrono::steady_clock::now() - begin;
  const std::string whole_text = place.shell.read("whole_too." + ending);
  std::mt19937 random(2026);
  std::uniform_real_distribution<double> part(0, 1.1);
  std::size_t partial = 0;
  for (int time = 0; time < 50; ++time) {
    for (const auto& entry : fs::directory_iterator(place.folder))
      if (entry.path().filename().string().starts_with("out")) fs::remove(entry);
    place.shell.write(name, "an older one");
    Process process({"run", place.path("swing.sim"), "-o", place.path(name)});
    std::this_thread::sleep_for(duration * part(random));
    process.send(SIGKILL);
    // Beside other work the next run may take a multiple of the time of the last one.
    const bool has_ended = process.wait() == 0;
    duration *= has_ended ? 0.9 : 1.05;
    const std::string now = place.shell.read(name);
    ASSERT_TRUE(now == "an older one" || now == whole_text) << now.size();
    const std::string csv = "out.unfinished.csv", netcdf = "out.unfinished.nc";
    if (place.shell.has(csv)) {
      ASSERT_TRUE(place.shell.read("whole.csv").starts_with(place.shell.read(csv)));
      expect_prefix(rows_of_text(whole_lines(place.shell.read(csv))), whole);
      ++partial;
    } else if (place.shell.has(netcdf)) {
      expect_prefix(rows_of_netcdf(place.path(netcdf)), whole);
      ++partial;
    }
    for (const auto& entry : fs::directory_iterator(place.folder)) {
      const std::string other = entry.path().filename().string();
      if (!other.starts_with("out")) continue;
      // A table that is whole has the name of an unfinished one for the instant before it takes the other's place.
      if (other == "out.unfinished." + ending && other != csv && other != netcdf) {
        ASSERT_EQ(place.shell.read(other), whole_text);
        continue;
      }
      ASSERT_THAT(other, AnyOf(name, csv, netcdf, name + ".manifest.json", name + ".manifest.unfinished.json"));
    }
  }
  EXPECT_GT(partial, 5u);
}

INSTANTIATE_TEST_SUITE_P(Formats, Killed, testing::Values("csv", "nc", "json", "mat"));

TEST(KilledRecording, IsReplayedAndResumed) {
  for (const std::string model : {"swing.sim", "ball.sim"}) {
    const Place place;
    place.shell.write("ball.sim",
                      "world {\n  gravity (0, -10)\n  wall floor (0, 1) at 0\n  material restitution 1\n"
                      "  body ball at (0, 5.5)\n}\nrun 0..10000 output 1\n");
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(place.shell.run("run " + model + " --record whole.run -o whole.csv").exit, 0);
    std::chrono::duration<double> duration = std::chrono::steady_clock::now() - begin;
    const Rows whole = rows_of_text(place.shell.read("whole.csv"));
    std::mt19937 random(23);
    std::uniform_real_distribution<double> part(0.1, 1);
    int partial = 0;
    for (int time = 0; time < 30 && partial < 4; ++time) {
      for (const auto& entry : fs::directory_iterator(place.folder))
        if (entry.path().filename().string().starts_with("out")) fs::remove(entry);
      place.shell.write("out.run", "an older one");
      Process process({"run", place.path(model), "--record", place.path("out.run")});
      std::this_thread::sleep_for(duration * part(random));
      process.send(SIGKILL);
      // Beside other work the next run may take a multiple of the time of the last one, or a part of it.
      const bool has_ended = process.wait() == 0;
      duration *= has_ended ? 0.7 : 1.1;
      if (!place.shell.has("out.unfinished.run")) continue;
      ASSERT_EQ(place.shell.read("out.run"), "an older one");
      ++partial;
      EXPECT_THAT(place.shell.run("replay out.unfinished.run -o out.csv").exit, AnyOf(130, 0));  // 0: about to be named
      expect_prefix(rows_of_text(place.shell.read("out.csv")), whole);
      EXPECT_EQ(place.shell.run("resume out.unfinished.run -o out.csv").exit, 0);
      EXPECT_EQ(rows_of_text(place.shell.read("out.csv")), whole);
    }
    EXPECT_GT(partial, 0) << model;
  }
}

TEST(Interrupted, KeepsTheRowsUnderTheNameOfAnUnfinishedTable) {
  for (const std::string ending : {"csv", "tsv", "nc", "json", "mat"}) {
    const Place place;
    const std::string name = "out." + ending, unfinished = "out.unfinished." + ending;
    place.shell.write(name, "an older one");
    // Its rows take long, lest there be millions of them.
    place.shell.write("slow.sim",
                      "x'' = -x + 1e-9*sum(i in 1..3000: sin(i*x))\nx(0) = 1; x'(0) = 0\nrun 0..1e7 output 0.01\n");
    const Result result = place.shell.interrupt(
        "run slow.sim --max-steps 1000000000 -o " + name + " --events events.csv --manifest manifest.json",
        "out.unfinished.*", 2000);
    EXPECT_EQ(result.exit, 130) << result.err;
    EXPECT_THAT(result.err, HasSubstr("are in " + unfinished)) << ending;
    EXPECT_EQ(place.shell.read(name), "an older one");
    EXPECT_GT(place.shell.read(unfinished).size(), 1000u);
    EXPECT_TRUE(place.shell.has("events.unfinished.csv"));
    EXPECT_TRUE(place.shell.has("manifest.unfinished.json"));
    EXPECT_FALSE(place.shell.has("out.unfinished.nc") && ending != "nc");
    if (ending == "json") {
      EXPECT_TRUE(nlohmann::json::accept(place.shell.read(unfinished)));
    } else if (ending == "nc") {
      EXPECT_GT(rows_of_netcdf(place.path(unfinished)).size(), 10u);
    }
  }
}

// The shell's limit on file sizes stands for a full disk; its signal is ignored, since a full disk sends none.
TEST(FullDisk, EndsTheRunAndKeepsTheRowsBefore) {
  for (const std::string ending : {"csv", "nc", "json", "mat"}) {
    const Place place;
    const std::string name = "out." + ending;
    place.shell.write(name, "an older one");
    const Result result = place.shell.call("trap '' XFSZ; ulimit -f 600; timeout 60 '" CONTINUO_COMMAND
                                           "' run swing.sim --set n=1e8 --max-steps 1000000000 -o " +
                                           name);
    EXPECT_EQ(result.exit, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("cannot write out." + (ending == "csv" ? ending : std::string()))) << result.err;
    EXPECT_EQ(place.shell.read(name), "an older one");
    if (ending == "csv") {
      EXPECT_GT(rows_of_text(whole_lines(place.shell.read("out.unfinished.csv"))).size(), 100u);
    } else {
      EXPECT_GT(rows_of_netcdf(place.path("out.unfinished.nc")).size(), 100u);
    }
  }
}

// Those of a recording wait for its next snapshot, which comes when there are many.
TEST(Rows, NeedNoMemoryInARecording) {
  const Place place;
  const auto memory_of = [&](const std::string& rows) {
    Process process(
        {"run", place.path("swing.sim"), "--set", "n=" + rows, "--snapshots", "1", "--record", place.path("out.run")});
    EXPECT_EQ(process.wait(), 0);
    return process.kilobytes();
  };
  const long few = memory_of("400000"), many = memory_of("800000");  // kept, these would be 10 MB more
  EXPECT_LT(many - few, 4000) << few << ' ' << many;
  ASSERT_EQ(place.shell.run("run swing.sim --set n=800000 -o whole.csv").exit, 0);
  ASSERT_EQ(place.shell.run("replay out.run -o out.csv").exit, 0);
  const auto without_first_line = [&](const std::string& name) {
    const std::string text = place.shell.read(name);
    return text.substr(text.find('\n'));
  };
  EXPECT_TRUE(without_first_line("out.csv") == without_first_line("whole.csv"));
}

// Kept in memory, the three million numbers of this run would be 24 MB.
TEST(Rows, NeedNoMemory) {
  for (const std::string ending : {"csv", "nc", "json", "mat"}) {
    const Place place;
    const auto memory_of = [&](const std::string& rows) {
      Process process({"run", place.path("swing.sim"), "--set", "n=" + rows, "-o", place.path("out." + ending)});
      EXPECT_EQ(process.wait(), 0);
      return process.kilobytes();
    };
    const long few = memory_of("100000"), many = memory_of("1000000");
    EXPECT_LT(many - few, 8000) << ending << ": " << few << ' ' << many;
    EXPECT_LT(many, 100'000) << ending;
  }
}

}  // namespace
}  // namespace continuo::app
