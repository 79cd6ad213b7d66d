// The two programs of the command, which have one command line.
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string studies_program = "'" CONTINUO_COMMAND "-studies' ";

TEST(Programs, AStudyIsTheSameThroughTheCommandAsByItsOwnProgram) {
  const Shell shell;
  shell.write("spring.sim", spring);
  const std::string family = "run " + gallery("bratu") + " --family lambda=0.1..4 --json";
  for (const auto& [words, exit] : {std::pair<std::string, int>("steady spring.sim", 0),
                                    {"linearize spring.sim --json", 0},
                                    {"steady --help", 0},
                                    {"help steady", 0},
                                    {"help --markdown steady", 0},
                                    {"--version steady", 0},
                                    {"--help steady", 0},
                                    {family, 0},
                                    {"steady", 1},
                                    {"steady nothing.sim", 1},
                                    {"steady spring.sim --plto a.svg", 1},
                                    {"steady spring.sim --of ''", 1},
                                    {"nothing steady spring.sim", 1},
                                    {"help steady nothing", 1},
                                    {"run spring.sim --family k=1..2", 1},
                                    {"run spring.sim --family", 1},
                                    {"linearize spring.sim --at x=1,nothing=2", 1}}) {
    const Result through = shell.run(words), direct = shell.call(studies_program + words);
    EXPECT_EQ(through.exit, exit) << words;
    EXPECT_EQ(direct.exit, exit) << words;
    EXPECT_EQ(through.out, direct.out) << words;
    EXPECT_EQ(through.err, direct.err) << words;
    EXPECT_THAT(exit == 0 ? through.out : through.err, testing::Not(IsEmpty())) << words;
  }
}

TEST(Programs, MessagesAndHelpKnowTheVerbsOfBoth) {
  const Shell shell;
  EXPECT_THAT(shell.run("--help").out, AllOf(HasSubstr("Finds periodic orbits"), HasSubstr("Lists the integration")));
  EXPECT_THAT(shell.run("orbt x.sim").err, HasSubstr("did you mean `orbit`?"));
  EXPECT_THAT(shell.run("help orbt").err, HasSubstr("did you mean `orbit`?"));
  EXPECT_THAT(shell.run("x.sim orbit y.sim").err, HasSubstr("`orbit` has no use for `x.sim`"));
  EXPECT_THAT(shell.run("orbit x.sim --plto a.svg").err, HasSubstr("did you mean `--plot`?"));
  EXPECT_THAT(shell.run("orbit nothing.sim").err, StartsWith("continuo: cannot read nothing.sim"));
}

TEST(Programs, WithoutTheOneOfStudiesASentenceSaysWhatBuildsIt) {
  const Shell shell;
  shell.write("spring.sim", spring);
  ASSERT_EQ(shell.call("mkdir bin && cp '" CONTINUO_COMMAND "' bin").exit, 0);
  for (const char* words : {"steady spring.sim", "help steady", "run spring.sim --family k=1..2"}) {
    const Result result = shell.call(std::string("bin/continuo ") + words);
    EXPECT_EQ(result.exit, 1) << words;
    EXPECT_THAT(result.out, IsEmpty()) << words;
    EXPECT_THAT(lines_of(result.err), SizeIs(1)) << words;
    EXPECT_THAT(result.err, AllOf(StartsWith("continuo: "), HasSubstr("/bin/continuo-studies"),
                                  HasSubstr("/continuo/continuo-studies;"), HasSubstr("--target continuo-studies"),
                                  HasSubstr("./continuo.sh")))
        << words;
  }
  EXPECT_EQ(shell.call("bin/continuo run spring.sim").exit, 0);
  EXPECT_EQ(shell.call("bin/continuo --help").out, shell.run("--help").out);
  EXPECT_EQ(shell.call("bin/continuo help --markdown").out, shell.run("help --markdown").out);
}

TEST(Programs, AVariableNamesAnotherOneForTheStudies) {
  const Shell shell;
  shell.write("spring.sim", spring);
  EXPECT_EQ(shell.run("steady 'two words' --json", "CONTINUO_STUDIES=/bin/echo").out, "steady two words --json\n");
  EXPECT_EQ(shell.run("info spring.sim", "CONTINUO_STUDIES=/bin/echo").out, shell.run("info spring.sim").out);
  const Result none = shell.run("steady spring.sim", "CONTINUO_STUDIES=/no/such/program");
  EXPECT_EQ(none.exit, 1);
  EXPECT_THAT(none.err, AllOf(HasSubstr("cannot start"), HasSubstr("/no/such/program: No such file")));
}

TEST(Programs, TheOneOfStudiesRefusesOtherVerbs) {
  const Shell shell;
  shell.write("spring.sim", spring);
  for (const char* words : {"run spring.sim", "help", "help run", "info spring.sim", "--help", "nothing", ""}) {
    const Result result = shell.call(studies_program + words);
    EXPECT_EQ(result.exit, 1) << words;
    EXPECT_THAT(result.out, IsEmpty()) << words;
    EXPECT_THAT(result.err, HasSubstr("call continuo")) << words;
  }
}

}  // namespace
}  // namespace continuo::app
