// Files that appear when they are whole: what is there after a failure, an end in between, and through links.
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "example.hpp"
#include <continuo/results/output_file.hpp>

namespace continuo::results {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

std::vector<std::string> files_in(const Folder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

TEST(OutputFile, HasItsNameWhenItIsWhole) {
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "a.csv", "old"));
  OutputFile out(folder / "a.csv", Unfinished::kept);
  out.write("new");
  out.flush();
  EXPECT_EQ(content(folder / "a.csv"), "old");
  EXPECT_EQ(out.present_name(), folder / "a.unfinished.csv");
  ASSERT_TRUE(out.close());
  EXPECT_EQ(content(folder / "a.csv"), "new");
  EXPECT_THAT(files_in(folder), ElementsAre("a.csv"));
}

TEST(OutputFile, ThatIsNotClosedLeavesTheOlderOne) {
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "a.csv", "old"));
  {
    OutputFile(folder / "a.csv").write("new");
  }
  EXPECT_THAT(files_in(folder), ElementsAre("a.csv"));
  for (int time = 0; time < 2; ++time) OutputFile(folder / "a.csv", Unfinished::kept).write("new");
  EXPECT_EQ(content(folder / "a.csv"), "old");
  EXPECT_THAT(files_in(folder), ElementsAre("a.csv", "a.unfinished.csv", "a.unfinished2.csv"));
  EXPECT_EQ(content(folder / "a.unfinished2.csv"), "new");
  OutputFile(folder / "b.csv", Unfinished::kept);  // of which there is nothing
  EXPECT_EQ(files_in(folder).size(), 3u);
}

TEST(OutputFile, KeepsPermissionsAndLinks) {
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "real.csv", "old"));
  ASSERT_EQ(chmod((folder / "real.csv").c_str(), 0640), 0);
  fs::create_symlink("real.csv", folder / "link.csv");
  fs::create_symlink("not_yet.csv", folder / "dangling.csv");
  ASSERT_TRUE(write_file(folder / "link.csv", "new"));
  ASSERT_TRUE(write_file(folder / "dangling.csv", "there"));
  EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
  EXPECT_EQ(content(folder / "real.csv"), "new");
  EXPECT_EQ(content(folder / "not_yet.csv"), "there");
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "real.csv").permissions()), 0640u);
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "not_yet.csv").permissions()), 0666u & ~mask);
}

TEST(OutputFile, WritesPipesAndOpenFilesDirectly) {
  const Folder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    const std::string read = content(folder / "pipe");
    _exit(read == "through a pipe" ? 0 : 1);
  }
  ASSERT_TRUE(write_file(folder / "pipe", "through a pipe"));
  int status = 0;
  ASSERT_EQ(waitpid(reader, &status, 0), reader);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  // Opened anew, a file that somebody appends to would be emptied.
  const int log = open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  ASSERT_EQ(write(log, "before ", 7), 7);
  ASSERT_TRUE(write_file("/dev/fd/" + std::to_string(log), "after"));
  close(log);
  EXPECT_EQ(content(folder / "log"), "before after");
}

TEST(OutputFile, AReadOnlyFileStaysAsItIs) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "a.csv", "old"));
  ASSERT_EQ(chmod((folder / "a.csv").c_str(), 0444), 0);
  EXPECT_EQ(write_file(folder / "a.csv", "new").message, "cannot write " + folder / "a.csv" + ": Permission denied");
  EXPECT_EQ(content(folder / "a.csv"), "old");
}

TEST(FilePlace, IsOneForAllNamesOfAFile) {
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "a", "text"));
  fs::create_directory(folder / "inside");
  fs::create_symlink("a", folder / "soft");
  fs::create_symlink("soft", folder / "softer");
  fs::create_symlink(folder.path, folder / "inside/up");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_symlink("b", folder / "to_nothing");
  const auto places = [&](const std::string& name) { return place_of(folder / name); };
  for (const char* name : {"soft", "softer", "hard", "./a", "inside/../a", "inside/up/a"})
    EXPECT_EQ(places(name), places("a")) << name;
  EXPECT_EQ(places("to_nothing"), places("b"));
  EXPECT_EQ(places("inside/up/b"), places("b"));
  EXPECT_FALSE(places("a") == places("b"));
  EXPECT_FALSE(place_of("/dev/null") == place_of("/dev/null"));
  fs::create_symlink("endless", folder / "endless");
  EXPECT_FALSE(places("endless") == places("a"));
}

}  // namespace
}  // namespace continuo::results
