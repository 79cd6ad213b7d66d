// The rules of docs/architecture.md, read off the sources. The order of the modules and of their folders is stated
// once, by the continuo_library lines of CMakeLists.txt and the folders in that of the command.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/architecture/source_tree.hpp>

namespace continuo::architecture {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

const fs::path root = CONTINUO_SOURCE_DIR;
constexpr long long_readme = 12, long_file = 400;  // lines

long lines_of(const fs::path& file) {
  return std::ranges::count(text_of(file), '\n');
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.') && !name.starts_with("build")) found.push_back(entry.path());
  }
  return found;
}

TEST(Architecture, NothingIncludesAModuleOrFolderAboveItsOwn) {
  const SourceTree tree(root);
  ASSERT_GE(tree.modules().size(), 12u) << "no continuo_library lines found in CMakeLists.txt";
  EXPECT_THAT(tree.upward_includes(), IsEmpty());
}

TEST(Architecture, NoFolderIsCrowded) {
  EXPECT_THAT(SourceTree(root).crowded_folders(30, 45), IsEmpty());
}

TEST(Architecture, EverySourceSaysAtItsTopWhatItIsFor) {
  EXPECT_THAT(SourceTree(root).sources_without_purpose(), IsEmpty());
}

TEST(Architecture, IncludesStartAtTheRoot) {
  for (const auto& file : sources_below(root / "continuo")) {
    const auto directives = directives_of(text_of(file));
    EXPECT_THAT(all_matches(directives, R"re(^\s*#\s*include\s*("[^"]*"))re"), IsEmpty())
        << file << ": write <continuo/module/file.hpp>";
    EXPECT_THAT(all_matches(directives, R"re(^\s*#\s*include\s*<((?:apps|tests|bench)/))re"), IsEmpty()) << file;
  }
}

TEST(Architecture, HeadersAreGuardedOnce) {
  for (const auto& file : sources_below(root / "continuo")) {
    if (file.extension() == ".hpp") {
      EXPECT_THAT(all_matches(directives_of(text_of(file)), "^(#pragma once)"), testing::SizeIs(1)) << file;
    }
  }
}

TEST(Architecture, EveryModuleAndTopFolderSaysWhatLivesThere) {
  auto folders = folders_in(root);
  std::ranges::copy(folders_in(root / "continuo"), std::back_inserter(folders));
  for (const auto& folder : folders) {
    const auto readme = folder / "README.md";
    EXPECT_TRUE(fs::exists(readme)) << folder << " has no README.md";
    if (folder.parent_path() == root / "continuo") {
      EXPECT_LE(lines_of(readme), long_readme) << readme;
    }
  }
}

TEST(Architecture, LongFilesAreNamed) {  // a warning: length is a question (one subject?), not a fault
  for (const auto* folder : {"continuo", "apps", "tests", "bench"}) {
    for (const auto& file : sources_below(root / folder)) {
      if (lines_of(file) > long_file) std::cout << "warning: " << file << " has " << lines_of(file) << " lines\n";
    }
  }
}

}  // namespace
}  // namespace continuo::architecture
