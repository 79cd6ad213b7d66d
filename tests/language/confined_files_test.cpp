// Files that a text from the network names: those of the model's folder are read, nothing else is, and nothing is
// quoted.
#include <array>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <continuo/language/check/declarations/folder_file.hpp>
#include <continuo/language/load_confined.hpp>

namespace continuo::model {
namespace {

namespace fs = std::filesystem;

/// A folder `model` with files, and beside it others that are nobody's business.
class Confined : public ::testing::Test {
 protected:
  void SetUp() override {
    root = fs::path(::testing::TempDir()) / ("continuo-confined-" + std::to_string(::getpid()));
    fs::remove_all(root);
    fs::create_directories(root / "model" / "data");
    fs::create_directories(root / "secret");
    write("model/good.csv", "0,1\n1,2\n");
    write("model/data/deep.csv", "0,1\n1,2\n");
    write("model/words.csv", "0,1\n1,classified\n");
    write("secret/key.csv", "0,1\n1,2\n");
    write("key.csv", "root:x:0:0\n");
    fs::create_symlink(root / "secret" / "key.csv", root / "model" / "link.csv");
    fs::create_directory_symlink(root / "secret", root / "model" / "away");
    fs::create_symlink("../key.csv", root / "model" / "up.csv");
    fs::create_symlink("/dev/zero", root / "model" / "endless.csv");
    ASSERT_EQ(::mkfifo((root / "model" / "pipe.csv").c_str(), 0600), 0);
  }
  void TearDown() override { fs::remove_all(root); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(root / name) << text; }
  enum class As { table, input, chain, mesh };
  static constexpr std::array every_use{As::table, As::input, As::chain, As::mesh};
  Loaded loaded(const std::string& name, As use = As::table) const {
    const std::string file = "\"" + name + "\"\n", world = "world { mode fast step 1/60\n ";
    const std::string text = use == As::table   ? "table f from " + file + "x' = interp(f, t)\nx(0) = 0\n"
                             : use == As::input ? "input f = 0 from " + file + "x' = f\nx(0) = 0\n"
                             : use == As::chain
                                 ? world + "body b at (9, 9)\n wall w chain from " + file + "}\n"
                                 : world + "dimension 3\n body b at (9, 9, 9)\n wall w mesh " + file + "}\n";
    return load_confined(Source((root / "model" / "m.sim").string(), text));
  }

  fs::path root;
};

TEST_F(Confined, ReadsWhatLiesInTheFolder) {
  for (const std::string name : {"good.csv", "data/deep.csv", "./good.csv", "data/./deep.csv", "data//deep.csv"}) {
    EXPECT_TRUE(loaded(name).model) << name << "\n" << loaded(name).text();
    EXPECT_TRUE(loaded(name, As::input).model) << name;
  }
}

TEST_F(Confined, ReadsGroundThatLiesInTheFolder) {
  write("model/data/points.csv", "x,y\n0,0\n1,2\n");
  write("model/hill.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string name : {"data/points.csv", "./data//points.csv"})
    EXPECT_TRUE(loaded(name, As::chain).model) << loaded(name, As::chain).text();
  EXPECT_TRUE(loaded("hill.obj", As::mesh).model) << loaded("hill.obj", As::mesh).text();
}

TEST_F(Confined, ReadsNothingElse) {
  const std::vector<std::string> names = {"../key.csv",
                                          "../secret/key.csv",
                                          "data/../good.csv",
                                          "data/../../key.csv",
                                          (root / "key.csv").string(),
                                          (root / "model" / "good.csv").string(),
                                          "/etc/passwd",
                                          "link.csv",
                                          "up.csv",
                                          "away/key.csv",
                                          "endless.csv",
                                          "pipe.csv",
                                          "data",
                                          ".",
                                          "",
                                          "absent.csv",
                                          "good.csv/x"};
  for (const std::string& name : names) {
    for (const As use : every_use) {
      const Loaded result = loaded(name, use);
      EXPECT_FALSE(result.model) << name;
      const std::string text = result.text();
      EXPECT_EQ(text.find("root:x"), std::string::npos) << text;
      EXPECT_EQ(text.find(root.string() + "/secret"), std::string::npos) << text;
    }
  }
}

TEST_F(Confined, QuotesNothing) {
  const std::string text = loaded("words.csv").text();
  EXPECT_EQ(text.find("classified"), std::string::npos) << text;
  EXPECT_NE(text.find("words.csv:2"), std::string::npos) << text;
  EXPECT_NE(text.find("E272"), std::string::npos) << text;
  write("model/words.obj", "v 0 0 0\nv 1 classified 0\n");
  write("model/points.csv", "x,y,z\n0,0,1\n1,classified,2\n");
  const std::string of_mesh = loaded("words.obj", As::mesh).text(), of_chain = loaded("points.csv", As::chain).text();
  EXPECT_EQ(of_mesh.find("classified"), std::string::npos) << of_mesh;
  EXPECT_NE(of_mesh.find("words.obj:2"), std::string::npos) << of_mesh;
  EXPECT_NE(of_mesh.find("E273"), std::string::npos) << of_mesh;
  EXPECT_EQ(of_chain.find("classified"), std::string::npos) << of_chain;
  EXPECT_NE(of_chain.find("E272"), std::string::npos) << of_chain;
}

/// The author of a file on this computer may read it anywhere, and is told what stands there.
TEST_F(Confined, LeavesOtherTextsAsTheyAre) {
  const std::string path = (root / "model" / "m.sim").string();
  EXPECT_TRUE(load(Source(path, "table f from \"../secret/key.csv\"\nx' = interp(f, t)\nx(0) = 0\n")).model);
  EXPECT_NE(load(Source(path, "table f from \"words.csv\"\nx' = interp(f, t)\nx(0) = 0\n")).text().find("classified"),
            std::string::npos);
}

// Names by chance, of parts that exist and parts that lead away. The referee asks the operating system where the name
// leads: only what lies in the folder, by a way without links, may be read.
TEST_F(Confined, ByAnyName) {
  std::mt19937 chance(5);
  const std::vector<std::string> parts = {"..",      ".",     "data", "good.csv", "deep.csv", "link.csv", "away",
                                          "key.csv", "m.sim", "",     "model",    "secret",   "up.csv",   "pipe.csv"};
  int read = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string name;
    const std::size_t count = 1 + chance() % 4;
    for (std::size_t k = 0; k < count; ++k) name += (k > 0 ? "/" : "") + parts[chance() % parts.size()];
    const auto text = detail::read_from_folder((root / "model").string(), name);
    if (!text) continue;
    ++read;
    const fs::path folder = fs::canonical(root / "model"), there = fs::canonical(folder / name);
    const fs::path plain = (folder / name).lexically_normal();
    EXPECT_EQ(there, plain) << name << " leads by a link";
    EXPECT_TRUE(there.string().starts_with(folder.string() + "/")) << name;
    EXPECT_TRUE(fs::is_regular_file(there));
  }
  EXPECT_GT(read, 50);
}

}  // namespace
}  // namespace continuo::model
