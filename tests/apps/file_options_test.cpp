// No command line loses a file: every option of every verb, set to every kind of name of a file that is read, and every
// two outputs set to one file.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* driven =
    "param k = 1 in 0..5\ntable force from \"force.csv\"\ninput u = 0 from \"wind.csv\"\n"
    "x' = interp(force, t) + u - k*x\nx(0) = 1\nrun 0..1 output 0.5\n";
constexpr const char* bouncing_ball =
    "world { gravity (0, -10)\n wall floor (0, 1) at 0\n body ball at (0, 5.5) }\nrun 0..1 output 0.5\n";

/// The files that the commands below read.
const std::map<std::string, std::string> inputs{{"own.sim", driven},
                                                {"force.csv", "t,u\n0,1\n1,2\n"},
                                                {"wind.csv", "t,u\n0,0\n1,1\n"},
                                                {"data.csv", "t,x\n0.5,0.6\n1,0.4\n"}};

/// A command line of each verb that is in order.
const std::map<std::string, std::string> commands{{"run", "run own.sim"},
                                                  {"replay", "replay own.run"},
                                                  {"resume", "resume own.run"},
                                                  {"view", "view own.sim --no-open --export page.html"},
                                                  {"check", "check own.sim"},
                                                  {"info", "info own.sim"},
                                                  {"verify", "verify own.sim"},
                                                  {"compare", "compare own.sim --methods rk4 --step 0.5"},
                                                  {"converge", "converge own.sim --methods rk4 --most-steps 64"},
                                                  {"stability", "stability rk4 --model own.sim"},
                                                  {"steady", "steady own.sim --along k=1..2"},
                                                  {"linearize", "linearize own.sim --start"},
                                                  {"phase", "phase own.sim"},
                                                  {"orbit", "orbit own.sim --along k=1..2"},
                                                  {"report", "report own.sim -o page.html"},
                                                  {"explore", "explore own.sim --starts 1 --duration 1"},
                                                  {"sense", "sense own.sim --param k"},
                                                  {"sweep", "sweep own.sim --vary 'k from 1 to 2 count 2'"},
                                                  {"fit", "fit own.sim data.csv --param k"},
                                                  {"methods", "methods"},
                                                  {"export", "export own.sim --c"},
                                                  {"explain", "explain"},
                                                  {"new", "new another"},
                                                  {"help", "help"}};

/// An option of a verb, as its page in the reference has it.
struct Option {
  std::string name, value;  // "--guess", "FILE"

  bool is_file() const { return value == "FILE" || value == "PATH"; }
  bool is_written() const {
    constexpr std::array written{"-o", "--events", "--manifest", "--record", "--export", "--plot"};
    return is_file() && std::ranges::find(written, name) != written.end();
  }
};

std::vector<Option> options_of(const Shell& shell, const std::string& verb) {
  const std::string page = shell.run("help " + verb + " --markdown").out;
  const std::regex row(R"(\n\| `(-[^`]*)`[^|]*\| (?:`([^`]*)`)? *\|)");
  std::vector<Option> options;
  for (auto found = std::sregex_iterator(page.begin(), page.end(), row); found != std::sregex_iterator(); ++found)
    options.push_back({(*found)[1], (*found)[2]});
  return options;
}

std::vector<std::string> verbs(const Shell& shell) {
  const std::string page = shell.run("help --markdown").out;
  const std::regex row(R"(\[continuo (\w+)\])");
  std::vector<std::string> names;
  for (auto found = std::sregex_iterator(page.begin(), page.end(), row); found != std::sregex_iterator(); ++found)
    names.push_back((*found)[1]);
  return names;
}

/// The same command with an option set to a file, in place of what it may have had.
std::string with(const std::string& command, const std::string& option, const std::string& file) {
  const std::regex same(" (?:" + option + ") [^ ]+");
  return std::regex_replace(command, same, "") + " " + option + " " + file;
}

class Inputs {
 public:
  Inputs() {
    for (const auto& [name, text] : inputs) shell.write(name, text);
    shell.write("bounce.sim", bouncing_ball);
    EXPECT_EQ(shell.run("run own.sim --record own.run").exit, 0);
    recording_ = shell.read("own.run");
  }
  void expect_unchanged(const std::string& words) const {
    for (const auto& [name, text] : inputs) ASSERT_EQ(shell.read(name), text) << words;
    ASSERT_EQ(shell.read("own.run"), recording_) << words;
  }
  const Shell shell;

