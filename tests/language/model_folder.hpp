// The models of a folder, each as a case of a parameterized test.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace continuo::model {

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Of NAME.sim in a folder the names, in their order.
inline std::vector<std::string> models_in(const std::filesystem::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".sim") found.push_back(entry.path().stem().string());
  std::ranges::sort(found);
  return found;
}

/// How a test of a model is called: as the model.
inline std::string name_of_test(const testing::TestParamInfo<std::string>& model) {
  return model.param;
}

}  // namespace continuo::model
