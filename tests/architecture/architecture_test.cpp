// The house rules of docs/architecture.md, read off the sources. The order of the rooms is stated once, by the
// continuo_library lines of CMakeLists.txt.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

const fs::path root = CONTINUO_SOURCE_DIR;
constexpr long long_readme = 12, long_file = 400;  // lines

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

long lines_of(const fs::path& file) {
  return std::ranges::count(text_of(file), '\n');
}

/// First group of every match.
std::vector<std::string> all_matches(const std::string& text, const char* pattern) {
  const std::regex expression(pattern, std::regex::ECMAScript | std::regex::multiline);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

/// Lowest first.
std::vector<std::string> rooms() {
  return all_matches(text_of(root / "CMakeLists.txt"), R"(^continuo_library\((\w+))");
}

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp") found.push_back(entry.path());
  }
  return found;
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.') && !name.starts_with("build")) found.push_back(entry.path());
  }
  return found;
}

TEST(Architecture, NoRoomIncludesOneAboveIt) {
  const auto order = rooms();
  ASSERT_GE(order.size(), 7u) << "no continuo_library lines found in CMakeLists.txt";
  for (const auto& folder : folders_in(root / "continuo")) {
    const auto room = std::ranges::find(order, folder.filename().string());
    ASSERT_NE(room, order.end()) << folder << " is no room of CMakeLists.txt";
    for (const auto& file : sources_below(folder)) {
      for (const auto& other : all_matches(text_of(file), R"(^\s*#\s*include\s*[<"]continuo/(\w+)/)")) {
        EXPECT_LE(std::ranges::find(order, other), room) << file << " includes the room " << other << " above its own";
      }
    }
  }
}

TEST(Architecture, IncludesStartAtTheRoot) {
  for (const auto& file : sources_below(root / "continuo")) {
    EXPECT_THAT(all_matches(text_of(file), R"re(^\s*#\s*include\s*("[^"]*"))re"), ::testing::IsEmpty())
        << file << ": write <continuo/room/file.hpp>";
    EXPECT_THAT(all_matches(text_of(file), R"re(^\s*#\s*include\s*<((?:apps|tests|bench)/))re"), ::testing::IsEmpty())
        << file;
  }
}

TEST(Architecture, HeadersAreGuardedOnce) {
  for (const auto& file : sources_below(root / "continuo")) {
    if (file.extension() == ".hpp") {
      EXPECT_THAT(all_matches(text_of(file), "^(#pragma once)"), ::testing::SizeIs(1)) << file;
    }
  }
}

TEST(Architecture, EveryRoomAndTopFolderSaysWhatLivesThere) {
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