 private:
  std::string recording_;
};

/// What the command reads.
std::vector<std::string> files_read_by(const std::string& command) {
  if (command.find("own.run") != command.npos) return {"own.run"};
  if (command.find("own.sim") == command.npos) return {};
  std::vector<std::string> files{"own.sim", "force.csv", "wind.csv"};
  if (command.find("data.csv") != command.npos) files.emplace_back("data.csv");
  return files;
}

TEST(FileOptions, AreOfEveryVerb) {
  const Shell shell;
  for (const std::string& verb : verbs(shell))
    EXPECT_TRUE(commands.contains(verb)) << verb << " is tested nowhere here";
}

TEST(FileOptions, NoneIsWrittenOverAFileThatIsRead) {
  const Inputs in;
  const Shell& shell = in.shell;
  shell.call("mkdir -p inside");
  std::size_t refused = 0;
  for (const auto& [verb, command] : commands) {
    for (const Option& option : options_of(shell, verb)) {
      if (!option.is_written()) continue;
      for (const std::string& read : files_read_by(command)) {
        // The same name, another spelling, links of either kind; the ending of the link is one that the option takes.
        for (const std::string ending : {"", ".csv", ".svg", ".html", ".mp4"}) {
          shell.call("rm -f soft* hard*; ln -s " + read + " soft" + ending + "; ln " + read + " hard" + ending);
          for (const std::string& file : {read, "./inside/.././" + read, "soft" + ending, "hard" + ending}) {
            if (!ending.empty() && file.starts_with('s') == file.starts_with('h')) continue;  // links alone
            const std::string words = with(command, option.name, file);
            const Result result = shell.run(words, "timeout 20");
            ASSERT_EQ(result.exit, 1) << words << result.err;
            ASSERT_THAT(result.err, HasSubstr("read as input")) << words;
            in.expect_unchanged(words);
            ++refused;
          }
        }
      }
    }
  }
  EXPECT_GT(refused, 500u);
}

