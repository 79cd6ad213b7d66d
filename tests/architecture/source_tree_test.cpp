// Tests of the architecture test: small trees that keep the order of modules, and trees that violate it.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/architecture/source_tree.hpp>

namespace continuo::architecture {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Tree : public testing::Test {
 protected:
  Tree() {
    fs::remove_all(root);
    write("CMakeLists.txt",
          "continuo_library(ground ALONE *)\n"
          "continuo_library(shop FUZZED USES ground PARTS fmt::fmt\n"
          "                 FOLDERS cellar hall  # lowest first\n"
          "                         hall/attic\n"
          "                 BRIEF door)\n");
    write("apps/continuo/CMakeLists.txt", "set(folders low high)\n");
    write("continuo/ground/stone.hpp", "");
    write("continuo/shop/shop.hpp", "#include <continuo/shop/hall/table.hpp>\n");
    write("continuo/shop/door.hpp", "#include <continuo/ground/stone.hpp>\n");
    write("continuo/shop/cellar/shelf.hpp", "#include <continuo/shop/door.hpp>\n");
    write("continuo/shop/hall/table.hpp", "#include <continuo/shop/cellar/shelf.hpp>\n");
    write("continuo/shop/hall/attic/box.cpp", "#include <continuo/shop/shop.hpp>\n");
    write("apps/continuo/high/verb.cpp", "#include <apps/continuo/low/word.hpp>\n#include <continuo/shop/door.hpp>\n");
    write("apps/continuo/low/word.hpp", "");
  }
  ~Tree() override { fs::remove_all(root); }

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root / path).parent_path());
    std::ofstream(root / path) << text;
  }

  const fs::path root = fs::path(testing::TempDir()) /
                        (std::string("continuo_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Tree, KnowsTheFoldersOfAModuleInTheirOrder) {
  const SourceTree tree(root);
  ASSERT_EQ(tree.modules().size(), 3u);
  EXPECT_EQ(tree.modules()[1].path, "continuo/shop");
  EXPECT_THAT(tree.modules()[1].folders, ElementsAre("cellar", "hall", "hall/attic"));
}

TEST_F(Tree, ThatKeepsTheOrderHasNoFaults) {
  EXPECT_THAT(SourceTree(root).upward_includes(), IsEmpty());
}

TEST_F(Tree, AFolderThatLooksUpIsAFault) {
  write("continuo/shop/cellar/shelf.hpp", "#include <continuo/shop/hall/table.hpp>\n");
  EXPECT_THAT(
      SourceTree(root).upward_includes(),
      ElementsAre("continuo/shop/cellar/shelf.hpp includes continuo/shop/hall/table.hpp, a folder above its own"));
}

TEST_F(Tree, AFolderThatLooksUpByAPublicHeaderIsAFault) {
  write("continuo/shop/cellar/shelf.cpp", "#  include <continuo/shop/shop.hpp>\n");
  EXPECT_THAT(SourceTree(root).upward_includes(), Contains(HasSubstr("shelf.cpp includes by continuo/shop/shop.hpp "
                                                                     "continuo/shop/hall/table.hpp")));
}

TEST_F(Tree, AFolderOfAFolderHasAPlaceOfItsOwn) {
  write("continuo/shop/hall/attic/old.hpp", "");
  write("continuo/shop/hall/table.hpp", "#include <continuo/shop/hall/attic/old.hpp>\n");
  EXPECT_THAT(SourceTree(root).upward_includes(),
              Contains(HasSubstr("table.hpp includes continuo/shop/hall/attic/old.hpp, a folder above")));
}

TEST_F(Tree, TheFoldersOfTheCommandAreHeldToTheirOrder) {
  write("apps/continuo/high/verb.hpp", "");
  write("apps/continuo/low/word.hpp", "#include <apps/continuo/high/verb.hpp>\n");
  EXPECT_THAT(SourceTree(root).upward_includes(), Contains(HasSubstr("word.hpp includes apps/continuo/high/verb.hpp")));
}

TEST_F(Tree, AModuleThatLooksUpIsAFault) {
  write("continuo/ground/stone.hpp", "#include <continuo/shop/door.hpp>\n");
  EXPECT_THAT(SourceTree(root).upward_includes(),
              ElementsAre("continuo/ground/stone.hpp includes continuo/shop/door.hpp, a module above its own"));
}

TEST_F(Tree, WhatCMakeDoesNotNameIsAFault) {
  write("continuo/shop/shed/rake.hpp", "");
  write("continuo/garden/tree.hpp", "");
  EXPECT_THAT(SourceTree(root).upward_includes(),
              ElementsAre("continuo/garden/tree.hpp lies in no module that CMakeLists.txt names",
                          "continuo/shop/shed/rake.hpp lies in a folder that CMake does not name"));
}

TEST_F(Tree, AHeaderWithItsSourceIsOneSubject) {
  write("continuo/shop/cellar/shelf.cpp", "");
  EXPECT_THAT(SourceTree(root).crowded_folders(2, 2), IsEmpty());
  write("continuo/shop/cellar/README.md", "");
  EXPECT_THAT(SourceTree(root).crowded_folders(2, 2), ElementsAre("continuo/shop/cellar: 1 subjects in 3 files"));
  EXPECT_THAT(SourceTree(root).crowded_folders(1, 9), ElementsAre("continuo/shop: 2 subjects in 2 files"));
}

TEST_F(Tree, ASourceSaysAtItsTopWhatItIsFor) {
  write("continuo/shop/hall/attic/box.cpp",
        "// Keeps what the hall has no room for.\n#include <continuo/shop/shop.hpp>\n");
  write("apps/continuo/high/verb.cpp", "// apps/continuo/high/verb.cpp\n// Sells.\n");
  EXPECT_THAT(SourceTree(root).sources_without_purpose(), IsEmpty());
  write("continuo/shop/till.cpp", "\n// Too late.\n");
  write("apps/continuo/high/verb.cpp", "// apps/continuo/high/verb.cpp\n#include <continuo/shop/door.hpp>\n");
  EXPECT_THAT(SourceTree(root).sources_without_purpose(),
              ElementsAre("apps/continuo/high/verb.cpp", "continuo/shop/till.cpp"));
}

}  // namespace
}  // namespace continuo::architecture
