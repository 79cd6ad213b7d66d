// What the tests of machine code share: a folder for each, and when two numbers are the same.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace continuo::model {

/// A folder of one test alone.
struct TestFolder {
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "continuo-native-test-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path = name;
  }
  ~TestFolder() { std::filesystem::remove_all(path); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::filesystem::path path;
};

/// Bits, but any NaN is as good as another: its sign and payload are those of the order of operands.
inline std::uint64_t bits(double value) {
  return std::isnan(value) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(value);
}

}  // namespace continuo::model