TEST(FileOptions, NoTwoAreWrittenToOneFile) {
  const Inputs in;
  const Shell& shell = in.shell;
  shell.call("ln -s same.csv link.csv");
  std::size_t refused = 0;
  for (const auto& [verb, command] : commands) {
    const std::vector<Option> options = options_of(shell, verb);
    for (auto one = options.begin(); one != options.end(); ++one) {
      for (auto other = options.begin(); one->is_written() && other != one; ++other) {
        if (!other->is_written()) continue;
        for (const auto& [first, second] : {std::pair("same.csv", "same.csv"),
                                            {"same.csv", "./same.csv"},
                                            {"same.csv", "link.csv"},
                                            {"-", "/dev/stdout"}}) {
          const std::string words = with(with(command, one->name, first), other->name, second);
          const Result result = shell.run(words, "timeout 20");
          ASSERT_EQ(result.exit, 1) << words;
          ASSERT_THAT(result.err, AnyOf(HasSubstr("twice"), HasSubstr("mixed"), HasSubstr("cannot plot"),
                                        HasSubstr("--record takes the name"), HasSubstr("ending of its name")))
              << words;
          ASSERT_FALSE(shell.has("same.csv")) << words;
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(refused, 40u);
}

// Whatever is given to whichever option: an option that writes a file and is not declared would write over these.
TEST(FileOptions, NoOptionAtAllLosesAFile) {
  const Inputs in;
  const Shell& shell = in.shell;
  for (const auto& [verb, command] : commands) {
    for (const Option& option : options_of(shell, verb)) {
      if (option.value.empty()) continue;
      for (const char* file : {"own.sim", "own.run", "force.csv"}) {
        if (!option.is_file() && file != std::string("own.sim")) continue;
        // Who does not read the recording may write a new one in its place.
        if (file == std::string("own.run") && command.find("own.run") == std::string::npos) continue;
        const std::string words = with(command, option.name, file);
        (void)shell.run(words, "timeout 5");
        in.expect_unchanged(words);
      }
    }
  }
}

TEST(FileOptions, AreDeclaredWhereTheyAreAdded) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(CONTINUO_SOURCE_DIR) / "apps")) {
    if (entry.path().extension() != ".cpp" || entry.path().filename() == "file_options.cpp") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(text, Not(AnyOf(HasSubstr("type_name(\"FILE\")"), HasSubstr("type_name(\"PATH\")"))))
        << entry.path() << ": an option that names a file is declared by reads_file, writes_file or their like";
  }
}

TEST(FileOptions, KeepWhatIsRedirectedFromTheShell) {
  const Inputs in;
  const Shell& shell = in.shell;
  const std::string run = "'" CONTINUO_COMMAND "' run own.sim ";
  EXPECT_THAT(shell.call(run + "-o both.csv > both.csv").err, HasSubstr("standard output goes there"));
  EXPECT_EQ(shell.call(run + "-o log.csv 2> log.csv; cat log.csv").exit, 0);
  EXPECT_THAT(shell.read("log.csv"), HasSubstr("standard error goes there"));
  EXPECT_THAT(shell.call(run + "-o - --json").err, HasSubstr("would be mixed"));
  EXPECT_EQ(shell.call(run + "-o /dev/null --events /dev/null").exit, 0);
  shell.write("log", "before\n");
  EXPECT_EQ(shell.call(run + "-o /dev/stdout >> log").exit, 0);
  EXPECT_THAT(shell.read("log"), HasSubstr("before\n"));
  EXPECT_THAT(shell.read("log"), HasSubstr("t,x\n0,1\n"));
}

TEST(FileOptions, ATableBesideATableIsHeldAgainstInputsToo) {
  const Inputs in;
  const Shell& shell = in.shell;
  shell.call("cp own.sim out.csv.manifest.json");
  const Result result = shell.run("run out.csv.manifest.json -o out.csv");
  EXPECT_EQ(result.exit, 1);
  EXPECT_THAT(result.err, HasSubstr("cannot write out.csv.manifest.json (the file beside -o)"));
  EXPECT_EQ(shell.read("out.csv.manifest.json"), driven);
}

TEST(FileOptions, OfAStudyInAReportAreRefused) {
  const Inputs in;
  for (const std::string study : {"run -o own.sim", "steady --along k=1..2 -opage.html", "orbit --out=own.sim"}) {
    const Result result = in.shell.run("report own.sim -o page.html --with '" + study + "'");
    EXPECT_EQ(result.exit, 1);
    EXPECT_THAT(result.err, HasSubstr("a study of a report writes no files"));
    in.expect_unchanged(study);
  }
  EXPECT_FALSE(in.shell.has("page.html"));
}

TEST(FileOptions, TheEndingOfATableSaysItsFormatOrIsRefused) {
  const Inputs in;
  const Shell& shell = in.shell;
  for (const std::string name : {"out", "out.txt", "out.csv2", "out.hdf5"}) {
    const Result result = shell.run("run own.sim -o " + name);
    EXPECT_EQ(result.exit, 1) << name;
    EXPECT_THAT(result.err, HasSubstr(".csv, .tsv, .json, .nc (netCDF) or .mat (MATLAB)")) << name;
  }
  EXPECT_THAT(shell.run("run own.sim -o out.parquet").err, HasSubstr("to_parquet"));
  EXPECT_THAT(shell.run("steady own.sim --along k=1..2 -o out.nc").err, HasSubstr("-o writes .csv"));
  EXPECT_THAT(shell.call("mkfifo pipe.nc; '" CONTINUO_COMMAND "' run own.sim -o pipe.nc").err,
              HasSubstr("only .csv and .tsv can go into a pipe"));
  EXPECT_THAT(shell.call("mkdir out.csv; '" CONTINUO_COMMAND "' run own.sim -o out.csv").err,
              HasSubstr("it is a folder"));
}

TEST(FileOptions, AFullDiskUnderJsonIsTold) {
  const Inputs in;
  for (const auto& [verb, command] : commands) {
    const std::vector<Option> options = options_of(in.shell, verb);
    if (std::ranges::find(options, "--json", &Option::name) == options.end()) continue;
    const std::string words = command + " --json";
    const Result result = in.shell.call("timeout 60 '" CONTINUO_COMMAND "' " + words + " > /dev/full");
    EXPECT_NE(result.exit, 0) << words;
    EXPECT_THAT(result.err, Not(IsEmpty())) << words;
  }
}

}  // namespace
}  // namespace continuo::app
